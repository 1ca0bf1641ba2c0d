// What was compiled, as something that can be asked (query/).
#pragma once

#include "compiler/compiler.hpp"
#include "compiler/query/project.hpp"

namespace robosync::compiler {

// `result` must outlive it.
[[nodiscard]] query::Project project_of(const Result& result);

}  // namespace robosync::compiler
