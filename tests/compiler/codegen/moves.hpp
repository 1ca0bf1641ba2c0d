// Statements that the tests here put together: one for each actuator, and a wait, in lines 20 to 23.
#pragma once

#include "tests/compiler/build.hpp"

namespace robosync::compiler::testing {

inline const ProgramStatement kLeft = line(20, move(0));
inline const ProgramStatement kRight = line(21, move(1));
inline const ProgramStatement kSound = line(22, move(2));
inline const ProgramStatement kWait = line(23, ProgramWait{number(0.2)});

}  // namespace robosync::compiler::testing
