#include "analysis/response_work.hpp"

#include <algorithm>

#include "analysis/costs.hpp"
#include "runtime-m4/policy/rules.hpp"
#include "vm/opcode.hpp"

namespace robosync::analysis {
namespace {

using vm::Effect;
using vm::Flow;

const vm::OpcodeInfo& info_of(vm::Word word) {
  return vm::info_of(vm::opcode_of(word));
}

bool pauses(vm::Word word) {
  return vm::always_pauses(info_of(word).flow);
}

// The end of a loop that may come round within a step.
bool is_loop_end(vm::Word word) {
  const Flow flow = info_of(word).flow;
  return flow == Flow::count_end || flow == Flow::loop_end;
}

constexpr Instructions kMany = vm::kMaxResponseOutput;

Instructions times_of(const vm::Image& image, vm::Word begin) {
  if (info_of(begin).operands[1] != vm::Operand::count16) return kMany;
  const vm::Value times = image.constants[vm::operand_wide(begin)] / vm::kScale;
  return static_cast<Instructions>(std::max(times, 1));
}

// How often each word can run in one step. A loop with a pause in it comes round once: the step ends
// there. A computed number of rounds is limited only by the output.
std::vector<Instructions> turns_of(const vm::Image& image, std::span<const vm::Word> code) {
  std::vector<Instructions> turns(code.size(), 1);
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (info_of(code[i]).flow != Flow::count_end) continue;
    const std::size_t first = i + 1 - std::min<std::size_t>(vm::operand_wide(code[i]), i + 1);
    const auto body = code.subspan(first, i - first);
    if (std::ranges::any_of(body, pauses)) continue;
    const Instructions times = first == 0 ? kMany : times_of(image, code[first - 1]);
    for (std::size_t w = first; w < i; ++w)
      turns[w] = std::min(turns[w] * times, kMany);
  }
  return turns;
}

// The code between two pauses: one step runs it.
struct Part {
  explicit Part(std::size_t actuators) : commands(actuators), busy(actuators) {}
  Instructions other = 0;
  std::vector<Instructions> commands;  // by actuator
  std::vector<bool> busy;              // … certainly, with a command of this part
};

class Reader {
public:
  Reader(const vm::Image& image, const vm::Behavior& behavior, const vm::Response& response)
      : image_(image),
        behavior_(behavior),
        code_(image.code.subspan(response.start, response.length)),
        part_(image.actuators.size()) {}

  ResponseWork read() {
    const std::vector<Instructions> turns = turns_of(image_, code_);
    work_.by_actuator.resize(image_.actuators.size());
    for (std::size_t i = 0; i < code_.size(); ++i) {
      take(i, turns[i]);
      if (pauses(code_[i])) end_part();
      if (paused_ && is_loop_end(code_[i])) go_round(i, turns);
    }
    end_part();
    limit();
    return work_;
  }

private:
  // The worst part counts.
  void end_part() {
    work_.other = std::max(work_.other, part_.other);
    for (std::size_t a = 0; a < part_.commands.size(); ++a)
      work_.by_actuator[a] = std::max(work_.by_actuator[a], part_.commands[a]);
    part_ = Part(image_.actuators.size());
  }

  // At the end of a loop, the end of one part and the beginning of another run in one step.
  void go_round(std::size_t at, const std::vector<Instructions>& turns) {
    const Part part = part_;
    for (std::size_t i = at + 1 - vm::operand_wide(code_[at]); i < at; ++i) {
      if (pauses(code_[i])) break;
      take(i, turns[i]);
    }
    end_part();
    part_ = part;
  }

  void take(std::size_t at, Instructions turns) {
    const vm::Word word = code_[at];
    note_flow(word);
    switch (info_of(word).effect) {
      case Effect::command:
        work_.follows = work_.follows || follows(word);
        return command(word, turns);
      case Effect::log:
      case Effect::alert:
        part_.other += turns * costs::kText;
        return;
      case Effect::param:
        part_.other += turns * costs::kArgument;
        return note_parameter(word);
      case Effect::set:
        return set(image_.inputs[behavior_.first_input + vm::operand_a(word)], turns);
      case Effect::none:
      case Effect::division:
      case Effect::event:
      case Effect::draw:
      case Effect::clock:
      case Effect::halt:
        return;
    }
  }

