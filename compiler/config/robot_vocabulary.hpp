// The names in a robot.json, for examples in messages.
#pragma once

#include "compiler/config/robot.hpp"
#include "compiler/syntax/vocabulary.hpp"

namespace robosync::compiler {

class RobotVocabulary : public Vocabulary {
public:
  explicit RobotVocabulary(const Robot& robot) : robot_(robot) {}  // must outlive this

  [[nodiscard]] std::vector<std::string_view> reserved_names() const override;
  [[nodiscard]] std::string part(Part part, std::string_view name) const override;
  [[nodiscard]] std::string command(std::string_view verb, std::string_view name,
                                    bool places) const override;

private:
  [[nodiscard]] std::string of_actuator(Part part, std::string_view name) const;

  const Robot& robot_;
};

}  // namespace robosync::compiler
