// See order.hpp.
#include "runtime-m4/layers/order.hpp"

#include <algorithm>

namespace robosync::layers {
namespace {

using vm::Param;

constexpr auto kParams = static_cast<unsigned>(Param::count_);

}  // namespace

drivers::Order resolve(const vm::Image& image, const Command& command) {
  drivers::Order order{.action = image.verbs[command.verb()].action, .given = command.given()};
  for (unsigned p = 0; p < kParams; ++p)
    order.params[p] = command.param(p);
  if (command.word() < image.words.size()) {
    const vm::WordEntry& word = image.words[command.word()];
    if (!order.has(word.param)) {
      order.params[static_cast<std::size_t>(word.param)] = word.value;
      order.given =
          static_cast<std::uint8_t>(order.given | 1U << static_cast<unsigned>(word.param));
    }
  }
  const vm::Actuator& actuator = image.actuators[command.actuator()];
  for (unsigned p = 0; p < kParams; ++p)
    order.params[p] = limited(actuator, static_cast<Param>(p), order.params[p]);
  return order;
}

vm::Value limited(const vm::Actuator& actuator, Param param, vm::Value value) {
  if (value == vm::kUnknown) return value;
  if (param == Param::to) return std::clamp(value, actuator.min, actuator.max);
  if (param == Param::at) return std::clamp(value, vm::Value{0}, actuator.speed_limit);
  return value;
}

bool is_void(const drivers::Order& order) {
  for (unsigned p = 0; p < kParams; ++p)
    if ((order.given >> p & 1) != 0 && order.params[p] == vm::kUnknown) return true;
  return false;
}

}  // namespace robosync::layers
