// The pictures of robot.json, which its faces show by their names.
#include "vm/pictures.hpp"

#include <string>

#include <fmt/format.h>

#include "compiler/config/entries.hpp"
#include "compiler/config/fields.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kMostPictures = 32;

// Five rows from the top, each with # for a light that is on. What is wrong; null: nothing.
const json::Value* read_rows(const json::Value& value, std::uint32_t& lights) {
  if (value.items.size() != vm::kPictureSide) return &value;
  std::uint32_t light = 1;
  for (const json::Value& row : value.items) {
    if (row.text.size() != vm::kPictureSide) return &row;
    for (const char sign : row.text) {
      if (sign != '#' && sign != '.') return &row;
      if (sign == '#') lights |= light;
      light <<= 1;
    }
  }
  return nullptr;
}

void add_picture(const std::string& name, vm::Value item, ActuatorConfig& actuator) {
  for (WordConfig& word : actuator.words)
    if (same_name(word.name, name)) {
      word.value = item;
      return;
    }
  actuator.words.push_back({name, vm::Param::item, item, false, {}});
}

}  // namespace

void read_pictures(const json::Value& value, Robot& robot, Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::object, diagnostics)) return;
  report_repeated_keys(value, diagnostics);
  if (value.members.size() > kMostPictures)
    diagnostics.report(Code::E0205, fmt::format("a robot has at most {} pictures", kMostPictures))
        .label(value.members[kMostPictures].key_span);
  for (const json::Member& member : value.members) {
    check_name({member.key, member.key_span}, diagnostics);
    std::uint32_t lights = 0;
    if (const json::Value* const wrong = read_rows(member.value, lights))
      diagnostics.report(Code::E0205, "a picture has five rows from the top, of five lights each")
          .label(wrong->span)
          .helps("write a row like `\"#.#.#\"`: `#` is a light that is on, `.` one that is dark");
    for (ActuatorConfig& actuator : robot.actuators)
      if (actuator.shows_numbers()) add_picture(member.key, vm::item_of_picture(lights), actuator);
  }
}

}  // namespace robosync::compiler
