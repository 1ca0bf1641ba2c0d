#include "compiler/codegen/tables.hpp"

#include <algorithm>

#include "compiler/ir/walk.hpp"
#include "vm/timers.hpp"
#include "vm/verifier.hpp"

namespace robosync::compiler {

// ---- numbers

namespace {

template <typename Entry>
void add_once(std::vector<Entry>& list, const Entry& entry) {
  if (std::find(list.begin(), list.end(), entry) == list.end()) list.push_back(entry);
}

template <typename Entry>
std::uint8_t place_of(const std::vector<Entry>& list, const Entry& entry) {
  return static_cast<std::uint8_t>(std::find(list.begin(), list.end(), entry) - list.begin());
}

template <typename Map>
void number(Map& map) {
  std::uint8_t next = 0;
  for (auto& [key, value] : map)
    value = next++;
}

}  // namespace

Tables::Tables(const ir::Program& program, const Robot& robot, Diagnostics& diagnostics) {
  for (const ir::Check& check : program.checks)
    use(check.input);
  for_each_rule(program, [this](const ir::Rule& rule) { use(rule); });
  use_encoders(robot);
  use_inputs(robot);
  check_counts(program, diagnostics);
  number(channels_);
  number(actuators_);
  number(groups_);
  number(motion_groups_);
}

// Adds the distances that the encoders of a drive count.
void Tables::use_encoders(const Robot& robot) {
  for (const auto& [place, number] : actuators_) {
    const auto& encoders = robot.actuators[place].encoders;
    if (!encoders) continue;
    for (const std::size_t sensor : *encoders)
      channels_.emplace(ChannelRef{sensor, *distance_of(robot.sensors[sensor])}, 0);
  }
}

// Adds the inputs of the algorithms whose outputs are used.
void Tables::use_inputs(const Robot& robot) {
  std::set<std::size_t> used;
  for (const auto& [ref, number] : channels_)
    if (robot.sensors[ref.sensor].algorithm) used.insert(ref.sensor);
  for (const std::size_t place : used) {
    const AlgorithmConfig& algorithm = *robot.sensors[place].algorithm;
    for (std::size_t i = 0; i < algorithm.inputs; ++i)
      channels_.emplace(ChannelRef{algorithm.input, algorithm.first + i}, 0);
  }
}

void Tables::use(const ir::Rule& rule) {
  use(rule.condition);
  use(rule.then_response);
  use(rule.else_response);
  if (rule.resume) use(*rule.resume);
}

void Tables::use(const Expression& expression) {
  if (expression.operation == Operation::input) channels_.emplace(expression.channel, 0);
  for (const Expression& operand : expression.operands)
    use(operand);
}

void Tables::use(const ir::Block& block) {
  for_each_statement(block, [this](const ir::Statement& statement) {
    if (const auto* command = std::get_if<ir::Command>(&statement.node)) use(*command);
    if (const auto* halt = std::get_if<ir::Halt>(&statement.node)) use(*halt);
    for_each_expression(statement, [this](const Expression& expression) { use(expression); });
  });
}

void Tables::use(const ir::Command& command) {
  for (const std::size_t actuator : command.actuators)
    actuators_.emplace(actuator, 0);
  if (command.group) groups_.emplace(*command.group, 0);
  if (command.motion) performers_.insert(command.actuators.begin(), command.actuators.end());
  if (command.verb.action == vm::Action::follow)
    followers_.insert(command.actuators.begin(), command.actuators.end());
  if (command.motion && command.actuators.size() > 1) motion_groups_.emplace(*command.motion, 0);
  add_once(verbs_, command.verb);
  if (command.word) add_once(words_, *command.word);
}

void Tables::use(const ir::Halt& halt) {
  for (const std::size_t actuator : halt.actuators)
    actuators_.emplace(actuator, 0);
  if (halt.group) groups_.emplace(*halt.group, 0);
}

void Tables::check_counts(const ir::Program& program, Diagnostics& diagnostics) const {
  const auto check = [&](std::size_t count, std::size_t limit, std::string_view what) {
    if (count > limit)
      diagnostics
          .report(Code::E0407, "the program uses " + std::to_string(count) + " " +
                                   std::string(what) + "; the limit is " + std::to_string(limit))
          .label({});
  };
  // One more group would get the number kAllActuators.
  constexpr std::size_t kMaxGroups = vm::kAllActuators - vm::kGroupBit;
  constexpr std::size_t kInputs = std::min<std::size_t>(vm::kMaxInputs, vm::Limits{}.inputs);
  check(channels_.size() + program.variables.size(), kInputs, "channels and variables");
  check(actuators_.size(), vm::kMaxActuators, "actuators");
  check(groups_.size() + motion_groups_.size(), kMaxGroups, "groups and MOTIONs");
  check(verbs_.size(), vm::kMaxVerbs, "verbs");
  check(words_.size(), vm::kMaxWords, "words and texts");
}

std::uint8_t Tables::target(const ir::Command& command) const {
  if (command.actuators.size() == 1 && !command.group)
    return actuators_.at(command.actuators.front());
  const std::size_t group = command.group ? groups_.at(*command.group)
                                          : groups_.size() + motion_groups_.at(*command.motion);
  return static_cast<std::uint8_t>(vm::kGroupBit | group);
}

std::vector<std::uint8_t> Tables::targets(const ir::Halt& halt) const {
  if (halt.all && actuators_.empty()) return {};
  if (halt.all) return {vm::kAllActuators};
  if (halt.group) return {static_cast<std::uint8_t>(vm::kGroupBit | groups_.at(*halt.group))};
  std::vector<std::uint8_t> targets;
  for (const std::size_t actuator : halt.actuators)
    targets.push_back(actuators_.at(actuator));
  return targets;
}

std::uint32_t Tables::mask_of(const ir::Halt& halt) const {
  if (!halt.all) return mask_of(halt.actuators);
  std::uint32_t mask = 0;
  for (const auto& [place, number] : actuators_)
    mask |= std::uint32_t{1} << number;
  return mask;
}

std::uint32_t Tables::mask_of(const std::vector<std::size_t>& actuators) const {
  std::uint32_t mask = 0;
  for (const std::size_t actuator : actuators)
    mask |= std::uint32_t{1} << actuators_.at(actuator);
  return mask;
}

std::uint8_t Tables::verb(const ir::Command& command) const {
  return place_of(verbs_, command.verb);
}

std::uint8_t Tables::word(const ir::Command& command) const {
  return command.word ? place_of(words_, *command.word) : vm::kNoWord;
}

std::uint32_t Tables::verbs_of(const ActuatorConfig& actuator, std::size_t place) const {
  std::uint32_t mask = 0;
  for (std::size_t v = 0; v < verbs_.size(); ++v) {
    const bool performs = verbs_[v].action == vm::Action::perform && performers_.contains(place);
    const bool follows = verbs_[v].action == vm::Action::follow && followers_.contains(place);
    if (performs || follows) mask |= std::uint32_t{1} << v;
  }
  for (const VerbConfig& verb : actuator.verbs) {
    const auto number = place_of(verbs_, ir::Verb{verb.name, verb.action, verb.carries()});
    if (number < verbs_.size()) mask |= std::uint32_t{1} << number;
  }
  return mask;
}

// ---- texts

std::uint16_t Strings::offset(std::string_view text) {
  // If the strings are too long for an image, their offsets are never used.
  const bool full = text_.size() > UINT16_MAX;
  if (full) return 0;
  const std::size_t end = text_.size() + text.size();
  bool known = !endings_.empty();
  if (!known) endings_.push_back({end});
  std::uint32_t at = 0;
  for (std::size_t i = text.size(); i > 0; --i) {
    const auto next = static_cast<std::uint32_t>(endings_.size());
    const auto [longer, added] = endings_[at].longer.emplace(text[i - 1], next);
    at = longer->second;
    if (added) endings_.push_back({end});
    known = known && !added;
  }
  if (known) return static_cast<std::uint16_t>(endings_[at].end - text.size());
  text_ += text;
  text_ += '\0';
  return static_cast<std::uint16_t>(end - text.size());
}

std::uint16_t Strings::row(const std::vector<std::string>& labels) {
  std::vector<std::uint16_t> row;
  row.reserve(labels.size());
  for (const std::string& label : labels)
    row.push_back(offset(label));
  return place_row(labels_, row);
}

// ---- timers

vm::TimerKind timer_kind(Operation time_word) {
  switch (time_word) {
    case Operation::held:
      return vm::TimerKind::held;
    case Operation::counted:
      return vm::TimerKind::counted;
    case Operation::sequence:
      return vm::TimerKind::sequence;
    case Operation::latch:
      return vm::TimerKind::latch;
    case Operation::rose:
      return vm::TimerKind::rose;
    default:
      return vm::TimerKind::changed;
  }
}

std::size_t Timers::add(const Expression& time_word) {
  vm::Timer timer{};
  timer.kind = timer_kind(time_word.operation);
  if (vm::info_of(timer.kind).counts) timer.count = static_cast<std::uint8_t>(time_word.index);
  timer.state = static_cast<std::uint16_t>(memory_);
  if (timer.kind != vm::TimerKind::latch && timer.kind != vm::TimerKind::rose)
    timer.duration = time_word.constant;
  memory_ += vm::timer_words(timer);
  records_.push_back(timer);
  return records_.size() - 1;
}

}  // namespace robosync::compiler
