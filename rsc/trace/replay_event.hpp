// What a replay reads of the events of a recording, and of its own.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "rsc/json.hpp"
#include "vm/value.hpp"

namespace robosync::tool {

inline std::string kind_of(const Json& event) {
  return event["event"].get<std::string>();
}

inline std::uint64_t time_of(const Json& event) {
  return event["t_us"].get<std::uint64_t>();
}

inline std::uint64_t step_of(const Json& event) {
  const auto step = event.find("step");
  return step != event.end() && step->is_number_unsigned() ? step->get<std::uint64_t>() : 0;
}

// A variable begins with a value from before the program: a KEPT one, or one that an upload carried over.
inline bool is_beginning(const Json& event) {
  return event["event"] == "set" && event.value("step", Json(nullptr)) == 0;
}

inline double thousandths_of(const Json& number) {
  return std::round(number.get<double>() * vm::kScale);
}

}  // namespace robosync::tool
