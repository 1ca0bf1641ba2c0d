// A full-screen terminal, by ncurses. Only terminal.hpp and terminal.cpp use that library.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "rsc/screen/layout.hpp"

namespace robosync::tool::screen {

// Takes over the screen while the object exists. The terminal is restored however the program
// ends: by an exception or by any signal that can be caught.
class Terminal {
public:
  // Null if stdin or stdout is not a terminal, or is of an unknown type.
  [[nodiscard]] static std::unique_ptr<Terminal> open();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  std::size_t rows() const;
  std::size_t columns() const;
  bool has_blocks() const { return has_blocks_; }
  // It was closed, or the program was told to end.
  bool is_over() const;

  void draw(const std::vector<Line>& lines);
  // An ASCII character, kEnter, kBackspace or kEscape; kNone if nothing was typed, kResized
  // if the size changed.
  int key();
  static constexpr int kNone = -1, kResized = -2, kEnter = '\n', kBackspace = 8, kEscape = 27;

private:
  Terminal();

  struct Screen;  // ncurses's own
  std::unique_ptr<Screen> screen_;
  bool has_blocks_ = false;
};

}  // namespace robosync::tool::screen
