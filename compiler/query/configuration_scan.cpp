#include "compiler/query/configuration_scan.hpp"

#include <algorithm>

#include "compiler/config/json_reader.hpp"

namespace robosync::compiler::query {
namespace {

struct Part {
  std::string_view key;
  Object parent;
  Shape shape;
};
constexpr Part kParts[] = {
    {"sensors", Object::robot, {{}, Object::sensor}},
    {"actuators", Object::robot, {{}, Object::actuator}},
    {"behaviors", Object::robot, {{}, Object::behavior}},
    {"algorithms", Object::robot, {{}, Object::algorithm}},
    {"scheduler", Object::robot, {Object::scheduler}},
    {"safety", Object::robot, {Object::safety}},
    {"channels", Object::sensor, {{}, Object::channel}},
    {"sounds", Object::actuator, {{}, Object::sound}},
    {"limits", Object::actuator, {Object::limits}},
    {"trim", Object::actuator, {Object::trim}},
};

Shape shape_in(const Spot& spot) {
  if (spot.is_list || spot.shape.items) return {spot.shape.items};
  const auto* const part = std::ranges::find_if(kParts, [&](const Part& one) {
    return spot.shape.itself == one.parent && spot.key == one.key;
  });
  return part == std::end(kParts) ? Shape{} : part->shape;
}

bool is_piece(const Spot& spot, const Spot& outside, std::size_t depth) {
  const bool has_key = !outside.at_key && outside.key.data() != nullptr;
  if (outside.is_list ? spot.is_list : !has_key) return false;
  return depth <= 2 || spot.shape.itself == Object::channel;
}

}  // namespace

void Scan::run() {
  for (std::size_t at = 0; at < text_.size(); ++at) {
    const char sign = text_[at];
    if (sign != '"' && at >= place_) note(place_, place_);
    if (sign == '"') {
      at = take_string(at);
    } else if (sign == '{' || sign == '[') {
      if (levels_.size() == json::kMaxDepth) break;
      open(at);
    } else if (sign == '}' || sign == ']') {
      if (!close(at)) return;
    } else if (!levels_.empty() && (sign == ',' || sign == ':')) {
      levels_.back().spot.at_key = sign == ',';
    }
  }
  while (place_ > text_.size() && !levels_.empty())
    close_last(text_.size());
  note(place_, place_);
}

void Scan::open(std::size_t at) {
  const Shape shape = levels_.empty() ? Shape{Object::robot} : shape_in(levels_.back().spot);
  levels_.push_back({.spot = {.shape = shape, .is_list = text_[at] == '['}, .begin = at});
}

// A bracket that is missing before this one is taken as written; one that closes nothing is passed over. False: the level with the
// place ends, or all of the text.
bool Scan::close(std::size_t at) {
  const bool is_list = text_[at] == ']';
  std::size_t kept = levels_.size();
  while (kept > 0 && levels_[kept - 1].spot.is_list != is_list)
    --kept;
  if (kept == 0) return !levels_.empty();
  if (kept <= depth_) return false;
  while (levels_.size() >= kept)
    close_last(at + 1);
  return true;
}

void Scan::close_last(std::size_t end) {
  const Level& last = levels_.back();
  const std::size_t depth = levels_.size() - 1;
  if (depth > 0 && is_piece(last.spot, levels_[depth - 1].spot, depth))
    pieces_.push_back({levels_[depth - 1].spot, last.spot, depth, last.begin, end, last.name});
  levels_.pop_back();
}

// Returns its last character. A string that is not closed ends with its line.
std::size_t Scan::take_string(std::size_t first) {
  std::size_t last = first + 1;
  while (last < text_.size() && text_[last] != '"' && text_[last] != '\n')
    last += text_[last] == '\\' ? 2 : 1;
  const bool closed = last < text_.size() && text_[last] == '"';
  const std::size_t end = std::min(closed ? last + 1 : last, text_.size());
  if (!found_ && first < place_ && place_ < end + (closed ? 0 : 1))
    note(first, end);
  else if (closed)
    take_text(text_.substr(first + 1, last - first - 1));
  if (first >= place_) note(place_, place_);
  return end - 1;
}

void Scan::take_text(std::string_view text) {
  if (levels_.empty() || levels_.back().spot.is_list) return;
  Level& level = levels_.back();
  if (level.spot.at_key) {
    level.spot.key = text;
    level.keys.insert(text);
  } else if (level.spot.key == "name") {
    level.name = text;
  }
}

void Scan::note(std::size_t begin, std::size_t end) {
  if (found_) return;
  found_ = true;
  depth_ = levels_.size();
  if (depth_ != 0) spot_ = levels_.back().spot;
  begin_ = begin;
  end_ = end;
}

}  // namespace robosync::compiler::query
