// Where on a broker what a robot does is published: docs/monitor.md lists the topics. Pure functions.
//
// Each payload is a line of the trace (docs/link.md), so whatever reads one can read the other.
#pragma once

#include <optional>
#include <string>

#include "rsc/json.hpp"

namespace robosync::tool {

struct Topic {
  std::string name;  // after robosync/NAME/
  bool retain = true;
};

// `event`: a line of a trace.
[[nodiscard]] Topic topic_of(const Json& event);

// A name as part of a topic: without "/", "+", "#" and unprintable characters.
[[nodiscard]] std::string topic_part(const std::string& name);

// "SENSOR.CHANNEL=VALUE" from the topic "feed/SENSOR/CHANNEL" after the robot's name, and its payload. Nothing for another
// topic.
[[nodiscard]] std::optional<std::string> reading_of(const std::string& topic,
                                                    const std::string& payload);

}  // namespace robosync::tool
