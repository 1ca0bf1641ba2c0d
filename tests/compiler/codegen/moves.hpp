// Statements that the tests here put together: one for each actuator, and a wait, in lines 20 to 23.
#pragma once

#include "tests/compiler/build.hpp"

namespace robosync::compiler::testing {

inline const ir::Statement kLeft = line(20, move(0));
inline const ir::Statement kRight = line(21, move(1));
inline const ir::Statement kSound = line(22, move(2));
inline const ir::Statement kWait = line(23, ir::Wait{number(0.2)});

}  // namespace robosync::compiler::testing
