// The transfers that a driver has requested from the bus.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "runtime-m4/policy/costs.hpp"
#include "tests/runtime-m4/rig.hpp"

namespace robosync::test {

using Transfers = std::vector<NotingBoard::Transfer>;

inline std::size_t writes_of(const Transfers& transfers) {
  return static_cast<std::size_t>(
      std::ranges::count_if(transfers, [](const auto& one) { return one.in == 0; }));
}

// Including addresses; a transfer that reads has two.
inline std::size_t bytes_of(const Transfers& transfers) {
  std::size_t bytes = 0;
  for (const auto& one : transfers)
    bytes += 1 + one.out.size() + (one.in == 0 ? 0 : 1 + one.in);
  return bytes;
}

// The declaration of one sample of a driver in vm/drivers.def.
struct Declared {
  std::size_t transfers, bytes;
};
constexpr Declared declared_of(vm::DriverId driver) {
  policy::BoardCosts transfers = policy::kOneEach, bytes = policy::kOneEach;
  transfers.i2c_byte = 0;
  bytes.i2c_transfer = 0;
  return {policy::sample_cost(driver, transfers), policy::sample_cost(driver, bytes)};
}

}  // namespace robosync::test
