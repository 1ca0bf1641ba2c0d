// What rsc upload does with one robot, and what it reports.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rsc/console.hpp"
#include "rsc/device/devices.hpp"
#include "rsc/device/uploader.hpp"
#include "rsc/json.hpp"
#include "rsc/program.hpp"

namespace robosync::tool {

// What the user asked for.
struct SendOptions {
  std::string file, key;
  std::vector<std::string> ports;
  CompileOptions how;
  std::optional<std::chrono::milliseconds> timeout, trial;
  bool no_confirm = false;
  bool replace = false;
  bool fresh = false;
  bool anyway = false;
  bool take = false;
  Format format = Format::human;
};

using Progress = std::function<void(std::size_t sent, std::size_t total)>;

// The result of an upload, and whether the robot keeps it.
struct Uploaded {
  UploadResult result;
  std::vector<OnBus> silent;
  link::Kept kept{};
};

[[nodiscard]] double ms_of(const UploadResult& result);
[[nodiscard]] double wire_ms_of(const UploadResult& result);
[[nodiscard]] std::string hash_of(const Program& program);
[[nodiscard]] Json json_of(const Uploaded& uploaded, const Program& program);
void print_json(const Json& json);

// Throws what Session and upload_program() throw.
[[nodiscard]] Uploaded upload_to(const std::string& port, const Program& program,
                                 const SendOptions& options, const Progress& progress);
// Throws Failure (program) if the program failed its trial.
void expect_passed_trial(const std::string& file, const link::Kept& kept, const Program& program);

}  // namespace robosync::tool
