// A compiled program in the form that query/ works on.
#pragma once

#include "compiler/compiler.hpp"
#include "compiler/query/project.hpp"

namespace robosync::compiler {

// `result` must outlive it.
[[nodiscard]] query::Project project_of(const Result& result);

}  // namespace robosync::compiler
