// rsc upload FILE|X.rsb --port P [--config FILE] [--timeout TIME] [--trial TIME] [--no-confirm] [--replace] [--fresh]
//            [--anyway] [--take] [--key FILE]
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "rsc/console.hpp"
#include "rsc/device/devices.hpp"
#include "rsc/device/keeping.hpp"
#include "rsc/device/known_image.hpp"
#include "rsc/device/serial_transport.hpp"
#include "rsc/device/uploader.hpp"
#include "rsc/failure.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

using std::chrono::milliseconds;

constexpr double kBitsPerByte = 10;  // 8N1

struct SendOptions {
  std::string file, port, key;
  CompileOptions how;
  std::optional<milliseconds> timeout, trial;
  bool no_confirm = false;
  bool replace = false;
  bool fresh = false;
  bool anyway = false;
  bool take = false;
  Format format = Format::human;
};

void show_progress(std::size_t sent, std::size_t total) {
  std::cerr << fmt::format("\r{} of {} bytes", sent, total);
  if (sent == total) std::cerr << "\r\x1b[K";
  std::cerr.flush();
}

void report(const SendOptions& options, const UploadResult& result, const Program& program,
            const std::vector<OnBus>& silent, const link::Kept& kept) {
  const std::size_t bytes = result.bytes;
  const double ms = static_cast<double>(result.time.count()) / 1000;
  const double wire_ms = static_cast<double>(bytes) * kBitsPerByte / kBaudRate * 1000;
  const std::string hash = text_of(program.image().header->program_hash);
  if (options.format == Format::json) {
    std::cout << nlohmann::ordered_json{{"bytes", bytes},
                                        {"time_ms", ms},
                                        {"wire_time_ms", wire_ms},
                                        {"frames", result.frames_sent},
                                        {"bytes_sent", result.bytes_sent},
                                        {"program", hash},
                                        {"uptime_us", result.activation.uptime_us},
                                        {"silent", devices_json(silent)},
                                        {"kept", keeping_json(kept)}}
                     .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
              << '\n';
    return;
  }
  std::cout << fmt::format(
      "{}: {} bytes in {:.1f} ms ({} sent; all of it takes {:.1f} ms at 115,200 baud); program {} "
      "runs since {:.3f} s after start-up\n",
      options.file, bytes, ms, result.bytes_sent, wire_ms, hash,
      static_cast<double>(result.activation.uptime_us) / 1e6);
  std::cout << keeping_text(kept) << '\n';
  for (const OnBus& device : silent)
    std::cerr << "warning: " << silent_text(device) << '\n';
}

void upload(const SendOptions& options) {
  const Program program = load_program(options.file, options.how);
  const std::vector<std::byte> base = known_image(options.port);
  UploadOptions how;
  how.timeout = options.timeout;
  how.trial = options.trial.value_or(milliseconds(0));
  how.confirm = !options.no_confirm;
  how.replace = options.replace;
  how.fresh = options.fresh;
  if (!how.replace) how.base = base;
  if (stderr_is_terminal()) how.progress = show_progress;
  constexpr milliseconds kAnswer{2000};
  Session session(options.port, std::min(how.timeout.value_or(kAnswer), kAnswer), Greeting::later,
                  options.take);
  session.client.use_key(options.key);
  if (options.no_confirm) expect_kept_program(session.client);
  const UploadResult result = upload_program(session, program, how);
  know_image(options.port, without_source_lines(program));
  const std::vector<OnBus> silent = silent_after_start(session.client, program.image());
  const link::Kept kept = options.trial ? after_trial(session.client) : session.client.kept();
  report(options, result, program, silent, kept);
  if (kept.given_up_hash == program.image().header->program_hash)
    throw Failure(Exit::program,
                  options.file +
                      " did not stand its trial: a thread of it faulted, or a SAFETY rule tripped "
                      "that did not in the program before; that one runs again");
}

}  // namespace

void add_upload(Options& options) {
  auto asked = std::make_shared<SendOptions>();
  options.argument("FILE", asked->file, "program (.rsl) or image (.rsb)", Options::Need::required);
  add_port_option(options, asked->port);
  add_key_option(options, asked->key);
  add_compile_options(options, asked->how);
  add_seed_option(options, asked->how.seed);
  add_duration_option(options, "--timeout", asked->timeout,
                      "give up after (10s, longer for a large image)");
  add_duration_option(options, "--trial", asked->trial,
                      "wait until it has run for so long, and say whether the robot keeps it");
  options.flag("--no-confirm", asked->no_confirm,
               "only try it: after the trial the kept program comes back");
  options.flag("--replace", asked->replace,
               "end the running program first, where the board has no room for both");
  options.flag("--fresh", asked->fresh, "KEPT numbers begin as the program says");
  options.flag("--anyway", asked->anyway,
               "also when it is too much for the board, which may refuse it");
  options.flag("--take", asked->take, "take the line from a host in the midst of an upload");
  add_format_option(options, asked->format);
  options.runs([asked] {
    asked->how.judged = asked->anyway ? Judged::not_at_all : Judged::by_time;
    upload(*asked);
  });
}

}  // namespace robosync::tool
