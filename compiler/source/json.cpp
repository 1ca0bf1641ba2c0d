// See json.hpp.
#include "compiler/source/json.hpp"

namespace robosync::compiler {

std::string json_text(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json read_json(const std::string& text) {
  return Json::parse(text, nullptr, false);
}

}  // namespace robosync::compiler
