// What the robot of a program has, for lines that show how something is written. The parser does not know robot.json:
// who reads both gives it this (config/robot_vocabulary.hpp).
#pragma once

#include <string>
#include <string_view>

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

  // Of the sensor, the actuator or the group of this name; without one, of the first that has such a part. Empty when
  // there is none.
  [[nodiscard]] virtual std::string part(Part part, std::string_view name) const = 0;
  // `MOVE left_arm UP SLOWLY`: the same; without a verb, with the first one. `places`: with a place behind TO where the
  // verb takes one, `MOVE left_arm TO 60deg SLOWLY`.
  [[nodiscard]] virtual std::string command(std::string_view verb, std::string_view name,
                                            bool places) const = 0;
};

}  // namespace robosync::compiler
