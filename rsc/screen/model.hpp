// What is known of a watched robot, as text ready to be drawn (layout.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rsc/device/viewer.hpp"

namespace robosync::tool::screen {

struct SensorRow {
  std::string name, value, band;
  bool is_virtual = false;
  std::deque<std::pair<std::uint64_t, std::optional<vm::Value>>>
      history;  // over the last kHistoryUs
};

struct BehaviorRow {
  std::string name, state;  // "running", "waiting"; empty: idle
  int priority = 0, written = 0;
  std::string denied;  // the last time: by what and when
};

struct ActuatorRow {
  std::string name, owner, command;  // empty: no owner, no command
  bool halted = false;
  std::string denied;  // the last one that was denied it
};

struct ThreadSums {
  std::optional<double> load;  // percent of the processor
  unsigned missed = 0;         // deadlines
};

class Model {
public:
  static constexpr std::uint64_t kHistoryUs = 60'000'000;

  void board(const link::HelloReply& board, const Past& past, const std::vector<OnBus>& silent);
  void program(const TraceNames& names, std::span<const std::byte> image);
  void current(const Current& current, const TraceNames& names);
  void event(const link::Event& event, const TraceNames& names);
  void threads(ThreadList now, ThreadList before);
  void status(const link::Status& status);
  void say(const std::string& text);  // in the log
  void stopped(bool by_person) { stopped_ = by_person; }

  const std::string& board_name() const { return board_; }
  const std::string& program_name() const { return program_; }
  bool is_stopped() const { return stopped_; }
  std::uint64_t now_us() const { return now_us_; }  // program time
  std::uint64_t uptime_us() const { return uptime_us_; }
  const std::vector<SensorRow>& sensors() const { return sensors_; }
  const std::vector<BehaviorRow>& behaviors() const { return behaviors_; }
  const std::vector<ActuatorRow>& actuators() const { return actuators_; }
  // STATEs, feelings, what is REMEMBERed: name and value.
  const std::vector<std::pair<std::string, std::string>>& variables() const { return variables_; }
  const std::vector<std::string>& trips() const { return trips_; }  // SAFETY rules that are tripped
  const ThreadSums& sums() const { return sums_; }
  std::uint32_t lost_events() const { return lost_events_; }
  unsigned faults() const { return faults_; }
  const std::deque<std::string>& alerts() const { return alerts_; }
  const std::deque<std::string>& log() const { return log_; }

private:
  void add_rows();
  void see(const link::Event& event, const TraceNames& names);
  void see_value(const link::Event& event, const TraceNames& names);
  void see_rule(const link::Event& event, const TraceNames& names);
  void see_actuator(const link::Event& event, const TraceNames& names);
  void begins(const link::Event& event);
  void ends(std::size_t rule);
  void is_denied(const link::Event& event, const TraceNames& names);
  void see_state(std::size_t behavior);
  std::optional<std::size_t> behavior_of(std::size_t rule) const;

  const vm::Image* image_ = nullptr;
  std::string board_, program_;
  bool stopped_ = false;
  std::uint64_t now_us_ = 0, uptime_us_ = 0;
  std::vector<SensorRow> sensors_;
  std::vector<BehaviorRow> behaviors_;
  std::vector<ActuatorRow> actuators_;
  std::vector<std::pair<std::string, std::string>> variables_;
  std::vector<std::optional<std::size_t>> row_of_variable_;
  std::vector<std::string> trips_;
  std::map<std::size_t, bool> running_;             // rules with a running response; true: waiting
  std::vector<std::optional<std::size_t>> owners_;  // of each actuator: the rule
  ThreadSums sums_;
  std::uint32_t lost_events_ = 0;
  unsigned faults_ = 0;
  std::deque<std::string> alerts_, log_;
};

}  // namespace robosync::tool::screen
