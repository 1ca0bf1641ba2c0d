// See breaks.hpp.
#include "compiler/syntax/breaks.hpp"

#include "compiler/syntax/blocks.hpp"

namespace robosync::compiler {
namespace {

struct Frame {
  std::uint32_t opener = 0;
  std::uint32_t first = 0;  // the word behind the last DO, ELSE or OPTION; 0: none so far
  bool is_plain = true;     // all in it until now may stand on one line
};

class Marker {
public:
  explicit Marker(const Tokens& tokens) : tokens_(tokens), places_(tokens.size()), walk_(tokens) {}

  std::vector<Place> places() {
    for (std::uint32_t at = 0; at < tokens_.size(); ++at)
      step(at);
    return std::move(places_);
  }

private:
  void step(std::uint32_t at) {
    const std::size_t open = walk_.open().size();
    walk_.step(at);
    if (walk_.open().size() > open) {
      if (!frames_.empty()) frames_.back().is_plain = false;
      places_[at].begins_line = true;
      frames_.push_back({.opener = at});
    } else if (walk_.open().size() < open) {
      end(at);
    } else if (!frames_.empty()) {
      inside(at, frames_.back());
    }
  }

  void end(std::uint32_t at) {
    const Frame& frame = frames_.back();
    places_[at] = {.begins_line = true, .partner = frame.opener};
    if (frame.is_plain && frame.first != 0) places_[frame.opener].partner = at;
    frames_.pop_back();
  }

  void inside(std::uint32_t at, Frame& frame) {
    const TokenKind opener = tokens_[frame.opener].kind;
    switch (tokens_[at].kind) {
      case Kinds::NEWLINE:
        line_ends(at, frame);
        break;
      case Kinds::DO:
        divides(at, frame, at + 1, frame.is_plain && frame.first == 0);
        break;
      case Kinds::ELSE:
        divides(at, frame, at + 1, false);
        places_[frame.first].begins_line = true;
        break;
      case Kinds::OPTION:
        divides(at, frame, at + 1, false);
        break;
      case Kinds::QUANTITY:
        if (tokens_[at - 1].kind == Kinds::OPTION) frame.first = at + 1;
        break;
      case Kinds::ELSE_IF:
      case Kinds::RESUME:
        divides(at, frame, 0, false);
        break;
      case Kinds::WHEN:
        if (opener == Kinds::SAFETY && frame.is_plain) places_[at].begins_line = true;
        break;
      case Kinds::MARGIN:
      case Kinds::SMOOTH:
        // Of a CHECK, behind its bands; in its first line they may stay.
        if (opener == Kinds::CHECK && !frame.is_plain) places_[at].begins_line = true;
        break;
      default:
        break;
    }
  }

  void divides(std::uint32_t at, Frame& frame, std::uint32_t first, bool is_plain) {
    places_[at].begins_line = true;
    frame.first = first;
    frame.is_plain = is_plain;
  }

  // Another statement follows, except behind OPTION and the name of a SAFETY.
  void line_ends(std::uint32_t at, Frame& frame) {
    if (at == frame.first) {
      ++frame.first;
    } else if (frame.first != 0 || tokens_[frame.opener].kind == Kinds::CHECK) {
      places_[frame.first].begins_line = true;
      frame.is_plain = false;
    }
  }

  const Tokens& tokens_;
  std::vector<Place> places_;
  BlockWalk walk_;
  std::vector<Frame> frames_;
};

}  // namespace

std::vector<Place> places_of(const Tokens& tokens) {
  return Marker(tokens).places();
}

}  // namespace robosync::compiler
