// Names for what an image only numbers.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "compiler/source/utf8.hpp"
#include "link/messages.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

// The name in vm/drivers.def.
[[nodiscard]] constexpr std::string_view driver_name(vm::DriverId driver) {
  constexpr std::array<std::string_view, static_cast<std::size_t>(vm::DriverId::count_)> kNames = {
#define SENSOR_DRIVER(name, ...) #name,
#define ACTUATOR_DRIVER(name, ...) #name,
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER
  };
  const auto index = static_cast<std::size_t>(driver);
  return index < kNames.size() ? kNames[index] : "unknown";
}

inline constexpr std::array<std::string_view, static_cast<std::size_t>(vm::RuleKind::count_)>
    kRuleKinds = {"when", "when/else", "while", "every", "at start", "watch", "safety", "resume"};

// A NUL-padded name from the wire. It is not trusted: a terminal would obey control characters.
[[nodiscard]] inline std::string text_of(const link::Name& name) {
  return compiler::utf8::printable({name.begin(), std::find(name.begin(), name.end(), '\0')});
}

// A program's hash, as shown to people.
[[nodiscard]] inline std::string text_of(const link::ProgramHash& hash) {
  return fmt::format("{:02x}", fmt::join(hash, ""));
}

// "touch at address 0x70 on i2c bus 0"; on SPI, with its select pin in place of the address: "knob on spi bus 0, select pin 16,"
[[nodiscard]] inline std::string name_on_bus(std::string_view sensor, unsigned address,
                                             unsigned bus, bool spi) {
  return spi ? fmt::format("{} on spi bus {}, select pin {},", sensor, bus, address)
             : fmt::format("{} at address 0x{:02x} on i2c bus {}", sensor, address, bus);
}

template <typename Enum, std::size_t N>
std::string_view word_of(const std::array<std::string_view, N>& words, Enum value) {
  return words.at(static_cast<std::size_t>(value));
}

}  // namespace robosync::tool
