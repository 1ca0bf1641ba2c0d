// See terminal.hpp.
#include "rsc/screen/terminal.hpp"

#include <algorithm>
#include <array>
#include <clocale>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

#include <langinfo.h>
#define NCURSES_NOMACROS  // its macros clash with move() and erase() of C++
#include <ncurses.h>
#include <termios.h>
#include <unistd.h>

namespace robosync::tool::screen {
namespace {

constexpr std::array kCrashes = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr std::array kEnds = {SIGHUP, SIGQUIT};  // SIGINT and SIGTERM end the watch

volatile std::sig_atomic_t over = 0;
termios before{};  // the terminal's settings before

// Only async-signal-safe calls. The sequences work on all terminals in use: back to the
// ordinary screen, cursor and colours.
void restore_at_once() {
  constexpr std::string_view kBack = "\x1b[?1049l\x1b[?25h\x1b[0m\r\n";
  tcsetattr(STDIN_FILENO, TCSANOW, &before);
  if (write(STDOUT_FILENO, kBack.data(), kBack.size()) < 0) return;
}

void crash(int signal) {
  restore_at_once();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

int attributes_of(Style style) {
  switch (style) {
    case Style::heading:
      return A_BOLD;
    case Style::quiet:
      return A_DIM;
    case Style::good:
      return static_cast<int>(COLOR_PAIR(1));
    case Style::bad:
      return static_cast<int>(static_cast<chtype>(COLOR_PAIR(2)) | A_BOLD);
    case Style::plain:
      break;
  }
  return A_NORMAL;
}

void use_colours() {
  const char* const off = std::getenv("NO_COLOR");
  if (!has_colors() || (off != nullptr && *off != '\0')) return;
  start_color();
  use_default_colors();
  init_pair(1, COLOR_GREEN, -1);
  init_pair(2, COLOR_RED, -1);
}

}  // namespace

struct Terminal::Screen {
  SCREEN* handle = nullptr;
  std::array<struct sigaction, kCrashes.size() + kEnds.size()> actions{};
};

std::unique_ptr<Terminal> Terminal::open() {
  if (isatty(STDIN_FILENO) != 1 || isatty(STDOUT_FILENO) != 1) return nullptr;
  if (tcgetattr(STDIN_FILENO, &before) != 0) return nullptr;
  std::unique_ptr<Terminal> terminal(new Terminal);
  return terminal->screen_->handle == nullptr ? nullptr : std::move(terminal);
}

Terminal::Terminal() : screen_(std::make_unique<Screen>()) {
  std::setlocale(LC_CTYPE, "");
  has_blocks_ = std::strcmp(nl_langinfo(CODESET), "UTF-8") == 0;
  screen_->handle = newterm(nullptr, stdout, stdin);
  if (screen_->handle == nullptr) return;
  over = 0;
  auto* old = screen_->actions.data();
  for (const auto& [signals, handler] :
       {std::pair{std::span<const int>(kCrashes), &crash},
        std::pair{std::span<const int>(kEnds), +[](int) { over = 1; }}})
    for (const int signal : signals) {
      struct sigaction action {};
      action.sa_handler = handler;
      sigaction(signal, &action, old++);
    }
  use_colours();
  cbreak();
  noecho();
  nonl();
  keypad(stdscr, TRUE);
  nodelay(stdscr, TRUE);
  set_escdelay(25);
  curs_set(0);
}

Terminal::~Terminal() {
  if (screen_->handle == nullptr) return;
  endwin();
  delscreen(screen_->handle);
  const auto* old = screen_->actions.data();
  for (const auto signals : {std::span<const int>(kCrashes), std::span<const int>(kEnds)})
    for (const int signal : signals)
      sigaction(signal, old++, nullptr);
}

std::size_t Terminal::rows() const {
  return static_cast<std::size_t>(std::max(getmaxy(stdscr), 1));
}

std::size_t Terminal::columns() const {
  return static_cast<std::size_t>(std::max(getmaxx(stdscr), 1));
}

bool Terminal::is_over() const {
  return over != 0;
}

void Terminal::draw(const std::vector<Line>& lines) {
  erase();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    move(static_cast<int>(i), 0);
    for (const Piece& piece : lines[i]) {
      attrset(attributes_of(piece.style));
      addnstr(piece.text.data(), static_cast<int>(piece.text.size()));
    }
  }
  refresh();
}

int Terminal::key() {
  const int typed = getch();
  if (typed == KEY_RESIZE) return kResized;
  if (typed == KEY_BACKSPACE || typed == 127) return kBackspace;
  if (typed == KEY_ENTER || typed == '\r') return kEnter;
  return typed >= 0 && typed < 128 ? typed : kNone;
}

}  // namespace robosync::tool::screen
