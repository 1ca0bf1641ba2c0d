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
ProgramStatement line(std::uint16_t line, Node node) {
  return {std::move(node), line, {0, line * 10u, line * 10u + 5u}};
}
ProgramCommand move(std::size_t actuator, std::vector<ProgramArgument> arguments = {});
ProgramCommand move_arms(std::vector<ProgramArgument> arguments = {});

// ---- rules
ProgramRule when(E condition, ProgramBlock then_response);
ProgramRule at_start(ProgramBlock then_response);
// The rules in one behaviour `tested` of priority 50.
Program program_of(std::vector<ProgramRule> rules, std::vector<ProgramVariable> variables = {});
ProgramVariable plain(std::string name, double initial = 0);
ProgramVariable ranged(std::string name, double min, double max);

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
Built build(const Program& program, BuildOptions options = {});
// The same, with everything accepted.
Built must_build(const Program& program, bool source_lines = false);
// Behaviours, rules, timers and instructions of the image.
std::string listing(const vm::Image& image);

}  // namespace robosync::compiler::testing
