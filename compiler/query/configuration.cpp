// See configuration.hpp. A text that somebody is typing is rarely JSON, so it is scanned, not parsed: strings and brackets are enough
// to know in which object a place is.
#include "compiler/query/configuration.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "compiler/config/boards.hpp"
#include "compiler/config/devices.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/wiring.hpp"

namespace robosync::compiler::query {
namespace {

// What a value is: the object that has its keys, or that its items have: those of a list, or of an object with names for keys.
struct Shape {
  std::optional<Object> itself, items{};
};

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

// An object or a list that is open at a place.
struct Level {
  Shape shape;
  bool is_list = false;
  bool at_key = true;  // of an object: a key comes next, not a value
  std::string_view key{};
  std::set<std::string_view> keys{};
};

Shape shape_in(const Level& level) {
  if (level.is_list || level.shape.items) return {level.shape.items};
  const auto* const part = std::ranges::find_if(kParts, [&](const Part& one) {
    return level.shape.itself == one.parent && level.key == one.key;
  });
  return part == std::end(kParts) ? Shape{} : part->shape;
}

class Scan {
public:
  Scan(std::string_view text, std::size_t place) : text_(text), place_(place) {}

  // To the end of the innermost object or list that contains the place: its keys may come later.
  void run() {
    for (std::size_t at = 0; at < text_.size(); ++at) {
      const char sign = text_[at];
      if (sign != '"' && at >= place_) note(place_, place_);
      if (sign == '"') {
        at = take_string(at);
      } else if (sign == '{' || sign == '[') {
        open(sign == '[');
      } else if (sign == '}' || sign == ']') {
        if (levels_.empty() || levels_.size() == depth_) return;
        levels_.pop_back();
      } else if (!levels_.empty() && (sign == ',' || sign == ':')) {
        levels_.back().at_key = sign == ',';
      }
    }
    note(place_, place_);
  }

  // The level with the place, as it is there, with all its keys; null: there is none.
  [[nodiscard]] const Level* level() const { return depth_ == 0 ? nullptr : &there_; }
  [[nodiscard]] const std::set<std::string_view>& keys() const { return levels_[depth_ - 1].keys; }
  [[nodiscard]] std::size_t begin() const { return begin_; }
  [[nodiscard]] std::size_t end() const { return end_; }

private:
  void open(bool list) {
    const Shape shape = levels_.empty() ? Shape{Object::robot} : shape_in(levels_.back());
    levels_.push_back({.shape = shape, .is_list = list});
  }

  // Returns its last character. A string that is not closed ends with its line.
  std::size_t take_string(std::size_t first) {
    std::size_t last = first + 1;
    while (last < text_.size() && text_[last] != '"' && text_[last] != '\n')
      last += text_[last] == '\\' ? 2 : 1;
    const bool closed = last < text_.size() && text_[last] == '"';
    const std::size_t end = std::min(closed ? last + 1 : last, text_.size());
    if (!found_ && first < place_ && place_ < end + (closed ? 0 : 1)) {
      note(first, end);
    } else if (!levels_.empty() && !levels_.back().is_list && levels_.back().at_key && closed) {
      levels_.back().key = text_.substr(first + 1, last - first - 1);
      levels_.back().keys.insert(levels_.back().key);
    }
    if (first >= place_) note(place_, place_);
    return end - 1;
  }

  void note(std::size_t begin, std::size_t end) {
    if (found_) return;
    found_ = true;
    depth_ = levels_.size();
    if (depth_ != 0) there_ = levels_.back();
    begin_ = begin;
    end_ = end;
  }

  std::string_view text_;
  std::size_t place_, begin_ = 0, end_ = 0, depth_ = 0;
  bool found_ = false;
  std::vector<Level> levels_;
  Level there_;
};

void add(Completion& completion, std::string_view text) {
  completion.candidates.push_back(
      {.text = std::string(text), .kind = {}, .detail = {}, .text_about = {}, .is_text = true});
}

void add_keys(Completion& completion, Object object, const std::set<std::string_view>& present) {
  for (const Key& key : known_keys())
    if (key.object == object && key.use == KeyUse::used && !present.contains(key.name))
      add(completion, key.name);
}

void add_values(Completion& completion, Object object, std::string_view key) {
  const bool sensor = object == Object::sensor;
  if (object == Object::robot && key == "board")
    for (const std::string_view name : board_names())
      add(completion, name);
  if (!sensor && object != Object::actuator) return;
  if (key == "device")
    for (const DeviceText& device : device_texts())
      if (device.is_sensor == sensor) add(completion, device.name);
  if (key == "type")
    for (const WiringType& type : wiring_types())
      if (sensor ? type.for_sensors : type.for_actuators) add(completion, type.name);
}

}  // namespace

Completion complete_configuration(const SourceFile& source, FileId file, std::uint32_t offset) {
  Scan scan(source.text(), offset);
  scan.run();
  Completion completion;
  completion.typed = {file, static_cast<std::uint32_t>(scan.begin()),
                      static_cast<std::uint32_t>(scan.end())};
  const Level* const level = scan.level();
  if (level == nullptr || level->is_list || !level->shape.itself) return completion;
  if (level->at_key)
    add_keys(completion, *level->shape.itself, scan.keys());
  else
    add_values(completion, *level->shape.itself, level->key);
  return completion;
}

}  // namespace robosync::compiler::query
