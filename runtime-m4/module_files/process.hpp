// A module in a file (robosync_module.h, compiled to NAME.so), in a process of its own that can do nothing but compute: whatever the
// module does, who started the process goes on, and can say what happened. Between two calls the process keeps nothing of the module's
// but its code, so several algorithms can share it. Linux.
#pragma once

#include <string>

#include <sys/types.h>

#include "runtime-m4/module_files/desk.hpp"

namespace robosync::module_files {

class Process {
public:
  // Loads `path`, whose name without its ending is the module's. Afterwards trouble() says why it cannot be used.
  explicit Process(const std::string& path);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // Why the module is not there any more, or never was; empty: it is.
  const std::string& trouble() const { return trouble_; }
  // As the module says, with each text ended; nothing else of it has been looked at.
  const Described& described() const { return described_; }

  // All false when there is trouble. `sizes` of the parameters that a module has last been asked for are known.
  [[nodiscard]] bool measure(const Config& config, Sizes& sizes);
  [[nodiscard]] bool init(const Config& config, std::uint32_t period_ms, State& state);
  // `outputs`: what it left there last. `changed`: what it returned, as far as it has outputs.
  [[nodiscard]] bool process(const Config& config, const Inputs& inputs, State& state,
                             Outputs& outputs, std::uint32_t& changed,
                             std::uint8_t scratch_holds = 0);

private:
  void start(const std::string& path);
  [[nodiscard]] bool share_memory();
  [[nodiscard]] bool ask(Call call);
  [[nodiscard]] bool know_sizes(const Config& config);
  [[nodiscard]] bool await();
  [[nodiscard]] bool takes_too_long(long began_ms) const;
  void give_up(std::string why);
  [[nodiscard]] int status_of_ended();
  void say_what_happened();

  pid_t child_ = -1;
  int line_ = -1;
  Request* request_ = nullptr;
  const Reply* reply_ = nullptr;
  Described described_{};
  Config measured_{};  // whose sizes the process knows
  Sizes sizes_;
  bool has_measured_ = false;
  long cpu_ms_ = 0;  // that the process had taken before what it does now
  std::string name_, trouble_;
};

}  // namespace robosync::module_files
