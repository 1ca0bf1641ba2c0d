// Where on a broker what a robot does is published. Pure functions.
//
//   robosync/NAME/…                  retained
//     online                         {"online":true}; false while the robot, or
//     this bridge, is away board
//     {"name":"mps2-an386","uptime_us":…,"reset_reason":"power",…} program the
//     line `activated` of the trace sensors/SENSOR/CHANNEL         the last
//     reading:            input, stale variables/NAME                 its
//     value:                   set actuators/NAME                 what it was
//     told last:       command, done, cancel, halt, release, overrun
//     behaviors/NAME                 … of its rules:              fire, win,
//     lose, interrupt, finished, wait, go_on priorities/NAME priority
//     safety/line N                                               trip, resume
//     alerts                         the last one:                alert
//   robosync/NAME/log, …/faults      not retained:                log; what
//   went wrong
//
// Each payload is the line of the trace (docs/link.md), so whoever reads one
// can read the other.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace robosync::tool {

struct Topic {
  std::string name;  // behind robosync/NAME/
  bool retain = true;
};

// `event`: a line of a trace.
[[nodiscard]] Topic topic_of(const nlohmann::ordered_json& event);

// A name as a part of a topic: no "/", "+", "#", and nothing that is not
// printable.
[[nodiscard]] std::string topic_part(const std::string& name);

// "feed/SENSOR/CHANNEL" behind the robot's name, and what was published there:
// "SENSOR.CHANNEL=VALUE". Nothing when it is another topic.
[[nodiscard]] std::optional<std::string> reading_of(const std::string& topic,
                                                    const std::string& payload);

}  // namespace robosync::tool
