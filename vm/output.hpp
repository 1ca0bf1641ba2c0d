// Reads what a response has put out (interpreter.hpp, respond()).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "vm/image.hpp"

namespace robosync::vm {

enum class OutputKind : std::uint8_t { command, log, alert, halt };

// Nothing is set but what `kind` has, since the board reads these in a hurry.
struct Output {
  OutputKind kind;
  std::uint16_t text;   // log, alert: offset in the strings
  std::uint8_t target;  // command, halt: actuator, or kGroupBit | group; halt also kAllActuators
  std::uint8_t verb;    // index in the verb table
  std::uint8_t word;    // index in the word table, or kNoWord
  std::uint8_t given;   // bit p: params[p] was given; the others are undefined
  // As computed: kUnknown where the program used a reading that is not known.
  std::array<Value, static_cast<std::size_t>(Param::count_)> params;
};

class OutputReader {
public:
  explicit OutputReader(std::span<const Word> words) : words_(words) {}
  // The next one; false when there is none left, or when what follows is not a response's output.
  [[nodiscard]] bool next(Output& output) { return !words_.empty() && read(output); }

private:
  bool read(Output& output);

  std::span<const Word> words_;
};

}  // namespace robosync::vm
