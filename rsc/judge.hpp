// What a board would refuse, said before it does.
#pragma once

#include "compiler/compiler.hpp"
#include "rsc/program.hpp"

namespace robosync::tool {

// Adds the errors of a program that has none for the board that its robot.json names.
void judge(compiler::Result& result, Judged judged);

// Throws Failure (program) when the board cannot keep up with `program`, called `name`.
void judge_time(const Program& program, const std::string& name);

}  // namespace robosync::tool
