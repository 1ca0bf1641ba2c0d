// A module without a robot, fed sample by sample.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "runtime-m4/algorithms/modules.hpp"

namespace robosync::test {

class Module {
public:
  // `config`: in the order of its parameters; missing ones have their defaults.
  Module(const robosync_description& description, std::vector<std::int32_t> config = {},
         std::uint32_t period_ms = 20);

  // Returns the changes, as "LEVEL light TOUCH tap"; numbers in thousandths.
  std::string put(std::initializer_list<std::int32_t> inputs);
  std::int32_t output(std::size_t place) const { return outputs_[place]; }

private:
  std::string shown(std::size_t place) const;

  const robosync_description& description_;
  std::vector<std::int32_t> config_;
  std::vector<std::int32_t> outputs_;
  std::vector<std::uint64_t> state_, scratch_;  // aligned to 8 bytes
};

}  // namespace robosync::test
