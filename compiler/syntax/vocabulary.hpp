// The parts of a program's robot, for example lines in messages. The parser does not know robot.json: the code that
// reads both passes it this (config/robot_vocabulary.hpp).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace robosync::compiler {

class Vocabulary {
public:
  enum class Part {
    condition,    // touch LEVEL > 5
    reading,      // touch LEVEL = 5
    channel,      // touch LEVEL
    threshold,    // 5, of that channel
    actuator,     // left_arm
    speed_limit,  // left_arm SPEED TO 30deg/s
    followed,     // head TO (voice DIRECTION)
  };

  Vocabulary() = default;
  Vocabulary(const Vocabulary&) = delete;
  Vocabulary& operator=(const Vocabulary&) = delete;
  virtual ~Vocabulary() = default;

  // The names that are words of RSL: mistakes of robot.json.
  [[nodiscard]] virtual std::vector<std::string_view> reserved_names() const = 0;
  // The part of the sensor, actuator or group of this name; without a name, of the first that has such a part. Empty
  // when there is none.
  [[nodiscard]] virtual std::string part(Part part, std::string_view name) const = 0;
  // A command such as `MOVE left_arm UP SLOWLY`, for `name` as above; without a verb, with the first one. With `places`,
  // it has a position after TO if the verb takes one: `MOVE left_arm TO 60deg SLOWLY`.
  [[nodiscard]] virtual std::string command(std::string_view verb, std::string_view name,
                                            bool places) const = 0;
};

// Is it a sensor, an actuator or a group? `robot` may be null: then nothing is.
[[nodiscard]] inline bool knows(const Vocabulary* robot, std::string_view name) {
  return robot != nullptr && (!robot->part(Vocabulary::Part::condition, name).empty() ||
                              !robot->part(Vocabulary::Part::actuator, name).empty());
}

}  // namespace robosync::compiler
