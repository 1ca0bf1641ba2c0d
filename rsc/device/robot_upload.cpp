// See robot_upload.hpp.
#include "rsc/device/robot_upload.hpp"

#include <algorithm>
#include <iostream>

#include <fmt/format.h>

#include "rsc/device/keeping.hpp"
#include "rsc/device/known_image.hpp"
#include "rsc/device/serial_transport.hpp"
#include "rsc/failure.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {

using std::chrono::milliseconds;

namespace {
constexpr double kBitsPerByte = 10;  // 8N1

// A SAFETY rule over what nobody has fed trips as soon as the program begins: wait for that.
link::Kept after_start(Session& session, const Program& program) {
  const vm::Image& image = program.image();
  return image.has_safety() ? after_first_look(session.client, image.header->safety_start_ms)
                            : session.client.kept();
}

}  // namespace

double ms_of(const UploadResult& result) {
  return static_cast<double>(result.time.count()) / 1000;
}

double wire_ms_of(const UploadResult& result) {
  return static_cast<double>(result.bytes) * kBitsPerByte / kBaudRate * 1000;
}

std::string hash_of(const Program& program) {
  return text_of(program.image().header->program_hash);
}

Json json_of(const Uploaded& uploaded, const Program& program) {
  const UploadResult& result = uploaded.result;
  return {{"bytes", result.bytes},
          {"time_ms", ms_of(result)},
          {"wire_time_ms", wire_ms_of(result)},
          {"frames", result.frames_sent},
          {"bytes_sent", result.bytes_sent},
          {"program", hash_of(program)},
          {"uptime_us", result.activation.uptime_us},
          {"silent", devices_json(uploaded.silent)},
          {"kept", keeping_json(uploaded.kept)}};
}

void print_json(const Json& json) {
  std::cout << json_text(json) << '\n';
}

Uploaded upload_to(const std::string& port, const Program& program, const SendOptions& options,
                   const Progress& progress) {
  const std::vector<std::byte> base = known_image(port);
  UploadOptions how;
  how.timeout = options.timeout;
  how.trial = options.trial.value_or(milliseconds(0));
  how.confirm = !options.no_confirm;
  how.to_any_robot = options.anyway;
  how.replace = options.replace;
  how.fresh = options.fresh;
  if (!how.replace) how.base = base;
  how.progress = progress;
  constexpr milliseconds kAnswer{2000};
  Session session(port, std::min(how.timeout.value_or(kAnswer), kAnswer), Greeting::later,
                  options.take);
  session.client.use_key(options.key);
  if (options.no_confirm) expect_kept_program(session.client);
  Uploaded uploaded;
  uploaded.result = upload_program(session, program, how);
  know_image(port, without_source_lines(program));
  try {
    uploaded.silent = silent_after_start(session.client, program.image());
    uploaded.kept = options.trial ? after_trial(session.client) : after_start(session, program);
  } catch (const Failure& failure) {
    throw Failure(failure.exit(),
                  followed_by(failure.what(),
                              fmt::format("The upload was done: program {} has started; `rsc info` "
                                          "shows whether the robot keeps it",
                                          hash_of(program))));
  }
  return uploaded;
}

void expect_passed_trial(const std::string& file, const link::Kept& kept, const Program& program) {
  if (!has_failed_trial(kept, program.image().header->program_hash)) return;
  const char* const now = kept.kept_bytes == 0 ? "there is none to go back to: it keeps running"
                                               : "that one runs again";
  throw Failure(Exit::program, file +
                                   " failed its trial: one of its threads faulted, or a SAFETY "
                                   "rule tripped that did not in the program before; " +
                                   now);
}

}  // namespace robosync::tool
