// Decides whether an image may run, in one pass without allocation. The board and rsc use the same
// code.
//
// After verify() has returned ok, no execution of the image can read or write outside its frame,
// constants, timer memory, code and strings, run longer in one step than its declared cost, or
// command an actuator that it did not declare.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "vm/image.hpp"

namespace robosync::vm {

enum class Refusal : std::uint8_t {
  none,
#define REFUSAL(name, text) name,
#include "vm/refusals.def"
#undef REFUSAL
};

[[nodiscard]] std::string_view describe(Refusal refusal);
[[nodiscard]] std::string_view describe(Section section);

// The board's limits; those of the format (image.hpp) always apply too.
struct Limits {
  std::uint32_t image_bytes = 65536;
  std::uint32_t step_cost = 1000000;  // M4 instructions of VM code in one step
  std::uint16_t frame_cells = 4096;   // sum over the behaviours
  std::uint16_t timer_words = 4096;   // words of timer memory
  std::uint16_t samples = 4096;       // sum over the windows of the checks
  std::uint16_t rules = 65535;
  std::uint8_t inputs = 64;  // channels and variables: one bit each in a mask
  std::uint8_t behaviors = kMaxBehaviors;
  std::uint8_t sensors = 255;
  std::uint8_t actuators = kMaxActuators;
  std::uint64_t drivers = ~std::uint64_t{0};  // bit d: driver d is in this firmware
};

struct Verdict {
  Refusal refusal = Refusal::none;
  Section section = Section::header;
  std::uint16_t index = 0;  // record in the section; in code, the word (the "pc")
  [[nodiscard]] bool ok() const { return refusal == Refusal::none; }
};

// `bytes` must be 4-aligned. On success `image` views them; otherwise it is empty.
[[nodiscard]] Verdict verify(std::span<const std::byte> bytes, const Limits& limits, Image& image);

// Worst-case M4 instructions of VM code in one step: every condition, and the costlier response of
// every rule, of which the costliest part between two waits counts. Computed by the same pass as
// verify(), whatever the header declares and the board's limits are. 0 for an image that would be
// refused for any other reason. `image` must be a view that view_image() accepted.
[[nodiscard]] std::uint32_t step_cost(const Image& image);

}  // namespace robosync::vm
