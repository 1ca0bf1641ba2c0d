// What the runtime around the bytecode costs on the Cortex-M4: the one table that response times
// are worked out with. Executed instructions, the worst seen, with somebody listening to the trace.
//
// kStep, kBehavior, kRule, kFire, kText, kCommand and kQueued are measured again by
// tests/timing/test_paths.py, which fails when one is less than what is measured, or much more; the
// others were measured once in the same way; kSwitch, kWake and kTick are those of
// bench/recorded.json.
#pragma once

#include <cstdint>

namespace robosync::tool::costs {

// --- the kernel ---
inline constexpr std::uint32_t kSwitch = 26;
inline constexpr std::uint32_t kWake = 61;          // signal until the woken thread runs
inline constexpr std::uint32_t kTick = 10;          // nothing due
inline constexpr std::uint32_t kWakeByTimer = 300;  // a tick that wakes a thread, up to its work
inline constexpr std::uint32_t kLongestLock = 620;  // a trace message goes into its ring, or out
inline constexpr std::uint32_t kReceive = 120;      // an interrupt of the serial line: a byte comes
inline constexpr std::uint32_t kSend = 80;          // … or goes

// --- sampling, a channel each ---
inline constexpr std::uint32_t kReadI2cWord = 12'900;
inline constexpr std::uint32_t kReadMax34451 = 19'000;
inline constexpr std::uint32_t kChannel =
    800;  // another channel of the same reading: trace and all

// --- a step ---
inline constexpr std::uint32_t kStep = 2'500;  // a reading of one channel that concerns no rule
inline constexpr std::uint32_t kTimedStep = 1'300;  // one without a reading, from the tick
inline constexpr std::uint32_t kBehavior = 520;     // a behaviour that is released
inline constexpr std::uint32_t kInput = 32;         // … and latches an input
inline constexpr std::uint32_t kRule = 440;         // a rule evaluated, without its code
inline constexpr std::uint32_t kClaim = 1'550;      // it fires, and wins or loses
inline constexpr std::uint32_t kRun = 2'000;        // … its response runs to the end
inline constexpr std::uint32_t kGoOn = 3'100;       // a response that waits goes on
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
inline constexpr std::uint32_t kCheck = 110;      // a CHECK looked at
inline constexpr std::uint32_t kSquare = 30;      // … SMOOTH: times the square of its samples
inline constexpr std::uint32_t kFading = 320;     // a FEELING that fades
inline constexpr std::uint32_t kPoll = 1'200;     // a WAIT UNTIL that looks again, without its code
inline constexpr std::uint32_t kZeroDivide = 600;

// --- beside the steps ---
inline constexpr std::uint32_t kMonitor = 150;     // the safety thread's check
inline constexpr std::uint32_t kGuard = 720;       // it looks at the SAFETY rules
inline constexpr std::uint32_t kSafetyRule = 160;  // … at each of them, without its code
inline constexpr std::uint32_t kTrip = 1'600;      // one trips, or lets go
inline constexpr std::uint32_t kHalt = 1'100;      // … an actuator
inline constexpr std::uint32_t kService = 2'500;   // an actuator that moves gets its next setpoint

// --- what is supposed, not measured ---
inline constexpr std::uint32_t kClockHz = 25'000'000;        // of mps2-an386
inline constexpr std::uint32_t kCyclesPer2Instructions = 3;  // of an M4 whose memory does not wait
inline constexpr std::uint32_t kFedPeriodMs = 100;           // of a sensor that is fed
inline constexpr std::uint32_t kTripPeriodMs = 100;          // of a SAFETY rule, without a reading
inline constexpr std::uint32_t kServicePeriodMs = 20;        // the frame of servos and PWM
inline constexpr std::uint32_t kBytesPerSecond = 11'520;     // 115,200 baud, and as many back

inline constexpr std::uint32_t kPerMillisecond = 2 * (kClockHz / 1000) / kCyclesPer2Instructions;

}  // namespace robosync::tool::costs
