// What stands where in a robot.json. A text that somebody is typing is rarely JSON, so it is scanned, not parsed: strings and
// brackets are enough to know in which object a place is.
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "compiler/config/fields.hpp"

namespace robosync::compiler::query {

// What a value is: the object that has its keys, or that its items have: those of a list, or of an object with names for keys.
struct Shape {
  std::optional<Object> itself, items{};
};

// A place in an object or a list.
struct Spot {
  Shape shape;  // of that; of nothing: it is none that rsc knows
  bool is_list = false;
  bool at_key = true;      // of an object: a key comes next, not a value
  std::string_view key{};  // the last one before the place, as it is written
};

// An object or a list that is open.
struct Level {
  Spot spot;
  std::size_t begin = 0;    // of its text
  std::string_view name{};  // the value of "name"
  std::set<std::string_view> keys{};
};

// An object or a list that describes a part of the robot: a section, an item of one, or a channel.
struct Piece {
  Spot outside, spot;
  std::size_t depth = 0;  // how many others it is in
  std::size_t begin = 0, end = 0;
  std::string_view name{};  // the value of "name"
};

class Scan {
public:
  // `place`: npos for pieces() of the whole text.
  Scan(std::string_view text, std::size_t place) : text_(text), place_(place) {}

  // To the end of the innermost object or list that contains the place: its keys may come later.
  void run();

  [[nodiscard]] const Spot& spot() const { return spot_; }
  // All keys of the object with the place, which must be in one.
  [[nodiscard]] const std::set<std::string_view>& keys() const { return levels_[depth_ - 1].keys; }
  // The string at the place, with its quotes; empty, at the place: there is none.
  [[nodiscard]] std::size_t begin() const { return begin_; }
  [[nodiscard]] std::size_t end() const { return end_; }
  // Each behind those in it.
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }

private:
  void open(std::size_t at);
  [[nodiscard]] bool close(std::size_t at);
  void close_last(std::size_t end);
  [[nodiscard]] std::size_t take_string(std::size_t first);
  void take_text(std::string_view text);
  void note(std::size_t begin, std::size_t end);

  std::string_view text_;
  std::size_t place_, begin_ = 0, end_ = 0, depth_ = 0;
  bool found_ = false;
  std::vector<Level> levels_;
  std::vector<Piece> pieces_;
  Spot spot_;
};

}  // namespace robosync::compiler::query
