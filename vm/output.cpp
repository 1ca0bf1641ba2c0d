// See output.hpp.
#include "vm/output.hpp"

namespace robosync::vm {

Output OutputReader::other(Word word, Effect effect) {
  switch (effect) {
    case Effect::log:
      return {.kind = OutputKind::log, .text = operand_wide(word)};
    case Effect::alert:
      return {.kind = OutputKind::alert, .text = operand_wide(word)};
    case Effect::halt:
      return {.kind = OutputKind::halt, .target = operand_a(word)};
    default:
      return {};
  }
}

}  // namespace robosync::vm
