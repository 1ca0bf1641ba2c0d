// A module in a file (robosync_module.h, compiled to NAME.so), in its own process, which can do nothing but compute: whatever the
// module does, the process that started it goes on, and can say what happened. Between two calls the process keeps nothing of the
// module but its code, so several algorithms can share it. Linux.
#pragma once

#include <string>

#include <sys/types.h>

#include "runtime-m4/module_files/desk.hpp"

namespace robosync::module_files {

class Process {
public:
  // Loads `path`, whose file name without its extension is the module's name. Afterwards trouble() says why it cannot be used.
  explicit Process(const std::string& path);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  // Why the module is no longer usable, or never was; empty: it is usable.
  const std::string& trouble() const { return trouble_; }
  // As the module describes itself, with each text terminated; nothing else of it has been checked.
  const Described& described() const { return described_; }

  // All return false if there is trouble. The `sizes` for the parameters that were last asked about are kept.
  [[nodiscard]] bool measure(const Config& config, Sizes& sizes);
  [[nodiscard]] bool init(const Config& config, std::uint32_t period_ms, State& state);
  // `outputs`: in, what it last left there. `changed`: what it returned.
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
  Config measured_{};  // the parameters that sizes_ are for
  Sizes sizes_;
  bool has_measured_ = false;
  long cpu_ms_ = 0;  // CPU time of the process before the current call
  std::string name_, trouble_;
};

}  // namespace robosync::module_files
