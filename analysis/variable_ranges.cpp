// See variable_ranges.hpp. Variables may depend on each other, and on themselves: all responses are
// examined repeatedly until no range grows any more. A range that still grows after kRounds may be anything.
#include "analysis/variable_ranges.hpp"

#include <algorithm>

#include "vm/opcode.hpp"

namespace robosync::analysis {
namespace {

using vm::VariableKind;

constexpr unsigned kRounds = 4;  // afterwards, what grows may be anything

// Set by nothing but SET, RAISE and LOWER, and always known.
bool is_set_only(const vm::Variable& variable) {
  return variable.kind == VariableKind::plain || variable.kind == VariableKind::state ||
         variable.kind == VariableKind::feeling;
}

class Finder {
public:
  explicit Finder(const vm::Image& image) : image_(image) {
    std::size_t input = image.channels.size();
    for (const vm::Variable& variable : image.variables) {
      Interval& range = ranges_[input++];
      if (!is_set_only(variable)) continue;
      range = {variable.initial, variable.initial};
      if (variable.fade != 0) range = hull(range, {variable.fades_to, variable.fades_to});
    }
  }

  const Ranges& find() {
    for (unsigned round = 0; grows(round >= kRounds); ++round) {
    }
    return ranges_;
  }

private:
  // Did any range grow? With `whole`, each one grows to all that it can be, so that it never grows again.
  bool grows(bool whole) {
    bool grown = false;
    for (const vm::Behavior& behavior : image_.behaviors)
      for (const vm::Rule& rule : image_.rules.subspan(behavior.first_rule, behavior.rule_count))
        for (const std::uint16_t response : {rule.then_response, rule.else_response})
          if (response != vm::kNoIndex)
            grown = look_at(behavior, image_.responses[response], whole) || grown;
    return grown;
  }

  bool look_at(const vm::Behavior& behavior, const vm::Response& response, bool whole) {
    bool grown = false;
    Walk walk(image_, behavior, image_.code.subspan(response.start, response.length), ranges_);
    while (walk.next()) {
      const vm::Word word = walk.word();
      walk.run();
      const std::uint8_t cell = vm::operand_a(word);
      if (!writes(word) || cell >= behavior.input_count) continue;
      // RAISE adds to what others have made of it meanwhile.
      const bool adds = vm::opcode_of(word) == vm::Opcode::shift;
      const std::size_t input = image_.inputs[behavior.first_input + cell];
      grown = grow(input, known(walk.cells()[cell]), whole || adds) || grown;
    }
    return grown;
  }

  bool grow(std::size_t input, Interval value, bool whole) {
    if (input < image_.channels.size()) return false;
    const vm::Variable& variable = image_.variables[input - image_.channels.size()];
    value = {std::clamp(value.low, variable.min, variable.max),
             std::clamp(value.high, variable.min, variable.max)};
    const Interval before = ranges_[input];
    Interval& range = ranges_[input];
    range = hull(range, value);
    if (whole && range != before) range = hull(range, {variable.min, variable.max});
    return range != before;
  }

  const vm::Image& image_;
  Ranges ranges_;
};

}  // namespace

Ranges ranges_of_inputs(const vm::Image& image) {
  return Finder(image).find();
}

}  // namespace robosync::analysis
