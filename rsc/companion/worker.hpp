// The program of one algorithm, kept running: it is started again when it has ended or hangs, each time later than the time
// before, and what becomes of it is said.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rsc/companion/process.hpp"

namespace robosync::tool {

class Worker {
public:
  using Clock = std::chrono::steady_clock;
  struct Plan {
    std::string name;  // of the algorithm
    std::string program;
    std::vector<std::string> arguments;
    std::chrono::milliseconds period{};  // it says something at least so often

    bool operator==(const Plan&) const = default;
  };
  // Is it a line that means something? Only those are signs of life.
  using Accept = std::function<bool(const std::string& line)>;
  using Report = std::function<void(const std::string& what)>;

  Worker(Plan plan, Report report);

  // Often: takes what it says, and looks how it does.
  void look(Clock::time_point now, const Accept& accept);

  [[nodiscard]] const Plan& plan() const { return plan_; }
  // It is not started any more: its recording is over …
  [[nodiscard]] bool is_over() const { return is_over_; }
  // … or starting it again would not help.
  [[nodiscard]] bool is_given_up() const { return is_given_up_; }

private:
  void start(Clock::time_point now);
  // False when nothing it said meant anything.
  bool listen(const Accept& accept);
  void take_end(Clock::time_point now, int status);
  void end_it(Clock::time_point now, const std::string& why);

  Plan plan_;
  Report report_;
  std::unique_ptr<WorkerProcess> process_;
  Clock::time_point started_, alive_, next_start_;
  std::chrono::milliseconds pause_;
  bool has_spoken_ = false;   // since it was started
  bool has_babbled_ = false;  // likewise: what it said meant nothing, and that has been reported
  bool is_over_ = false, is_given_up_ = false;
};

}  // namespace robosync::tool
