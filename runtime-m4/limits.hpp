// How large a program this firmware can hold. Everything the runtime keeps is static and sized
// here; what is larger is refused before the running program is touched. The host has the same
// limits, so that `rsc run` refuses what the board would refuse.
#pragma once

#include <cstddef>
#include <cstdint>

namespace robosync::layers {

inline constexpr std::size_t kSlotBytes = 5120;        // largest image
inline constexpr std::uint32_t kStepBudget = 100'000;  // M4 instructions of VM code in one step

inline constexpr unsigned kMaxSensors = 12;
inline constexpr unsigned kMaxChannels = 32;
inline constexpr unsigned kMaxVariables = 32;  // one bit each in a VariableMask
// Channels and variables; one bit each in an InputMask.
inline constexpr unsigned kMaxInputs = kMaxChannels + kMaxVariables;
inline constexpr unsigned kMaxFading = 8;  // of the variables, the ones that fade
inline constexpr unsigned kMaxChecks = 12;
inline constexpr unsigned kMaxSamples = 64;  // of all windows that a median is taken of
inline constexpr unsigned kMaxTimerWords = 96;
inline constexpr unsigned kMaxSafetyOutput = 32;  // words that the body of a SAFETY rule puts out
inline constexpr unsigned kMaxActuators = 10;
inline constexpr unsigned kMaxBehaviors = 11;  // the safety rules count as one
inline constexpr unsigned kMaxRules = 40;      // one bit each in a RuleMask
inline constexpr unsigned kMaxFrameCells = 128;

inline constexpr unsigned kMaxQueued = 8;           // commands that wait for one actuator
inline constexpr unsigned kMaxCommands = 24;        // … and for all of them
inline constexpr unsigned kMaxFeeds = 40;           // readings that wait for their time
inline constexpr unsigned kMaxProgramThreads = 16;  // sensors, behaviours, actuators, the step

// Stacks, in bytes, guard included. High-water marks in QEMU (`rsc info`), plus a fifth, plus what
// an interrupt puts on them. Who traces needs most: an event is built and encoded on the stack.
inline constexpr std::size_t kSensorStack = 512;
inline constexpr std::size_t kStepStack = 736;
inline constexpr std::size_t kBehaviorStack = 352;
inline constexpr std::size_t kControlStack = 544;
inline constexpr std::size_t kSafetyStack = 896;
inline constexpr std::size_t kStackArena = 6208;  // for all threads of a program

}  // namespace robosync::layers
