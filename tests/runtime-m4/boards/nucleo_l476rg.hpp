// The header of the Nucleo-L476RG, for the tests of its pins: UM1724, "Arduino connectors on NUCLEO-L476RG". Independent of the
// driver's tables.
#pragma once

#include <map>
#include <vector>

#include "tests/runtime-m4/boards/stm32_timers.hpp"

namespace robosync::tests::wired {

inline constexpr const char* kName = "nucleo-l476rg";
// The chip's pin at each pin of the header; 0 and 1 are not connected.
inline const std::map<std::uint16_t, Stm32Timers::Pin> kHeader{
    {2, {'A', 10}}, {3, {'B', 3}}, {4, {'B', 5}},  {5, {'B', 4}},  {6, {'B', 10}}, {7, {'A', 8}},
    {8, {'A', 9}},  {9, {'C', 7}}, {10, {'B', 6}}, {11, {'A', 7}}, {12, {'A', 6}}, {13, {'A', 5}}};
inline constexpr std::size_t kOutputs = 6;
inline constexpr std::uint16_t kThese[] = {3, 6};  // on one timer
inline constexpr Stm32Timers::Pin kA5{'C', 0};     // at an enable input
inline const std::vector<Stm32Timers::Pin> kAwake{};

}  // namespace robosync::tests::wired
