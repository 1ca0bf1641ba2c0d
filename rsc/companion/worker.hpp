// Keeps the program of one algorithm running: restarts it when it ends or hangs, each time after a longer pause, and
// reports it.
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
    std::chrono::milliseconds period{};  // the longest time between its lines

    bool operator==(const Plan&) const = default;
  };
  // Is the line meaningful? Only such lines count as signs of life.
  using Accept = std::function<bool(const std::string& line)>;
  using Report = std::function<void(const std::string& what)>;

  Worker(Plan plan, Report report);

  // Call often: reads its lines and checks on it.
  void look(Clock::time_point now, const Accept& accept);

  [[nodiscard]] const Plan& plan() const { return plan_; }
  // It is not restarted: its recording has ended …
  [[nodiscard]] bool is_over() const { return is_over_; }
  // … or a restart would not help.
  [[nodiscard]] bool is_given_up() const { return is_given_up_; }

private:
  void start(Clock::time_point now);
  // False if no line was meaningful.
  bool listen(const Accept& accept);
  void take_end(Clock::time_point now, int status);
  void end_it(Clock::time_point now, const std::string& why);

  Plan plan_;
  Report report_;
  std::unique_ptr<WorkerProcess> process_;
  Clock::time_point started_, alive_, next_start_;
  std::chrono::milliseconds pause_;
  bool has_spoken_ = false;   // since it was started
  bool has_babbled_ = false;  // likewise: a meaningless line has been reported
  bool is_over_ = false, is_given_up_ = false;
};

}  // namespace robosync::tool
