#include "tests/compiler/codegen/expected.hpp"

#include <algorithm>
#include <map>

#include "tests/oracles/rsl/response.hpp"

namespace robosync::compiler::testing {
namespace {

std::string told(const std::string& what, const std::map<std::size_t, oracle::Number>& values) {
  std::string text = what;
  for (const auto& [place, value] : values)
    text += " " + std::to_string(place) + ":" + std::to_string(oracle::value_of(value));
  return text;
}

std::string told(const oracle::Effect& effect) {
  std::map<std::size_t, oracle::Number> values;
  if (const auto* said = std::get_if<oracle::Said>(&effect)) {
    for (std::size_t i = 0; i < said->values.size(); ++i)
      values[i] = said->values[i];
    return told((said->alert ? "alert " : "log ") + said->text, values);
  }
  constexpr const char* kNames[] = {"left", "right", "sound"};
  const auto& [actuators, order] = std::get<oracle::Commanded>(effect);
  for (const auto& [param, value] : order.given)
    values[static_cast<std::size_t>(param)] = value;
  return told(order.command->group ? "arms" : kNames[actuators[0]], values);
}

}  // namespace

oracle::Snapshot snapshot_of(const World& world) {
  constexpr std::array<ChannelRef, 4> kChannels = {{{0, 0}, {1, 0}, {1, 1}, {2, 0}}};
  oracle::Snapshot snapshot;
  snapshot.now = world.now;
  for (std::size_t i = 0; i < kChannels.size(); ++i)
    snapshot.channels[kChannels[i]] = oracle::number_of(world.channels[i]);
  for (const vm::Value value : world.variables)
    snapshot.variables.push_back(oracle::number_of(value));
  return snapshot;
}

Effects expected_effects(const ir::Block& block, const std::vector<ir::Variable>& variables,
                         World& world, unsigned pauses, oracle::Chance chance,
                         const std::function<void(World&)>& pass_time) {
  oracle::Evaluator evaluator;
  oracle::Response response(block, 0);
  Effects effects;
  for (unsigned pause = 0; pause <= pauses; ++pause) {
    const oracle::Snapshot snapshot = snapshot_of(world);
    const oracle::Surroundings around{evaluator, chance, variables, snapshot, world.now, true};
    if (!response.waits() || response.may_go_on(around)) {
      const oracle::Output output = response.run(around);
      for (const oracle::Effect& effect : output.effects)
        effects.push_back(told(effect));
      for (const auto& [variable, value] : output.seen)
        world.variables[variable] = oracle::value_of(value);
    }
    if (!response.waits() || pause == pauses) break;
    const oracle::Millis next = world.now + 1;
    world.now = static_cast<std::uint32_t>(std::max(next, response.wait_ends().value_or(next)));
    pass_time(world);
  }
  return effects;
}

}  // namespace robosync::compiler::testing
