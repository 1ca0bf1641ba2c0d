// A terminal that is drawn on as a whole, by ncurses. The only files that know
// that library.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "rsc/screen/layout.hpp"

namespace robosync::tool::screen {

// While it lives the screen is its own. Whatever ends the program, the terminal
// is as it was before: an exception, and the signals that a program can see.
class Terminal {
public:
  // Null when stdin or stdout is no terminal, or one that nobody knows.
  [[nodiscard]] static std::unique_ptr<Terminal> open();
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  std::size_t rows() const;
  std::size_t columns() const;
  bool has_blocks() const { return has_blocks_; }
  // Someone has closed it, or wants the program to end.
  bool is_over() const;

  void draw(const std::vector<Line>& lines);
  // A character of ASCII, kEnter, kBackspace, kEscape; kNone when nothing was
  // typed, kResized when the size is another one.
  int key();
  static constexpr int kNone = -1, kResized = -2, kEnter = '\n', kBackspace = 8, kEscape = 27;

private:
  Terminal();

  struct Screen;  // of ncurses
  std::unique_ptr<Screen> screen_;
  bool has_blocks_ = false;
};

}  // namespace robosync::tool::screen
