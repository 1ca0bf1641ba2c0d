// JSON, for the tool: see compiler/source/json.hpp.
#pragma once

#include "compiler/source/json.hpp"

namespace robosync::tool {

using compiler::Json;
using compiler::json_text;
using compiler::read_json;

}  // namespace robosync::tool
