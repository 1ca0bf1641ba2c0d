// A strip of WS2812 lights, all in one colour, like a lamp. LIGHT sets its brightness as on a pin (power.hpp), and its colour,
// which stays until another one is named. With OVER the brightness changes evenly, and the colour immediately. BLINK flashes
// TIMES within OVER, and leaves the strip as it was.
#include <algorithm>
#include <array>

#include "runtime-m4/drivers/blink.hpp"
#include "runtime-m4/drivers/power.hpp"

namespace robosync::drivers::ws2812_strip {
namespace {

struct Color {
  std::uint8_t red, green, blue;
};
constexpr std::array kColors = {
#define COLOR(name, red, green, blue) Color{red, green, blue},
#include "vm/colors.def"
#undef COLOR
};

// Indexes in kColors: the strip's, and that of a BLINK.
vm::Value pack(unsigned color, unsigned flash) {
  return static_cast<vm::Value>(color | flash << 8);
}
unsigned color_in(vm::Value home) {
  return static_cast<unsigned>(home) & 0xFF;
}
unsigned flash_in(vm::Value home) {
  return static_cast<unsigned>(home) >> 8;
}

unsigned named_color(const Order& order, unsigned otherwise) {
  if (!order.has(vm::Param::item)) return otherwise;
  const auto item = static_cast<unsigned>(order.get(vm::Param::item, 0) / vm::kScale);
  return item < kColors.size() ? item : 0;
}

// `brightest` is white at full power. A part of the colour that is not 0 stays at least 1, so that a dim light keeps its colour.
std::uint32_t light(unsigned color, vm::Value percent, std::uint32_t brightest) {
  const auto level = static_cast<std::uint32_t>(std::clamp(percent, vm::Value{0}, power::kFull));
  if (level == 0) return 0;
  const auto part = [&](std::uint32_t full) {
    constexpr std::uint32_t kWhole = 255 * std::uint32_t{power::kFull};
    return full == 0 ? 0 : std::max(full * (brightest & 0xFF) * level / kWhole, std::uint32_t{1});
  };
  const Color& pure = kColors[color];
  return part(pure.red) << 16 | part(pure.green) << 8 | part(pure.blue);
}

void show(const Device& device, unsigned color, vm::Value percent) {
  device.show(light(color, percent, static_cast<std::uint32_t>(device.wiring.speed_limit)));
}

void show_present(const Device& device, kernel::Time now) {
  show(device, color_in(device.state.home), device.state.motion.at(now));
}

// The first leg of a flash is lit, the second one dark.
void show_leg(const Device& device, kernel::Time now) {
  const vm::Value present = device.state.motion.at(now);
  const bool lit = device.state.legs % 2 == 0;
  const vm::Value level = present > 0 ? present : power::kFull;
  show(device, flash_in(device.state.home), lit ? level : 0);
}

kernel::Time blink(const Device& device, const Order& order, kernel::Time now) {
  power::stop(device, vm::Release::hold, now);
  const Blink blink = blink_of(order);
  const unsigned color = color_in(device.state.home);
  device.state.home = pack(color, named_color(order, color));
  device.state.speed = static_cast<vm::Value>(blink.leg);
  device.state.legs = static_cast<std::uint16_t>(blink.legs);
  device.state.until = now + blink.leg;
  show_leg(device, now);
  return device.state.until;
}

kernel::Time next_leg(const Device& device, kernel::Time now) {
  if (now < device.state.until) return device.state.until;
  if (--device.state.legs == 0) {
    device.state.until = 0;
    show_present(device, now);
    return kDone;
  }
  show_leg(device, now);
  device.state.until = now + static_cast<kernel::Duration>(device.state.speed);
  return device.state.until;
}

}  // namespace

kernel::Time start(const Device& device, const Order& order, kernel::Time now) {
  device.state.legs = 0;
  if (order.action == vm::Action::play) return blink(device, order, now);
  device.state.home = pack(named_color(order, color_in(device.state.home)), 0);
  power::begin(device, order, order.get(vm::Param::to, power::kFull), now);
  return advance(device, now);
}

kernel::Time advance(const Device& device, kernel::Time now) {
  if (device.state.legs > 0) return next_leg(device, now);
  const kernel::Time due = power::advance(device, now);
  show_present(device, now);
  return due;
}

void release(const Device& device, vm::Release how, kernel::Time now) {
  device.state.legs = 0;
  power::stop(device, how, now);
  show_present(device, now);
}

}  // namespace robosync::drivers::ws2812_strip