  void note_flow(vm::Word word) {
    paused_ = paused_ || pauses(word);
    if (info_of(word).flow == Flow::poll_begin) work_.polls = true;
  }

  void set(std::size_t input, Instructions turns) {
    part_.other += turns * costs::kSet;
    work_.sets.set(input);
    if (paused_) work_.later_sets.set(input);
  }

  // For the next command. The value of a computed parameter is unknown: the order may be void.
  void note_parameter(vm::Word word) {
    const bool constant = info_of(word).operands[1] == vm::Operand::const16;
    if (!constant) takes_time_ = false;
    if (constant)
      note_parameter(static_cast<vm::Param>(vm::operand_a(word)),
                     image_.constants[vm::operand_wide(word)]);
  }

  // No speed: it is done immediately. A short time: as good as immediately, since an actuator is served once in a setpoint period.
  void note_parameter(vm::Param param, vm::Value value) {
    const bool times = param == vm::Param::over || param == vm::Param::for_;
    const bool stands = param == vm::Param::at && value <= 0;
    const bool is_short = times && policy::milliseconds_of(value) < policy::kSetpointPeriodMs;
    takes_time_ = takes_time_ && !stands && !is_short;
  }

  bool follows(vm::Word word) const {
    return image_.verbs[vm::operand_b(word)].action == vm::Action::follow;
  }

  void command(vm::Word word, Instructions turns) {
    if (follows(word)) takes_time_ = false;  // without a speed it has its new value immediately
    const bool stops = image_.verbs[vm::operand_b(word)].action == vm::Action::stop;
    if (vm::operand_c(word) < image_.words.size()) {
      const vm::WordEntry& said = image_.words[vm::operand_c(word)];
      note_parameter(said.param, said.value);
    }
    const std::uint32_t targets = image_.target_mask(vm::operand_a(word));
    for (std::size_t a = 0; a < image_.actuators.size(); ++a)
      if ((targets >> a & 1) != 0) command(a, stops, turns);
    takes_time_ = true;
  }

  // A command that takes time leaves the others behind it in the queue. One that is done immediately, or
  // may be, lets the next one begin in the same step.
  void command(std::size_t a, bool stops, Instructions turns) {
    const vm::Actuator& actuator = image_.actuators[a];
    const policy::ActuatorCosts driver = policy::actuator_costs(image_, a);
    const bool stands = actuator.speed_limit <= 0 || actuator.min == actuator.max;
    const Instructions started = Instructions{costs::kCommand} + driver.start;
    if (stops || driver.at_once || !takes_time_ || stands) {
      part_.commands[a] += turns * (started + costs::kDone);
      if (stops) part_.busy[a] = false;
      return;
    }
    const Instructions first = part_.busy[a] ? 0 : 1;
    part_.commands[a] += first * started + (turns - first) * costs::kQueued;
    part_.busy[a] = true;
  }

  // The verifier allows no more words of output in a step.
  void limit() {
    constexpr Instructions kMost = vm::kMaxResponseOutput;
    constexpr Instructions kEach = costs::kCommand + costs::kDone;
    for (std::size_t a = 0; a < work_.by_actuator.size(); ++a) {
      const Instructions start = policy::actuator_costs(image_, a).start;
      work_.by_actuator[a] = std::min(work_.by_actuator[a], kMost * (kEach + start));
    }
    work_.other = std::min(work_.other, kMost * kEach);
  }

  const vm::Image& image_;
  const vm::Behavior& behavior_;
  std::span<const vm::Word> code_;
  ResponseWork work_;
  Part part_;
  bool paused_ = false;
  bool takes_time_ = true;  // by the next command, as far as its parameters say
};

}  // namespace

ResponseWork work_of(const vm::Image& image, const vm::Behavior& behavior, std::uint16_t response,
                     const Ranges& inputs) {
  ResponseWork nothing;
  nothing.by_actuator.resize(image.actuators.size());
  if (response == vm::kNoIndex) return nothing;
  ResponseWork work = Reader(image, behavior, image.responses[response]).read();
  work.pauses = pauses_of(image, behavior, image.responses[response], inputs);
  return work;
}

}  // namespace robosync::analysis
