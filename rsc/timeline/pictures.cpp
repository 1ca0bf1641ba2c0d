// See pictures.hpp.
#include "rsc/timeline/pictures.hpp"

#include "vm/drivers.hpp"

namespace robosync::tool {
namespace {

constexpr Picture kPictures[] = {
#define PICTURE(name, a, b, c, d, e) {a, b, c, d, e},
#include "runtime-m4/drivers/pictures.def"
#undef PICTURE
};

}  // namespace

std::span<const Picture> pictures() {
  return kPictures;
}

bool shows_pictures(const vm::Actuator& actuator) {
  return vm::drives_lights(actuator.driver) || vm::drives_screen(actuator.driver) ||
         vm::drives_panel(actuator.driver);
}

std::optional<std::size_t> picture_of(const EventReader& command) {
  const vm::WordEntry* const word = command.word();
  if (word == nullptr || word->param != vm::Param::item || word->value < 0) return std::nullopt;
  const auto index = static_cast<std::size_t>(word->value / vm::kScale);
  return index < pictures().size() ? std::optional(index) : std::nullopt;
}

}  // namespace robosync::tool
