// Reads the output of a response (interpreter.hpp, respond()).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "vm/image.hpp"

namespace robosync::vm {

enum class OutputKind : std::uint8_t { command, log, alert, halt };

// Only the members that `kind` uses are set, because this is time-critical on the board.
struct Output {
  OutputKind kind;
  std::uint16_t text;   // log, alert: offset in the strings
  std::uint8_t target;  // command, halt: actuator, or kGroupBit | group; halt also kAllActuators
  std::uint8_t verb;    // index in the verb table
  std::uint8_t word;    // index in the word table, or kNoWord
  std::uint8_t given;   // bit p: params[p] was given; the others are undefined
  // As computed: kUnknown if the program used an unknown reading.
  std::array<Value, static_cast<std::size_t>(Param::count_)> params;
};

class OutputReader {
public:
  explicit OutputReader(std::span<const Word> words) : words_(words) {}
  // Reads the next output; false if none is left, or if the next word is no output of a response.
  [[nodiscard]] bool next(Output& output) { return !words_.empty() && read(output); }

private:
  bool read(Output& output);

  std::span<const Word> words_;
};

}  // namespace robosync::vm
