// May assume a verified image. Promises one line a record, names resolved, in the image's order.
#include "rsc/dump/dump.hpp"

#include <fmt/format.h>

#include "rsc/dump/parts.hpp"
#include "rsc/names.hpp"
#include "rsc/program.hpp"
#include "vm/verifier.hpp"

namespace robosync::tool {
namespace {

std::string header_text(const vm::Image& image) {
  const vm::ImageHeader& header = *image.header;
  std::string text = fmt::format("image {:02x}, format {}, opcode set {:04x}, crc32 {:08x}\n",
                                 fmt::join(header.program_hash, ""), header.format_major,
                                 header.opcode_set, header.crc32);
  const auto board = board_of(header);
  const std::string_view robot = image.robot_name();
  text += fmt::format("for {}{}; {} bytes, a step costs up to {} instructions, seed {}\n",
                      board ? board->name : "no board that this rsc knows",
                      robot.empty() ? "" : fmt::format(", the robot \"{}\"", robot),
                      header.total_length, header.step_cost, header.seed);
  for (const SectionSize& size : section_sizes(image)) {
    text += fmt::format("  {:<14}{:>5} x {:>6} bytes\n", vm::describe(size.section), size.records,
                        size.bytes);
  }
  return text;
}

std::string rule_text(const vm::Image& image, const SourceLines& source, std::size_t index) {
  const vm::Rule& rule = image.rules[index];
  std::string text =
      fmt::format("  rule {} (line {}, {})", index, rule.line, word_of(kRuleKinds, rule.kind));
  if (rule.then_response != vm::kNoIndex) text += fmt::format(": response {}", rule.then_response);
  if (rule.else_response != vm::kNoIndex) text += fmt::format(", else {}", rule.else_response);
  if (rule.modifiers != vm::kNoModifiers) text += fmt::format(", modifiers {}", rule.modifiers);
  return text + "\n" + dump_code(image, source, rule.condition_start, rule.condition_length);
}

std::string behavior_title(const vm::Image& image, std::size_t index) {
  const vm::Behavior& behavior = image.behaviors[index];
  if (behavior.priority == vm::kSafetyPriority) return fmt::format("{} safety rules", index);
  const std::string_view name = image.string(behavior.name);
  return fmt::format("{} {}: priority {}", index, name.empty() ? "(rule outside a BEHAVIOR)" : name,
                     behavior.priority);
}

std::string behavior_text(const vm::Image& image, const SourceLines& source, std::size_t index) {
  const vm::Behavior& behavior = image.behaviors[index];
  std::string text =
      fmt::format("\nbehaviour {}, {} cells, actuators: {}\n", behavior_title(image, index),
                  behavior.cells, actuator_names(image, behavior.actuators));
  for (std::size_t cell = 0; cell < behavior.input_count; ++cell) {
    text += fmt::format("  cell {} = {}\n", cell,
                        input_name(image, image.inputs[behavior.first_input + cell]));
  }
  if (behavior.locals > 0) {
    text += fmt::format("  cells {} … {} are locals\n", behavior.input_count,
                        behavior.input_count + behavior.locals - 1);
  }
  for (std::size_t rule = 0; rule < behavior.rule_count; ++rule)
    text += rule_text(image, source, behavior.first_rule + rule);
  return text;
}

}  // namespace

std::string dump_text(const vm::Image& image, const SourceLines& source) {
  std::string text = header_text(image) + dump_wiring(image) + dump_memory(image);
  for (std::size_t i = 0; i < image.behaviors.size(); ++i)
    text += behavior_text(image, source, i);
  for (std::size_t i = 0; i < image.responses.size(); ++i) {
    const vm::Response& response = image.responses[i];
    text += fmt::format("\nresponse {}: {}\n", i, actuator_names(image, response.actuators));
    text += dump_code(image, source, response.start, response.length);
  }
  return text;
}

}  // namespace robosync::tool
