// The registers of SysTick. Names as in the ARMv7-M manual.
#pragma once

#include <cstdint>

namespace robosync::port::core {

inline constexpr std::uintptr_t kSystCsr = 0xE000'E010;  // control
inline constexpr std::uintptr_t kSystRvr = 0xE000'E014;  // reload
inline constexpr std::uintptr_t kSystCvr = 0xE000'E018;  // current value

}  // namespace robosync::port::core
