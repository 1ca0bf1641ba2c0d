// Lays a model out as lines of a terminal: a pure function, so that it can be
// tested without one.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "rsc/screen/model.hpp"

namespace robosync::tool::screen {

enum class Style : std::uint8_t { plain, heading, quiet, good, bad };

struct Piece {
  std::string text;
  Style style = Style::plain;
};
using Line = std::vector<Piece>;

// What the person has chosen.
struct View {
  std::string port;
  std::string filter;  // only what has it in its name or its words; empty: all
  std::string prompt;  // what is being asked for and typed, in place of the
                       // keys; empty: nothing
  bool paused = false;
  bool lost = false;   // the line
  bool blocks = true;  // the terminal has block characters (UTF-8)
};

// Exactly `rows` lines, none wider than `columns`. No character of them
// controls a terminal, whatever a robot says.
[[nodiscard]] std::vector<Line> lay_out(const Model& model, const View& view, std::size_t rows,
                                        std::size_t columns);

// The last `span_us` until `now_us` in `columns` characters, from the least to
// the most that was; a space where it was unknown.
[[nodiscard]] std::string sparkline(const SensorRow& sensor, std::uint64_t now_us,
                                    std::uint64_t span_us, std::size_t columns, bool blocks);

// At most `columns` characters of a text in UTF-8; others than printable ones
// become "?".
[[nodiscard]] std::string fitted(std::string_view text, std::size_t columns);

}  // namespace robosync::tool::screen
