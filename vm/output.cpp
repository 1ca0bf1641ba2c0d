// Reads a response's output back: commands, texts, halts, each with the parameters given to it.
#include "vm/output.hpp"

#include "vm/opcode.hpp"

namespace robosync::vm {
namespace {

// What a word puts out; false: it is no such word.
bool decode(Word word, Output& output) {
  const std::uint8_t a = operand_a(word);
  switch (opcode_of(word)) {
    case Opcode::cmd:
    case Opcode::cmd_end:
      output.kind = OutputKind::command;
      output.target = a;
      output.verb = operand_b(word);
      output.word = operand_c(word);
      return true;
    case Opcode::log:
    case Opcode::alert:
      output.kind = opcode_of(word) == Opcode::log ? OutputKind::log : OutputKind::alert;
      output.text = operand_wide(word);
      return true;
    case Opcode::halt:
      output.kind = OutputKind::halt;
      output.target = a;
      return true;
    default:
      return false;
  }
}

}  // namespace

bool OutputReader::next(Output& output) {
  output = {};
  unsigned given = 0;
  while (!words_.empty()) {
    const Word word = words_[0];
    if (decode(word, output)) {
      words_ = words_.subspan(1);
      output.given = static_cast<std::uint8_t>(given);
      return true;
    }
    const std::uint8_t param = operand_a(word);
    const bool is_param = opcode_of(word) == Opcode::arg || opcode_of(word) == Opcode::arg_k;
    if (!is_param || words_.size() < 2 || param >= output.params.size()) break;
    output.params[param] = static_cast<Value>(words_[1]);
    given |= 1U << param;
    words_ = words_.subspan(2);
  }
  words_ = {};
  return false;
}

}  // namespace robosync::vm
