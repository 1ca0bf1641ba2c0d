// The memory that rsc and a module's process share: each writes its own half, and can only read the other's. Nothing that the
// process leaves is trusted: bounds are checked where it is read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "runtime-m4/algorithms/robosync_module.h"

namespace robosync::module_files {

// What the process is asked to do, and what it is doing.
enum class Call : std::uint8_t { describe, sizes, init, process };
enum class Doing : std::uint8_t {
  loading,
  describing,
  state_bytes,
  scratch_bytes,
  cost,
  init,
  process
};

// The outcome. The last ones are for a process that has ended.
enum class Came : std::uint8_t {
  nothing,  // yet
  fine,
  not_confined,
  not_loaded,  // `text` says why
  no_function,
  other_interface,
  incomplete,    // something is NULL that must not be
  too_many,      // inputs, outputs, parameters or words
  beyond_state,  // it wrote or read there
  beyond_scratch,
  beyond_outputs,
  into_inputs,
  into_statics,
  elsewhere,
  not_arithmetic,  // a division by zero, or an overflow if it was compiled to stop there
};

inline constexpr std::size_t kMostName = 48;  // including the final 0
inline constexpr std::size_t kMostWords = 64;
using Name = std::array<char, kMostName>;

struct DescribedOutput {
  Name name;
  std::uint8_t unit, words;
  std::int32_t least, most;
};

// A module as it describes itself, without a pointer.
struct Described {
  std::uint8_t inputs, outputs, parameters;
  std::uint16_t shortest_period_ms, longest_period_ms, usual_period_ms;
  Name name;
  std::array<Name, ROBOSYNC_MOST_INPUTS> input_names;
  std::array<std::uint8_t, ROBOSYNC_MOST_INPUTS> input_units;
  std::array<DescribedOutput, ROBOSYNC_MOST_OUTPUTS> output;
  std::array<Name, kMostWords> words;  // of all outputs, one after the other
  std::array<Name, ROBOSYNC_MOST_PARAMETERS> parameter_names;
  std::array<std::uint8_t, ROBOSYNC_MOST_PARAMETERS> parameter_units;
  std::array<robosync_range, ROBOSYNC_MOST_PARAMETERS> ranges;
};

struct Sizes {
  std::uint32_t state = 0, scratch = 0, cost = 0;
};

using Config = std::array<std::int32_t, ROBOSYNC_MOST_PARAMETERS>;
using Inputs = std::array<std::int32_t, ROBOSYNC_MOST_INPUTS>;
using Outputs = std::array<std::int32_t, ROBOSYNC_MOST_OUTPUTS>;
using State = std::array<std::byte, ROBOSYNC_MOST_BYTES>;

struct Request {
  Call call;
  std::uint8_t scratch_holds;  // in each byte: a module must not depend on it
  std::uint32_t period_ms;
  Config config;
  Inputs inputs;
  Outputs outputs;
  State state;
};

struct Reply {
  Came came;
  Doing doing;
  std::uint32_t changed;
  Sizes sizes;
  Outputs outputs;
  State state;
  Described described;
  std::array<char, 256> text;
};

}  // namespace robosync::module_files
