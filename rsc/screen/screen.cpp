// See screen.hpp.
#include "rsc/screen/screen.hpp"

#include <iostream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "rsc/device/keeping.hpp"
#include "rsc/failure.hpp"
#include "rsc/trace/channels.hpp"

namespace robosync::tool::screen {
namespace {

constexpr std::chrono::milliseconds kBetweenDrawings{100};

}  // namespace

Screen::Screen(std::unique_ptr<Terminal> terminal, const std::string& port)
    : terminal_(std::move(terminal)), stderr_before_(std::cerr.rdbuf(errors_.rdbuf())) {
  view_.port = port;
  view_.blocks = terminal_->has_blocks();
}

Screen::~Screen() {
  std::cerr.rdbuf(stderr_before_);
}

void Screen::board(const link::HelloReply& board, const Past& past,
                   const std::vector<OnBus>& silent) {
  model_.board(board, past, silent);
}

void Screen::program(const TraceNames& names, std::span<const std::byte> image) {
  image_ = names.image;
  model_.program(names, image);
}

void Screen::current(const Current& current, const TraceNames& names) {
  model_.current(current, names);
}

void Screen::event(const link::Event& event, const TraceNames& names) {
  model_.event(event, names);
}

void Screen::log(const std::string& text) {
  model_.say(text);
}

void Screen::fault(const link::Fault& fault) {
  model_.say(fault_text(fault));
}

void Screen::threads(ThreadList now, ThreadList before) {
  model_.threads(now, before);
}

void Screen::status(const link::Status& status) {
  model_.status(status);
}

void Screen::missed(const std::string& why) {
  model_.say(why);
}

bool Screen::work(Session* session) {
  view_.lost = session == nullptr;
  say_errors();
  for (int key = terminal_->key(); key != Terminal::kNone; key = terminal_->key()) {
    if (!take(key, session)) return false;
    next_draw_ = {};
  }
  const auto now = std::chrono::steady_clock::now();
  if (now >= next_draw_ && (!view_.paused || next_draw_.time_since_epoch().count() == 0)) {
    draw();
    next_draw_ = now + kBetweenDrawings;
  }
  return !terminal_->is_over();
}

void Screen::say_errors() {
  std::istringstream lines(errors_.str());
  errors_.str({});
  for (std::string line; std::getline(lines, line);)
    model_.say(line);
}

bool Screen::take(int key, Session* session) {
  if (key == Terminal::kResized) return true;
  if (asks_ == Asks::nothing) return take_command(key, session);
  take_text(key, session);
  return true;
}

bool Screen::take_command(int key, Session* session) {
  switch (key) {
    case 'q':
      return false;
    case ' ':
      view_.paused = !view_.paused;
      break;
    case '/':
      asks_ = Asks::filter;
      break;
    case 'f':
      asks_ = Asks::reading;
      break;
    case 's':
      act(session, "stopped: all outputs are in their safe state", [this](Client& client) {
        client.stop();
        model_.stopped(true);
      });
      break;
    case 'r':
      act(session, "resumed", [this](Client& client) {
        client.resume();
        model_.stopped(false);
      });
      break;
    case 'b':
      act(session, "the previous program runs again", [](Client& client) {
        roll_back(client);
        client.set_trace(true);  // the hello of roll_back() has switched it off
      });
      break;
    default:
      break;
  }
  if (asks_ != Asks::nothing) take_text(Terminal::kNone, session);
  return true;
}

void Screen::take_text(int key, Session* session) {
  if (key == Terminal::kBackspace) {
    if (!typed_.empty()) typed_.pop_back();
  } else if (key == Terminal::kEnter) {
    if (asks_ == Asks::filter) view_.filter = typed_;
    if (asks_ == Asks::reading && !typed_.empty()) force(typed_, session);
  } else if (key >= ' ') {
    typed_ += static_cast<char>(key);
  }
  if (key == Terminal::kEnter || key == Terminal::kEscape) {
    asks_ = Asks::nothing;
    typed_.clear();
    view_.prompt.clear();
    return;
  }
  view_.prompt =
      (asks_ == Asks::filter ? "show only lines with: " : "reading, such as touch.LEVEL=2: ") +
      typed_;
}

void Screen::force(const std::string& reading, Session* session) {
  const std::size_t equals = reading.find('=');
  try {
    if (equals == std::string::npos) throw std::invalid_argument("write SENSOR.CHANNEL=VALUE");
    if (image_ == nullptr) throw std::invalid_argument("no program runs");
    const std::uint8_t channel = find_channel(*image_, reading.substr(0, equals));
    const vm::Value value = parse_reading(*image_, channel, reading.substr(equals + 1));
    act(session, reading, [&](Client& client) {
      const link::FeedResult result = client.feed({.channel = channel, .at_us = 0, .value = value});
      if (result.error == link::FeedError::not_virtual)
        throw Failure(Exit::program, "the board measures it; only virtual sensors can be forced");
      if (result.error != link::FeedError::none)
        throw Failure(Exit::program, "the board refused the reading");
    });
  } catch (const std::invalid_argument& error) {
    model_.say(fmt::format("{}: {}", reading, error.what()));
  }
}

// A refusal by the board is shown. A board that does not answer is left to the watch.
void Screen::act(Session* session, const std::string& done,
                 const std::function<void(Client&)>& what) {
  if (session == nullptr) {
    model_.say("not now: the line is lost");
    return;
  }
  try {
    what(session->client);
    model_.say(done);
  } catch (const Failure& failure) {
    model_.say(failure.what());
  }
}

void Screen::draw() {
  terminal_->draw(lay_out(model_, view_, terminal_->rows(), terminal_->columns()));
}

}  // namespace robosync::tool::screen
