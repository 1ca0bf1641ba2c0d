// The header of the B-L475E-IOT01A, for the tests of its pins: UM2153, table 4. Independent of the driver's tables.
#pragma once

#include <map>
#include <vector>

#include "tests/runtime-m4/boards/stm32_timers.hpp"

namespace robosync::tests::wired {

inline constexpr const char* kName = "b-l475e-iot01a";
// The chip's pin at each pin of the header.
inline const std::map<std::uint16_t, Stm32Timers::Pin> kHeader{
    {0, {'A', 1}},  {1, {'A', 0}},  {2, {'D', 14}}, {3, {'B', 0}}, {4, {'A', 3}},
    {5, {'B', 4}},  {6, {'B', 1}},  {7, {'A', 4}},  {8, {'B', 2}}, {9, {'A', 15}},
    {10, {'A', 2}}, {11, {'A', 7}}, {12, {'A', 6}}, {13, {'A', 5}}};
inline constexpr std::size_t kOutputs = 9;
inline constexpr std::uint16_t kThese[] = {3, 11};            // on one timer
inline constexpr Stm32Timers::Pin kA5{'C', 0};                // at an enable input
inline const std::vector<Stm32Timers::Pin> kAwake{{'C', 6}};  // the distance sensor's XSHUT

}  // namespace robosync::tests::wired
