// The messages between the layers, one type for each hop of the paper:
//
//   sensor      --Reading (M_sp)-->   processing
//   processing  --Snapshot (M_pb)-->  behaviour
//   behaviour   --Command (M_bc)-->   control
//
// Only the layer that a message comes from can make one, and only the next layer has a function that
// takes it: a hop that skips a layer does not compile.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "runtime-m4/drivers/order.hpp"
#include "runtime-m4/kernel/time.hpp"
#include "vm/image.hpp"

namespace robosync::layers {

using ChannelMask = std::uint32_t;   // bit c: channel c of the image
using VariableMask = std::uint32_t;  // bit v: variable v of the image
// Channels in the lower half, variables in the upper one, so extracting a half is free.
using InputMask = std::uint64_t;
constexpr InputMask inputs(ChannelMask channels, VariableMask variables) {
  return InputMask{variables} << 32 | channels;
}
constexpr ChannelMask channels_of(InputMask inputs) {
  return static_cast<ChannelMask>(inputs);
}
constexpr VariableMask variables_of(InputMask inputs) {
  return static_cast<VariableMask>(inputs >> 32);
}
using ActuatorMask = std::uint32_t;  // bit a: actuator a
// Bit b: behaviour b; 0 has the highest priority.
using BehaviorMask = std::uint64_t;

template <class Mask>
constexpr Mask bit(unsigned index) {
  return Mask{1} << index;
}
template <class Mask>
constexpr bool has(Mask mask, unsigned index) {
  return (mask >> index & 1) != 0;
}

// The lowest bit of a mask that is not 0. The library would call a function for 64 bits.
constexpr unsigned lowest_bit(BehaviorMask mask) {
  const auto lower = static_cast<std::uint32_t>(mask);
  if (lower != 0) [[likely]]
    return static_cast<unsigned>(std::countr_zero(lower));
  return 32 + static_cast<unsigned>(std::countr_zero(static_cast<std::uint32_t>(mask >> 32)));
}

// Calls take(bit) for each bit of a 32-bit mask, from the lowest up. The loop tests at its end: where the compiler saves
// flash, that takes two instructions less per iteration.
template <class Take>
void each_bit(std::uint32_t mask, Take take) {
  if (mask == 0) return;
  do {
    take(static_cast<unsigned>(std::countr_zero(mask)));
    mask &= mask - 1;
  } while (mask != 0);
}

// A place in the program's history: the stamp of an event.
struct Stamp {
  kernel::Time time = 0;   // microseconds since activation
  std::uint32_t step = 0;  // the step under way, or the last one
};

// A channel's measurement: scaled, and inside the channel's range.
class Reading {
public:
  std::uint8_t channel() const { return channel_; }
  vm::Value value() const { return value_; }
  kernel::Time time() const { return time_; }  // kernel time of the sample

private:
  friend class SensorLayer;
  Reading(std::uint8_t channel, vm::Value value, kernel::Time time)
      : time_(time), value_(value), channel_(channel) {}

  kernel::Time time_;
  vm::Value value_;
  std::uint8_t channel_;
};

// All inputs as one step sees them; an unknown one is kUnknown.
class Snapshot {
public:
  // Program time, as the VM counts it.
  std::uint32_t milliseconds() const { return milliseconds_; }
  vm::Value value(std::uint8_t input) const { return values_[input]; }
  const vm::Value* values() const { return values_.data(); }  // by input

private:
  friend class ProcessingLayer;
  Snapshot() = default;

  std::uint32_t milliseconds_ = 0;
  std::span<vm::Value> values_;
};

// What a response wants of actuators. Words are already resolved; each actuator's limits are applied to its own copy.
class Command {
public:
  const drivers::Order& order() const { return order_; }
  vm::Action action() const { return order_.action; }
  std::uint8_t verb() const { return verb_; }  // index in the verb table
  std::uint8_t word() const { return word_; }  // index in the word table, or kNoWord
  // Bit p: the program gave parameter p itself, not its word.
  std::uint8_t given() const { return given_; }
  // No parameter is kUnknown; otherwise the meaning is unclear, and the command is not carried out.
  bool complete() const { return complete_; }

private:
  friend class BehaviorLayer;  // makes them
  friend class ControlLayer;   // limits its copies
  Command() = default;

  drivers::Order order_;
  std::uint8_t verb_ = 0;
  std::uint8_t word_ = vm::kNoWord;
  std::uint8_t given_ = 0;
  bool complete_ = false;
};

}  // namespace robosync::layers
