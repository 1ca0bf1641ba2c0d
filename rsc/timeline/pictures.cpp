// See pictures.hpp.
#include "rsc/timeline/pictures.hpp"

#include <string>

#include "rsc/json.hpp"
#include "vm/drivers.hpp"

namespace robosync::tool {

Json rows_of(drivers::Picture lights) {
  Json rows;
  for (unsigned row = 0; row < vm::kPictureSide; ++row) {
    std::string signs;
    for (unsigned column = 0; column < vm::kPictureSide; ++column, lights >>= 1)
      signs += (lights & 1) != 0 ? '#' : '.';
    rows.push_back(signs);
  }
  return rows;
}

bool shows_pictures(const vm::Actuator& actuator) {
  return vm::drives_lights(actuator.driver) || vm::drives_screen(actuator.driver) ||
         vm::shows_pictures_on_a_panel(actuator.driver);
}

std::optional<drivers::Picture> picture_of(const EventReader& command) {
  std::optional<drivers::Picture> lights;
  if (const vm::WordEntry* const word = command.word();
      word != nullptr && word->param == vm::Param::item)
    lights = drivers::named_picture(word->value);
  command.for_each_param([&](std::size_t param, vm::Value value) {
    if (static_cast<vm::Param>(param) == vm::Param::to) lights = drivers::number_picture(value);
  });
  return lights;
}

}  // namespace robosync::tool
