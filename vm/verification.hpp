// Shared by the files of the verifier; not for other code.
#pragma once

#include "vm/opcode.hpp"
#include "vm/verifier.hpp"

namespace robosync::vm {

// The image that is verified, and the reason to refuse it. The parts return false if they find one.
struct Verification {
  // Has a constructor, because an aggregate would be zeroed first.
  Verification(const Image& of, const Limits& most) : image(of), limits(most) {}

  const Image& image;
  const Limits& limits;
  Verdict verdict = {};
  std::uint64_t step_cost = 0;   // of the code checked so far
  std::uint32_t words = 0;       // code words checked; shared code counts each time
  std::uint32_t next_timer = 0;  // lower timers are used by conditions checked before

  // Stores the reason; returns false, for the caller to return.
  bool refuse(Refusal refusal, Section section, std::size_t index);
};

// verify_records.cpp: every record of every section except code, each on its own and against the
// records that it refers to. Assumes that the sections fill the image.
bool check_records(Verification& verification);

// How many of the behaviour's rules keep a truth in its frame. Its rules must be in the image.
std::size_t count_watches(const Image& image, const Behavior& behavior);

constexpr Refusal good_or(Refusal refusal, bool good) {
  return good ? Refusal::none : refusal;
}

// The mask of the lowest `count` bits.
constexpr std::uint32_t low_bits(std::size_t count) {
  return count >= 32 ? 0xFFFFFFFF : (std::uint32_t{1} << count) - 1;
}

}  // namespace robosync::vm
