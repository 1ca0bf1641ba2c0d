// An order to an actuator's driver.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "vm/image.hpp"

namespace robosync::drivers {

// What an actuator must do. When a driver gets it, the parameters are known values inside the actuator's range and limits.
struct Order {
  vm::Action action = vm::Action::stop;
  std::uint8_t given = 0;  // bit p: params[p] is given; the others are undefined
  vm::Params params;

  constexpr bool has(vm::Param param) const {
    return (given >> static_cast<unsigned>(param) & 1) != 0;
  }
  vm::Value get(vm::Param param, vm::Value otherwise) const {
    return has(param) ? (*this)[param] : otherwise;
  }
  void give(vm::Param param, vm::Value value) {
    (*this)[param] = value;
    given = static_cast<std::uint8_t>(given | 1U << static_cast<unsigned>(param));
  }
  // No parameter that is given is kUnknown.
  bool is_known() const {
    for (unsigned left = given; left != 0; left &= left - 1)
      if (params[static_cast<std::size_t>(std::countr_zero(left))] == vm::kUnknown) return false;
    return true;
  }
  vm::Value& operator[](vm::Param param) { return params[static_cast<std::size_t>(param)]; }
  vm::Value operator[](vm::Param param) const { return params[static_cast<std::size_t>(param)]; }
};

}  // namespace robosync::drivers
