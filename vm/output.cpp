// See output.hpp.
#include "vm/output.hpp"

namespace robosync::vm {

// A text or a halt; `none` if the word is no output.
Output OutputReader::other(Word word, Effect effect) {
  Output output{.kind = OutputKind::none, .text = 0, .target = 0, .verb = 0, .word = 0, .given = 0};
  if (effect == Effect::log || effect == Effect::alert) {
    output.kind = effect == Effect::log ? OutputKind::log : OutputKind::alert;
    output.text = operand_wide(word);
  } else if (effect == Effect::halt) {
    output.kind = OutputKind::halt;
    output.target = operand_a(word);
  }
  return output;
}

}  // namespace robosync::vm
