// The trace: JSON lines with the names that rsc run --format json has, without the numbers of steps
// and rules, which are no matter of the language.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "compiler/config/robot.hpp"
#include "compiler/ir/program.hpp"
#include "tests/oracles/rsl/past.hpp"

namespace robosync::oracle {

// A command as an actuator gets it.
struct Order {
  std::size_t rule = 0;  // place in the list of all rules
  const compiler::ir::Command* command = nullptr;
  std::vector<std::pair<vm::Param, Number>> given;  // what is said in numbers
};

class Trace {
public:
  Trace(std::ostream& out, const compiler::ir::Program& program, const compiler::Robot& robot)
      : out_(out), program_(program), robot_(robot) {}

  void set_time(Millis now) { now_ = now; }

  void channel(const char* event, compiler::ChannelRef channel, std::optional<Number> value);
  void variable(std::size_t variable, Number value);
  // `behavior` null: a SAFETY rule.
  void rule(const char* event, const compiler::ir::Rule& rule,
            const compiler::ir::Behavior* behavior, std::optional<bool> side = std::nullopt,
            const std::string& by = "");
  void actuator(const char* event, std::size_t actuator);
  void command(std::size_t actuator, const Order& order);
  // LOG and ALERT.
  void text(const char* event, const std::string& text, const std::vector<Number>& values);

private:
  std::ostream& out_;
  const compiler::ir::Program& program_;
  const compiler::Robot& robot_;
  Millis now_ = 0;
};

}  // namespace robosync::oracle
