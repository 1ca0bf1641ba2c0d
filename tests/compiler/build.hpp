// Programs written down as what sema hands over, so that each test says exactly what codegen gets.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "compiler/codegen/emit.hpp"

namespace robosync::compiler::testing {

// Sensors: touch LEVEL (channel 0), eye DISTANCE and eye LIGHT (channels 1, 2), key (3, labels up
// and down). Actuators: left, right, sound; group arms: left and right. Every one MOVEs and PLAYs.
Robot small_robot();

// ---- numbers and conditions
using E = Expression;
E number(double units);  // thousandths are exact
E channel(std::size_t place);
E variable(std::size_t place);
E local(std::size_t place);
E of(Operation operation, std::vector<E> operands);
E time_word(Operation operation, double seconds, std::vector<E> operands, std::size_t count = 0);
E less(E left, E right);
E greater(E left, E right);
E held(E condition, double seconds);

// ---- statements
template <typename Node>
ir::Statement line(std::uint16_t line, Node node) {
  return {std::move(node), line, {0, line * 10u, line * 10u + 5u}};
}
ir::Command move(std::size_t actuator, std::vector<ir::Argument> arguments = {});
ir::Command move_arms(std::vector<ir::Argument> arguments = {});

// ---- rules
ir::Rule when(E condition, ir::Block then_response);
ir::Rule at_start(ir::Block then_response);
// The rules in one behaviour `tested` of priority 50.
ir::Program program_of(std::vector<ir::Rule> rules, std::vector<ir::Variable> variables = {});
ir::Variable plain(std::string name, double initial = 0);
ir::Variable ranged(std::string name, double min, double max);

// ---- images: optimised or not, emitted, verified
struct Built {
  std::vector<std::byte> bytes;  // empty when refused
  Diagnostics diagnostics;
  vm::Image image;  // views bytes
};
struct BuildOptions {
  bool source_lines = false;
  bool optimize = false;
};
Built build(const ir::Program& program, BuildOptions options = {});
// The same, with everything accepted.
Built must_build(const ir::Program& program, bool source_lines = false);
// Behaviours, rules, timers and instructions of the image.
std::string listing(const vm::Image& image);

}  // namespace robosync::compiler::testing
