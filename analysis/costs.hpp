// What the runtime around the bytecode costs on the Cortex-M4: the one table that response times
// are worked out with. Executed instructions, the worst seen, with somebody listening to the trace.
//
// tests/timing/test_paths.py measures them again and fails when one is less than what it measures,
// and most of them also when one is much more; those of the kernel it compares with
// bench/recorded.json. What it does not measure says so here.
#pragma once

#include <cstdint>

namespace robosync::analysis::costs {

// --- the kernel ---
inline constexpr std::uint32_t kSwitch = 70;        // between threads without privileges
inline constexpr std::uint32_t kWake = 100;         // signal until the woken thread runs
inline constexpr std::uint32_t kTick = 30;          // nothing due
inline constexpr std::uint32_t kWakeByTimer = 350;  // a tick that wakes a thread, up to its work
inline constexpr std::uint32_t kLongestLock = 620;  // a trace message into its ring (seen once)
inline constexpr std::uint32_t kReceive = 120;      // a byte comes (counted in the listing)
inline constexpr std::uint32_t kSend = 80;          // … or goes (the same)

// --- sampling, a channel each ---
inline constexpr std::uint32_t kReadI2cWord = 12'900;
inline constexpr std::uint32_t kReadMax34451 = 19'000;
inline constexpr std::uint32_t kChannel =
    800;  // another channel of the same reading: trace and all (seen once)

// --- a step ---
inline constexpr std::uint32_t kStep = 2'600;  // a reading of one channel that concerns no rule
inline constexpr std::uint32_t kTimedStep = 1'400;  // one without a reading, from the tick
inline constexpr std::uint32_t kBehavior = 560;     // a behaviour that is released
inline constexpr std::uint32_t kInput = 32;         // … and latches an input (seen once)
inline constexpr std::uint32_t kRule = 440;         // a rule evaluated, without its code
inline constexpr std::uint32_t kClaim = 1'600;      // it fires, and wins or loses
inline constexpr std::uint32_t kRun = 2'000;        // … its response runs to the end
inline constexpr std::uint32_t kGoOn = 3'200;       // a response that waits goes on
inline constexpr std::uint32_t kText = 910;         // LOG or ALERT
inline constexpr std::uint32_t kArgument = 95;      // of a text or a command
inline constexpr std::uint32_t kSet = 125;          // SET, RAISE, SIGNAL …
inline constexpr std::uint32_t kChanged = 800;      // … and what has changed in the step after it
inline constexpr std::uint32_t kCommand = 1'960;    // staged, committed, told, started
inline constexpr std::uint32_t kQueued = 430;  // another one to the same actuator, until its turn
inline constexpr std::uint32_t kStop = 1'300;  // more, when it is done at once
inline constexpr std::uint32_t kInterrupt = 520;  // another response ends by it
inline constexpr std::uint32_t kCancel = 980;     // … and an actuator of its
inline constexpr std::uint32_t kRunning = 420;    // a response that runs or waits meanwhile
inline constexpr std::uint32_t kWanting = 1'000;  // a rule that wants to run and may not
inline constexpr std::uint32_t kCheck = 110;      // a CHECK looked at (seen once)
inline constexpr std::uint32_t kSquare =
    30;  // … SMOOTH: times the square of its samples (supposed)
inline constexpr std::uint32_t kFading = 320;  // a FEELING that fades
inline constexpr std::uint32_t kPoll = 1'200;  // a WAIT UNTIL that looks again, without its code
inline constexpr std::uint32_t kZeroDivide = 600;

// --- beside the steps ---
inline constexpr std::uint32_t kMonitor = 150;     // the safety thread's check
inline constexpr std::uint32_t kGuard = 110;       // it looks at the SAFETY rules
inline constexpr std::uint32_t kSafetyRule = 130;  // … at each, without its code (both only in sum)
inline constexpr std::uint32_t kTrip = 1'750;      // one trips, or lets go
inline constexpr std::uint32_t kHalt = 1'150;      // … an actuator
inline constexpr std::uint32_t kRank = 1'800;  // adapted priorities, at a window's end: a behaviour
inline constexpr std::uint32_t kService = 2'800;  // an actuator gets its next setpoint or command

// --- what is supposed, not measured ---
inline constexpr std::uint32_t kClockHz = 25'000'000;        // of mps2-an386
inline constexpr std::uint32_t kCyclesPer2Instructions = 3;  // of an M4 whose memory does not wait
inline constexpr std::uint32_t kFedPeriodMs = 100;           // of a sensor that is fed
inline constexpr std::uint32_t kTripPeriodMs = 100;          // of a SAFETY rule, without a reading
inline constexpr std::uint32_t kBytesPerSecond = 11'520;     // 115,200 baud, and as many back

inline constexpr std::uint32_t kPerMillisecond = 2 * (kClockHz / 1000) / kCyclesPer2Instructions;

}  // namespace robosync::analysis::costs
