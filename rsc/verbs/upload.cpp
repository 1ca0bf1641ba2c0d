// rsc upload FILE|X.rsb --port P [--config FILE] [--timeout TIME] [--replace] [--fresh] [--anyway] [--key FILE]
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
  std::optional<milliseconds> timeout;
  bool replace = false;
  bool fresh = false;
  bool anyway = false;
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
  const std::string hash =
      fmt::format("{:02x}", fmt::join(program.image().header->program_hash, ""));
  if (options.format == Format::json) {
    std::cout << nlohmann::ordered_json{{"bytes", bytes},
                                        {"time_ms", ms},
                                        {"wire_time_ms", wire_ms},
                                        {"frames", result.frames_sent},
                                        {"program", hash},
                                        {"uptime_us", result.activation.uptime_us},
                                        {"silent", devices_json(silent)},
                                        {"kept", keeping_json(kept)}}
                     .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
              << '\n';
    return;
  }
  std::cout << fmt::format(
      "{}: {} bytes in {:.1f} ms (wire time at 115,200 baud: {:.1f} ms); program {} runs since "
      "{:.3f} s after start-up\n",
      options.file, bytes, ms, wire_ms, hash,
      static_cast<double>(result.activation.uptime_us) / 1e6);
  std::cout << keeping_text(kept) << '\n';
  for (const OnBus& device : silent)
    std::cerr << "warning: " << silent_text(device) << '\n';
}

void upload(const SendOptions& options) {
  const Program program = load_program(options.file, options.how);
  UploadOptions how;
  how.timeout = options.timeout;
  how.replace = options.replace;
  how.fresh = options.fresh;
  if (stderr_is_terminal()) how.progress = show_progress;
  constexpr milliseconds kAnswer{2000};
  Session session(options.port, std::min(how.timeout.value_or(kAnswer), kAnswer));
  session.client.use_key(options.key);
  const UploadResult result = upload_program(session, program, how);
  const std::vector<OnBus> silent = silent_after_start(session.client, program.image());
  report(options, result, program, silent, session.client.kept());
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
  options.flag("--replace", asked->replace,
               "end the running program first, where the board has no room for both");
  options.flag("--fresh", asked->fresh, "KEPT numbers begin as the program says");
  options.flag("--anyway", asked->anyway,
               "also when it is too much for the board, which may refuse it");
  add_format_option(options, asked->format);
  options.runs([asked] {
    asked->how.judged = asked->anyway ? Judged::not_at_all : Judged::by_time;
    upload(*asked);
  });
}

}  // namespace robosync::tool
