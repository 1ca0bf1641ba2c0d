// What the files of the verifier share; not for others.
#pragma once

#include "vm/opcode.hpp"
#include "vm/verifier.hpp"

namespace robosync::vm {

// What is verified, and the reason found against it. The parts return false when they found one.
struct Verification {
  const Image& image;
  const Limits& limits;
  Verdict verdict = {};
  std::uint64_t step_cost = 0;   // of the code checked so far
  std::uint32_t words = 0;       // of code looked at, again and again what is shared
  std::uint32_t next_timer = 0;  // timers below are taken by conditions checked before

  // Notes the reason; false, to be returned.
  bool refuse(Refusal refusal, Section section, std::size_t index);
};

// verify_records.cpp: every record of every section but code, each by itself and against those it
// refers to. Assumes that the sections fill the image.
bool check_records(Verification& verification);

// The behaviour's rules that keep a truth in its frame. It has its rules.
std::size_t count_watches(const Image& image, const Behavior& behavior);

constexpr Refusal good_or(Refusal refusal, bool good) {
  return good ? Refusal::none : refusal;
}

// The mask of the lowest `count` bits.
constexpr std::uint32_t low_bits(std::size_t count) {
  return count >= 32 ? 0xFFFFFFFF : (std::uint32_t{1} << count) - 1;
}

}  // namespace robosync::vm
