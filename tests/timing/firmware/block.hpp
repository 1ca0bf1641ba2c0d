// The block of programs that tests/timing/pack.cpp writes and QEMU's loader puts into the board's
// memory: words, little-endian.
//
//   the number of random steps to run each program for; then for each program
//     bytes of its image; the image; words of its script; the script; at the end 0
//
// A script is steps that the program really made: the time in milliseconds; the number of changed
// inputs, and number and value of each; the number of responses that ran, and of each its rule and
// Run << 16.
#pragma once

#include <cstdint>

namespace robosync::timing {

inline constexpr std::uintptr_t kBlockAddress = 0x21000000;
inline constexpr unsigned kRunShift = 16;

enum class Run : std::uint8_t { otherwise, then, on };

}  // namespace robosync::timing
