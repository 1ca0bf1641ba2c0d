// Reads a response's output back: commands, texts and halts, each with its parameters.
#include "vm/output.hpp"

#include "vm/opcode_traits.hpp"

namespace robosync::vm {
namespace {

// Decodes a word with this effect; false if it is no command, text or halt.
bool decode(Word word, Effect effect, Output& output) {
  switch (effect) {
    case Effect::command:
      output.kind = OutputKind::command;
      output.target = operand_a(word);
      output.verb = operand_b(word);
      output.word = operand_c(word);
      return true;
    case Effect::log:
    case Effect::alert:
      output.kind = effect == Effect::log ? OutputKind::log : OutputKind::alert;
      output.text = operand_wide(word);
      return true;
    case Effect::halt:
      output.kind = OutputKind::halt;
      output.target = operand_a(word);
      return true;
    default:
      return false;
  }
}

}  // namespace

bool OutputReader::read(Output& output) {
  unsigned given = 0;
  while (!words_.empty()) {
    const Word word = words_[0];
    const Effect effect = traits_of(word).effect();
    if (decode(word, effect, output)) {
      words_ = words_.subspan(1);
      output.given = static_cast<std::uint8_t>(given);
      return true;
    }
    const std::uint8_t param = operand_a(word);
    if (effect != Effect::param || words_.size() < 2 || param >= output.params.size()) break;
    output.params[param] = static_cast<Value>(words_[1]);
    given |= 1U << param;
    words_ = words_.subspan(2);
  }
  words_ = {};
  return false;
}

}  // namespace robosync::vm
