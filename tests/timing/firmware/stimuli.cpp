#include "tests/timing/firmware/stimuli.hpp"

namespace robosync::timing {
namespace {

constexpr std::array<vm::Value, 15> kEdges = {
    0,    1,     -1,        499,        500,     1000,          -1000,        -1500,
    3000, 46341, 123456789, -987654321, 0x7FFFF, vm::kValueMax, vm::kValueMin};

struct Range {
  vm::Value least, most;
};

Range range_of(const vm::Image& image, std::size_t input) {
  const std::size_t channels = image.channels.size();
  if (input < channels) return {image.channels[input].min, image.channels[input].max};
  const vm::Variable& variable = image.variables[input - channels];
  if (variable.label_count > 0) return {0, (variable.label_count - 1) * vm::kScale};
  return {variable.min, variable.max};
}

}  // namespace

// Marsaglia's xorshift32.
std::uint32_t Stimuli::draw(std::uint32_t below) {
  state_ ^= state_ << 13;
  state_ ^= state_ >> 17;
  state_ ^= state_ << 5;
  return static_cast<std::uint32_t>(std::uint64_t{state_} * below >> 32);
}

vm::Value Stimuli::value(const vm::Image& image, std::size_t input) {
  const Range range = range_of(image, input);
  const auto width =
      static_cast<std::uint32_t>(range.most) - static_cast<std::uint32_t>(range.least);
  const auto constants = static_cast<std::uint32_t>(image.constants.size());
  switch (draw(9)) {
    case 0:
      return vm::kUnknown;
    case 1:
      return range.least;
    case 2:
      return range.most;
    case 3:
      return kEdges[draw(kEdges.size())];
    case 4:
      return static_cast<vm::Value>(draw(11)) * vm::kScale;
    case 5:
    case 6:
      if (constants > 0) {
        const auto near = static_cast<std::uint32_t>(image.constants[draw(constants)]);
        return static_cast<vm::Value>(near + draw(3) - 1);
      }
      [[fallthrough]];
    default:
      return static_cast<vm::Value>(static_cast<std::uint32_t>(range.least) +
                                    draw(width == UINT32_MAX ? width : width + 1));
  }
}

// Milliseconds from one step to the next.
std::uint32_t Stimuli::passing(const vm::Image& image) {
  constexpr std::array<std::uint32_t, 6> kPauses = {1, 2, 50, 200, 1500, 20000};
  const auto timers = static_cast<std::uint32_t>(image.timers.size());
  if (timers == 0 || draw(2) == 0) return 1 + draw(kPauses[draw(kPauses.size())]);
  const auto duration = static_cast<std::uint32_t>(image.timers[draw(timers)].duration);
  return (duration == 0 ? 1 : duration) + draw(3) - 1;
}

void Stimuli::respond(Robot& robot, std::size_t rule, bool eager) {
  const bool goes_on = robot.has(rule, Run::on) && draw(4) != 0;
  const Run side = robot.has(rule, Run::otherwise) && draw(2) == 0 ? Run::otherwise : Run::then;
  const Run run = goes_on ? Run::on : side;
  if (!robot.has(rule, run) || (!eager && draw(3) == 0))
    robot.skip(rule);
  else
    robot.respond(rule, run);
}

void Stimuli::step(Robot& robot, const vm::Image& image) {
  const std::uint32_t keeps = draw(4);  // of 4 inputs
  for (std::size_t input = 0; input < robot.inputs(); ++input)
    if (draw(4) >= keeps) robot.set_input(input, value(image, input));
  now_ += passing(image);
  robot.evaluate(now_);
  const bool eager = draw(2) == 0;
  for (std::size_t rule = 0; rule < image.rules.size(); ++rule)
    respond(robot, rule, eager);
}

}  // namespace robosync::timing
