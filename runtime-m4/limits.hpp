// How large a program this firmware can hold. Everything the runtime keeps is static and sized
// here; what is larger is refused before the running program is touched. The host has the same
// limits, so that `rsc run` refuses what the board would refuse.
//
// There are two profiles, chosen when the runtime is compiled: `standard` fits a microcontroller
// with 64 KB of RAM and leaves half of it; `large` (ROBOSYNC_LARGE) holds what the image format can
// express, for boards with megabytes. Nothing else in the runtime knows which one it is.
#pragma once

#include <cstddef>
#include <cstdint>

namespace robosync {

#if defined(ROBOSYNC_LARGE)
inline constexpr bool kLarge = true;
#else
inline constexpr bool kLarge = false;
#endif

template <class Number>
constexpr Number limit(Number standard, Number large) {
  return kLarge ? large : standard;
}

}  // namespace robosync

namespace robosync::kernel {

inline constexpr unsigned kMaxThreads = limit(64U, 128U);  // one bit each in the ready set

}  // namespace robosync::kernel

namespace robosync::layers {

//                                                        standard    large
inline constexpr std::size_t kSlotBytes = limit<std::size_t>(5024, 65536);  // largest image
// M4 instructions of VM code in one step.
inline constexpr std::uint32_t kStepBudget = limit<std::uint32_t>(100'000, 1'000'000);

inline constexpr unsigned kMaxSensors = limit(12U, 32U);
inline constexpr unsigned kMaxChannels = 32;
inline constexpr unsigned kMaxVariables = 32;  // one bit each in a VariableMask
// Channels and variables; one bit each in an InputMask.
inline constexpr unsigned kMaxInputs = kMaxChannels + kMaxVariables;
inline constexpr unsigned kMaxFading = limit(8U, 32U);  // of the variables, the ones that fade
inline constexpr unsigned kMaxChecks = limit(12U, 32U);
inline constexpr unsigned kMaxSamples =
    limit(64U, 240U);  // of all windows that a median is taken of
inline constexpr unsigned kMaxTimerWords = limit(96U, 4096U);
inline constexpr unsigned kMaxSafetyOutput = limit(32U, 64U);  // words a SAFETY rule puts out
inline constexpr unsigned kMaxActuators = limit(10U, 32U);
inline constexpr unsigned kMaxBehaviors = limit(11U, 64U);  // the safety rules count as one
inline constexpr unsigned kMaxRules = limit(40U, 1000U);    // one bit each in a RuleSet
inline constexpr unsigned kMaxFrameCells = limit(128U, 4096U);
// What the behaviours' threads write (layers/workspace.hpp): where it begins, and in what units the
// MPU can close a part of it. The unit is an eighth of the larger power of two that half of it
// fits.
inline constexpr std::size_t kWorkspaceAlignment = limit<std::size_t>(512, 16384);
inline constexpr std::size_t kWorkspaceUnit = limit<std::size_t>(128, 4096);
// Where that begins which they read (runtime.hpp). Where RAM is scarce it begins anywhere.
inline constexpr std::size_t kReadableAlignment = limit<std::size_t>(8, 65536);

inline constexpr unsigned kMaxQueued = 8;                   // commands that wait for one actuator
inline constexpr unsigned kMaxCommands = limit(24U, 128U);  // … and for all of them
inline constexpr unsigned kMaxFeeds = limit(40U, 200U);     // readings that wait for their time
// Sensors, behaviours, actuators, the step.
inline constexpr unsigned kMaxProgramThreads = limit(16U, 120U);

// Stacks, in bytes, guard included. High-water marks in QEMU (`rsc info`), plus a fifth, plus what
// an interrupt puts on them. Who traces needs most: an event is built and encoded on the stack.
inline constexpr std::size_t kSensorStack = 512;
inline constexpr std::size_t kStepStack = limit<std::size_t>(736, 1536);
inline constexpr std::size_t kBehaviorStack = limit<std::size_t>(320, 512);  // no guard
inline constexpr std::size_t kControlStack = 512;
inline constexpr std::size_t kSafetyStack = limit<std::size_t>(896, 1536);
inline constexpr std::size_t kLinkStack =
    limit<std::size_t>(1536, 3072);  // it verifies and loads programs
// For all threads of a program.
inline constexpr std::size_t kStackArena = limit<std::size_t>(5760, 73728);

}  // namespace robosync::layers
