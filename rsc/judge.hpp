// Reports what a board would refuse, before it does.
#pragma once

#include "compiler/compiler.hpp"
#include "rsc/program.hpp"

namespace robosync::tool {

// For a program without errors: adds an error for whatever its board would refuse.
void judge(compiler::Result& result, Judged judged);

// Throws Failure (program) when the board cannot keep up with `program`, called `name`.
void judge_time(const Program& program, const std::string& name);

}  // namespace robosync::tool
