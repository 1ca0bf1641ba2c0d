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

// What the user has chosen.
struct View {
  std::string port;
  std::string filter;  // show only what contains it in its name or text; empty: all
  std::string prompt;  // the question and what is typed, instead of the
                       // keys; empty: no question
  bool paused = false;
  bool lost = false;   // the line is lost
  bool blocks = true;  // the terminal has block characters (UTF-8)
};

// Exactly `rows` lines, none wider than `columns`, without control characters, whatever a
// robot sends.
[[nodiscard]] std::vector<Line> lay_out(const Model& model, const View& view, std::size_t rows,
                                        std::size_t columns);

// The last `span_us` until `now_us` in `columns` characters, scaled from the lowest to the
// highest value; a space where it was unknown.
[[nodiscard]] std::string sparkline(const SensorRow& sensor, std::uint64_t now_us,
                                    std::uint64_t span_us, std::size_t columns, bool blocks);

// At most `columns` characters of a UTF-8 text; unprintable ones become "?".
[[nodiscard]] std::string fitted(std::string_view text, std::size_t columns);

}  // namespace robosync::tool::screen
