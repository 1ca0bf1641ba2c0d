// See model.hpp. The numbers in events come from the line and are not trusted.
#include "rsc/screen/model.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "rsc/trace/digest.hpp"
#include "rsc/trace/event_reader.hpp"
#include "rsc/trace/time_units.hpp"

namespace robosync::tool::screen {
namespace {

using link::EventKind;

constexpr std::size_t kMaxLog = 1000, kMaxAlerts = 5;

void keep(std::deque<std::string>& lines, const std::string& line, std::size_t most) {
  lines.push_back(line);
  if (lines.size() > most) lines.pop_front();
}

// Excludes signals, timers, bands and the hidden variables of NEXT and ANY, whose names have a space.
bool is_shown(const vm::Image& image, const vm::Variable& variable) {
  return variable.kind != vm::VariableKind::signal && variable.kind != vm::VariableKind::timer &&
         variable.kind != vm::VariableKind::band &&
         image.string(variable.name).find(' ') == std::string_view::npos;
}

}  // namespace

void Model::board(const link::HelloReply& board, const Past& past,
                  const std::vector<OnBus>& silent) {
  const std::string robot = text_of(board.robot);
  board_ = text_of(board.board);
  if (!robot.empty()) board_ = fmt::format("{} ({})", robot, board_);
  uptime_us_ = past.status.uptime_us;
  say(fmt::format("{}, up {}", board_, past_text(past.status)));
  if (past.has_fault()) say("last fault: " + fault_text(past.fault));
  say(owner_text(past.owner));
  for (const OnBus& device : silent)
    say(silent_text(device));
}

void Model::program(const TraceNames& names, std::span<const std::byte> image) {
  image_ = names.image;
  program_ = image_ == nullptr
                 ? "no program"
                 : fmt::format("{:02x} ({} bytes)", fmt::join(image_->header->program_hash, ""),
                               image.size());
  now_us_ = 0;
  sensors_.clear();
  behaviors_.clear();
  actuators_.clear();
  variables_.clear();
  row_of_variable_.clear();
  trips_.clear();
  running_.clear();
  owners_.clear();
  if (image_ != nullptr) add_rows();
}

void Model::add_rows() {
  for (const vm::Channel& channel : image_->channels) {
    const vm::Sensor& sensor = image_->sensors[channel.sensor];
    sensors_.push_back(
        {fmt::format("{}.{}", image_->string(sensor.name), image_->string(channel.name)),
         "unknown",
         {},
         sensor.driver == vm::DriverId::virtual_sensor,
         {}});
  }
  for (const vm::Behavior& behavior : image_->behaviors) {
    std::string name(behavior.name == vm::kNoIndex ? "" : image_->string(behavior.name));
    if (behavior.priority == vm::kSafetyPriority) name = "SAFETY";
    if (name.empty() && behavior.first_rule < image_->rules.size())
      name = fmt::format("line {}", image_->rules[behavior.first_rule].line);
    behaviors_.push_back({name, {}, behavior.priority, behavior.priority, {}});
  }
  for (const vm::Actuator& actuator : image_->actuators)
    actuators_.push_back({std::string(image_->string(actuator.name)), {}, {}, false, {}});
  owners_.resize(actuators_.size());
  for (const vm::Variable& variable : image_->variables) {
    row_of_variable_.emplace_back();
    if (!is_shown(*image_, variable)) continue;
    row_of_variable_.back() = variables_.size();
    variables_.emplace_back(image_->string(variable.name), "?");
  }
}

std::optional<std::size_t> Model::behavior_of(std::size_t rule) const {
  for (std::size_t i = 0; i < image_->behaviors.size(); ++i) {
    const vm::Behavior& behavior = image_->behaviors[i];
    if (rule >= behavior.first_rule &&
        rule < std::size_t{behavior.first_rule} + behavior.rule_count)
      return i;
  }
  return std::nullopt;
}

// Replaces what earlier events have told of it.
void Model::current(const Current& current, const TraceNames& names) {
  stopped_ = current.stopped;
  trips_.clear();
  for (ActuatorRow& row : actuators_)
    row.halted = false;
  for (const link::Event& event : current.events)
    see(event, names);
}

void Model::event(const link::Event& event, const TraceNames& names) {
  now_us_ = std::max(now_us_, event.time_us);
  const std::string words = trace_line(event, names);
  if (event.kind != EventKind::input && event.kind != EventKind::set) keep(log_, words, kMaxLog);
  if (event.kind == EventKind::alert || event.kind == EventKind::fault)
    keep(alerts_, words, kMaxAlerts);
  see(event, names);
}

void Model::see(const link::Event& event, const TraceNames& names) {
  if (image_ == nullptr) return;
  const EventReader reader(event, names);
  switch (reader.shape().subject) {
    case About::channel:
    case About::variable:
      see_value(event, names);
      break;
    case About::rule:
      if (event.subject < image_->rules.size()) see_rule(event, names);
      break;
    case About::actuator:
      if (event.subject < actuators_.size()) see_actuator(event, names);
      break;
    case About::behavior:
      if (event.kind == EventKind::priority && event.subject < behaviors_.size())
        behaviors_[event.subject].priority = reader.value(0);
      break;
    default:
      break;
  }
}

void Model::see_value(const link::Event& event, const TraceNames& names) {
  const EventReader reader(event, names);
  if (reader.shape().subject == About::channel) {
    if (event.subject >= sensors_.size()) return;
    SensorRow& row = sensors_[event.subject];
    const bool known = event.kind == EventKind::input && event.value_count > 0;
    row.value = known ? reader.shown(reader.value(0)) : "unknown";
    row.history.emplace_back(event.time_us, known ? std::optional(reader.value(0)) : std::nullopt);
    // The last value before the window is its initial value.
    while (row.history.size() > 1 && row.history[1].first + kHistoryUs < now_us_)
      row.history.pop_front();
    return;
  }
  if (event.subject >= image_->variables.size()) return;
  if (const auto row = row_of_variable_[event.subject])
    variables_[*row].second = reader.shown(reader.value(0));
  for (const vm::Check& check : image_->checks)
    if (check.variable == event.subject && check.input < sensors_.size())
      sensors_[check.input].band = reader.shown(reader.value(0));
}

void Model::see_rule(const link::Event& event, const TraceNames& names) {
  const EventReader reader(event, names);
  const std::size_t rule = event.subject;
  switch (event.kind) {
    case EventKind::win:
      begins(event);
      break;
    case EventKind::wait:
    case EventKind::go_on:
      running_[rule] = event.kind == EventKind::wait;
      break;
    case EventKind::finished:
    case EventKind::interrupt:
      ends(rule);
      break;
    case EventKind::lose:
      is_denied(event, names);
      break;
    case EventKind::trip:
      std::erase(trips_, reader.rule_name());  // current() may have told it already
      trips_.push_back(reader.rule_name());
      break;
    case EventKind::resume:
      std::erase(trips_, reader.rule_name());
      break;
    default:
      break;
  }
  if (const auto behavior = behavior_of(rule)) see_state(*behavior);
}

void Model::begins(const link::Event& event) {
  const vm::Rule& rule = image_->rules[event.subject];
  const bool then = event.value_count > 0 && event.values[0] != 0;
  const std::uint16_t response = then ? rule.then_response : rule.else_response;
  running_[event.subject] = false;
  if (response >= image_->responses.size()) return;
  const auto behavior = behavior_of(event.subject);
  for (std::size_t i = 0; i < owners_.size(); ++i) {
    if ((image_->responses[response].actuators >> i & 1) == 0) continue;
    owners_[i] = event.subject;
    actuators_[i].owner = behavior ? behaviors_[*behavior].name : "";
    actuators_[i].denied.clear();
  }
}

void Model::ends(std::size_t rule) {
  running_.erase(rule);
  for (std::size_t i = 0; i < owners_.size(); ++i)
    if (owners_[i] == rule) {
      owners_[i].reset();
      actuators_[i].owner.clear();
    }
}

void Model::is_denied(const link::Event& event, const TraceNames& names) {
  const EventReader reader(event, names);
  const auto behavior = behavior_of(event.subject);
  if (!behavior) return;
  const std::string by = reader.behavior_name(event.object);
  behaviors_[*behavior].denied = fmt::format("{} by {}", seconds_text(event.time_us), by);
  const vm::Rule& rule = image_->rules[event.subject];
  const bool then = event.value_count > 0 && event.values[0] != 0;
  const std::uint16_t response = then ? rule.then_response : rule.else_response;
  if (response >= image_->responses.size()) return;
  // The actuators that another behaviour holds.
  for (std::size_t i = 0; i < owners_.size(); ++i)
    if ((image_->responses[response].actuators >> i & 1) != 0 && owners_[i] &&
        behavior_of(*owners_[i]) != behavior)
      actuators_[i].denied = behaviors_[*behavior].name;
}

void Model::see_state(std::size_t behavior) {
  bool runs = false, waits = false;
  for (const auto& [rule, waiting] : running_)
    if (behavior_of(rule) == behavior) (waiting ? waits : runs) = true;
  behaviors_[behavior].state = runs ? "running" : waits ? "waiting" : "";
}

void Model::see_actuator(const link::Event& event, const TraceNames& names) {
  ActuatorRow& row = actuators_[event.subject];
  switch (event.kind) {
    case EventKind::command:
      row.command = trace_words(event, names);
      if (row.command.starts_with(row.name + " ")) row.command.erase(0, row.name.size() + 1);
      break;
    case EventKind::halt:
      row.halted = true;
      row.command.clear();
      break;
    case EventKind::release:
      row.halted = false;
      break;
    case EventKind::done:
    case EventKind::cancel:
      row.command.clear();
      break;
    default:
      break;
  }
}

void Model::threads(ThreadList now, ThreadList before) {
  sums_ = {load_of(now, before), 0};
  for (const link::ThreadInfo& thread : now)
    sums_.missed += thread.missed;
}

void Model::status(const link::Status& status) {
  uptime_us_ = status.uptime_us;
  now_us_ = status.program_us;
  lost_events_ = status.lost_events;
  faults_ = status.faults;
}

void Model::say(const std::string& text) {
  keep(log_, text, kMaxLog);
}

}  // namespace robosync::tool::screen
