// See judge.hpp.
#include "runtime-m4/algorithms/judge.hpp"

namespace robosync::algorithms {
namespace {

using vm::Refusal;

// Its inputs must be channels of one sensor, which is measured and not an algorithm itself.
bool can_read(const vm::Image& image, const vm::Sensor& algorithm, unsigned inputs) {
  const vm::Channel& first = image.channels[algorithm.first_input];
  const vm::Sensor& sensor = image.sensors[first.sensor];
  return sensor.driver != vm::DriverId::algorithm &&
         algorithm.first_input + inputs <= sensor.first_channel + unsigned{sensor.channel_count};
}

bool are_in_range(const robosync_module& module, const std::int32_t* config) {
  for (unsigned p = 0; p < module.parameters; ++p)
    if (config[p] < module.ranges[p].least || config[p] > module.ranges[p].most) return false;
  return true;
}

bool has_room(const robosync_module& module, const vm::Sensor& algorithm,
              const std::int32_t* config) {
  static_assert(ROBOSYNC_MOST_BYTES % 8 == 0 && ROBOSYNC_ROOM % 8 == 0);
  const std::uint32_t most = most_bytes(algorithm);
  return module.state_bytes(config) <= most &&
         module.scratch_bytes(config) <= most - scratch_at(module, config);
}

// What the module was taught must be there, and not be more than it may be.
Refusal judge_constants(const vm::Image& image, std::size_t place) {
  if (place >= image.constants.size()) return Refusal::bad_index;
  const vm::Value count = image.constants[place];
  if (count > ROBOSYNC_MOST_CONSTANTS) return Refusal::no_room;
  const bool is_there =
      count >= 0 && static_cast<std::size_t>(count) < image.constants.size() - place;
  return is_there ? Refusal::none : Refusal::bad_index;
}

Refusal judge(const vm::Image& image, const vm::Sensor& algorithm) {
  const robosync_module* const module = find_module(algorithm.bus);
  if (module == nullptr) return Refusal::no_module;
  if (!can_read(image, algorithm, module->inputs)) return Refusal::wrong_input;
  if (algorithm.address + std::size_t{module->parameters} > image.constants.size())
    return Refusal::bad_index;
  const std::int32_t* const config = config_of(image, algorithm);
  if (module->learns != 0) {
    const Refusal refusal =
        judge_constants(image, algorithm.address + std::size_t{module->parameters});
    if (refusal != Refusal::none) return refusal;
  }
  bool good = are_in_range(*module, config) && algorithm.period_ms >= module->shortest_period_ms &&
              algorithm.period_ms <= module->longest_period_ms;
  for (unsigned i = 0; i < algorithm.channel_count; ++i)
    good = good && image.channels[algorithm.first_channel + i].input < module->outputs;
  if (!good) return Refusal::bad_value;
  return has_room(*module, algorithm, config) ? Refusal::none : Refusal::no_room;
}

}  // namespace

vm::Verdict judge(const vm::Image& image) {
  for (std::size_t s = 0; s < image.sensors.size(); ++s) {
    if (image.sensors[s].driver != vm::DriverId::algorithm) continue;
    const Refusal refusal = judge(image, image.sensors[s]);
    if (refusal != Refusal::none)
      return {refusal, vm::Section::sensors, static_cast<std::uint16_t>(s)};
  }
  return {};
}

}  // namespace robosync::algorithms
