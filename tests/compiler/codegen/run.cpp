#include "tests/compiler/codegen/run.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

#include "tests/oracles/rsl/response.hpp"
#include "vm/output.hpp"

namespace robosync::compiler::testing {
namespace {

constexpr vm::Value kGarbage = 987654321;  // neither a truth nor a number of any test

std::string target_name(const vm::Image& image, std::uint8_t target) {
  if (target == vm::kAllActuators) return "ALL";
  if ((target & vm::kGroupBit) != 0)
    return std::string(image.string(image.groups[target & ~vm::kGroupBit & 0xFF].name));
  return std::string(image.string(image.actuators[target].name));
}

std::string describe(const vm::Image& image, const vm::Output& output, const vm::Params& params) {
  std::string text;
  switch (output.kind) {
    case vm::OutputKind::command:
      text = target_name(image, output.target);
      break;
    case vm::OutputKind::log:
      text = "log " + std::string(image.string(output.text));
      break;
    case vm::OutputKind::alert:
      text = "alert " + std::string(image.string(output.text));
      break;
    case vm::OutputKind::halt:
      text = "halt " + target_name(image, output.target);
      break;
    case vm::OutputKind::none:
      break;
  }
  for (std::size_t param = 0; param < params.size(); ++param)
    if ((output.given >> param & 1) != 0)
      text += " " + std::to_string(param) + ":" + std::to_string(params[param]);
  return text;
}

}  // namespace

Runner::Runner(const vm::Image& image, std::size_t behavior)
    : image_(image), behavior_(image.behaviors[behavior]), timer_memory_(4096) {
  machine.frame = frame_.data();
  machine.constants = image.constants.data();
  machine.timers = image.timers.data();
  machine.timer_memory = timer_memory_.data();
}

// Which of the world's values the cell is; variables follow the channels.
std::uint32_t Runner::input_of(unsigned cell) const {
  return image_.inputs[behavior_.first_input + cell];
}

// Inputs are latched; locals stay; registers and what lies beyond the frame is garbage.
void Runner::latch(const World& world) {
  for (unsigned cell = 0; cell < behavior_.input_count; ++cell) {
    const std::uint32_t input = input_of(cell);
    if (input >= image_.channels.size()) {
      frame_[cell] = world.variables[input - image_.channels.size()];
      continue;
    }
    const vm::Channel& channel = image_.channels[input];
    const std::string_view name = image_.string(channel.name);
    constexpr std::string_view kNames[] = {"LEVEL", "DISTANCE", "LIGHT", "KEY"};
    frame_[cell] = world.channels[static_cast<std::size_t>(
        std::find(std::begin(kNames), std::end(kNames), name) - std::begin(kNames))];
  }
  std::fill(frame_.begin() + behavior_.input_count + behavior_.locals, frame_.end(), kGarbage);
  machine.now = world.now;
  machine.wake = vm::Machine::kNever;
  machine.assigned = machine.shifted = 0;
}

// As the next step does: what was raised and lowered is bounded once.
void Runner::commit(World& world) {
  for (unsigned cell = 0; cell < behavior_.input_count; ++cell) {
    if (cell >= vm::kMaxWritable || (machine.written() >> cell & 1) == 0) continue;
    const std::size_t variable = input_of(cell) - image_.channels.size();
    const vm::Variable& wiring = image_.variables[variable];
    world.variables[variable] = std::clamp(frame_[cell], wiring.min, wiring.max);
  }
}

void Runner::evaluate_watches() {
  unsigned cell = behavior_.input_count + behavior_.locals;
  for (unsigned i = 0; i < behavior_.rule_count; ++i) {
    const vm::Rule& rule = image_.rules[behavior_.first_rule + i];
    if (rule.kind == vm::RuleKind::watch)
      frame_[cell++] = vm::evaluate(machine, image_.code.data() + rule.condition_start);
  }
}

vm::Value Runner::condition(std::size_t rule, const World& world) {
  latch(world);
  return vm::evaluate(
      machine, image_.code.data() + image_.rules[behavior_.first_rule + rule].condition_start);
}

void Runner::take_output(Effects& effects) {
  vm::Params params{};
  vm::OutputReader reader(
      {output_.data(), static_cast<std::size_t>(machine.output - output_.data())}, params);
  vm::Output output;
  while (reader.next(output))
    effects.push_back(describe(image_, output, params));
}

namespace {

std::uint32_t next_time(const vm::Progress& progress, std::uint32_t now) {
  switch (progress.pause) {
    case vm::Pause::until_time:
    case vm::Pause::satisfied:
      return progress.wake;
    case vm::Pause::until_done:  // there is nothing to be done
      return now + oracle::kLeastPause;
    default:
      return now + 1;
  }
}

}  // namespace

Effects Runner::respond(std::size_t rule, World& world, unsigned pauses,
                        const std::function<void(World&)>& pass_time) {
  Effects effects;
  const auto response = image_.rules[behavior_.first_rule + rule].then_response;
  const vm::Word* code = image_.code.data() + image_.responses[response].start;
  ended = false;
  oracle::Millis ran = world.now;
  for (unsigned pause = 0; pause <= pauses; ++pause) {
    latch(world);
    evaluate_watches();
    machine.left_ms = static_cast<std::uint8_t>(
        std::max<oracle::Millis>(ran + oracle::kLeastPause - world.now, 0));
    machine.output = output_.data();
    machine.output_end = output_.data() + output_.size();
    const vm::Progress progress = vm::respond(machine, code);
    take_output(effects);
    commit(world);
    ended = progress.pause == vm::Pause::ended;
    if (ended || pause == pauses) break;
    code = progress.next;
    if (progress.pause != vm::Pause::still_polling && progress.pause != vm::Pause::satisfied)
      ran = world.now;
    world.now = next_time(progress, world.now);
    if (pass_time) pass_time(world);
  }
  return effects;
}

}  // namespace robosync::compiler::testing
