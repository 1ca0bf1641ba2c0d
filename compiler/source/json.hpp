// JSON as RoboSync reads and writes it: the members of an object keep their order.
//
// The library's reader and writer are templates. They take longer to compile than most of the sources that use them, so json.cpp
// compiles them for all.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace robosync::compiler {

using Json = nlohmann::ordered_json;

// Without an indent (in spaces a level): one line, which does not end in a newline. A byte that is not UTF-8 becomes U+FFFD.
[[nodiscard]] std::string json_text(const Json& value, int indent = -1);

// If the text is not JSON, the result's is_discarded() is true.
[[nodiscard]] Json read_json(const std::string& text);

}  // namespace robosync::compiler
