// Reads the output of a response (interpreter.hpp, respond()).
#pragma once

#include <cstdint>
#include <span>

#include "vm/image.hpp"
#include "vm/opcode_traits.hpp"

namespace robosync::vm {

enum class OutputKind : std::uint8_t { none, command, log, alert, halt };

// Members that `kind` does not use are 0.
struct Output {
  OutputKind kind = OutputKind::none;
  std::uint16_t text = 0;  // log, alert: offset in the strings
  std::uint8_t target =
      0;                   // command, halt: actuator, or kGroupBit | group; halt also kAllActuators
  std::uint8_t verb = 0;   // index in the verb table
  std::uint8_t word = 0;   // index in the word table, or kNoWord
  std::uint8_t given = 0;  // bit p: the output has parameter p
};

class OutputReader {
public:
  // The values of parameters go to `params`, as computed: kUnknown if the program used an unknown reading. Those that an
  // output does not have stay as they are.
  OutputReader(std::span<const Word> words, Params& params)
      : next_(words.data()), end_(words.data() + words.size()), params_(params) {}
  // Reads the next output; false if none is left, or if the next word is no output of a response.
  [[nodiscard, gnu::always_inline]] bool next(Output& output) {
    std::uint32_t given = 0;
    while (next_ != end_) {
      const Word word = *next_++;
      const Effect effect = traits_of(word).effect();
      if (effect == Effect::param) {
        if (!take_param(operand_a(word))) break;
        given |= std::uint32_t{1} << operand_a(word);
        continue;
      }
      output = effect == Effect::command ? command(word) : other(word, effect);
      output.given = static_cast<std::uint8_t>(given);
      if (output.kind == OutputKind::none) break;
      return true;
    }
    next_ = end_;
    return false;
  }

private:
  static Output command(Word word) {
    return {.kind = OutputKind::command,
            .target = operand_a(word),
            .verb = operand_b(word),
            .word = operand_c(word)};
  }
  // A text or a halt; `none` if the word is no output.
  static Output other(Word word, Effect effect);
  [[gnu::always_inline]] bool take_param(std::uint8_t param) {
    if (next_ == end_ || param >= params_.size()) return false;
    params_[param] = static_cast<Value>(*next_++);
    return true;
  }

  const Word* next_;
  const Word* end_;
  Params& params_;
};

}  // namespace robosync::vm
