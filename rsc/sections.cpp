// May assume a verified image.
#include "rsc/sections.hpp"

#include <span>

namespace robosync::tool {

std::vector<SectionSize> section_sizes(const vm::Image& image) {
  std::vector<SectionSize> sizes{{vm::Section::header, 1, sizeof(vm::ImageHeader)}};
  const auto add = [&](vm::Section section, const auto& records) {
    if (records.empty()) return;
    const std::size_t padded = (records.size_bytes() + 3) / 4 * 4;
    sizes.push_back({section, records.size(), padded});
  };
  add(vm::Section::sensors, image.sensors);
  add(vm::Section::channels, image.channels);
  add(vm::Section::actuators, image.actuators);
  add(vm::Section::groups, image.groups);
  add(vm::Section::verbs, image.verbs);
  add(vm::Section::words, image.words);
  add(vm::Section::variables, image.variables);
  add(vm::Section::checks, image.checks);
  add(vm::Section::bands, image.bands);
  add(vm::Section::behaviors, image.behaviors);
  add(vm::Section::modifiers, image.modifiers);
  add(vm::Section::adaptations, image.adaptations);
  add(vm::Section::timers, image.timers);
  add(vm::Section::rules, image.rules);
  add(vm::Section::responses, image.responses);
  add(vm::Section::inputs, image.inputs);
  add(vm::Section::constants, image.constants);
  add(vm::Section::code, image.code);
  add(vm::Section::labels, image.labels);
  add(vm::Section::strings, image.strings);
  add(vm::Section::source_lines, image.source_lines);
  return sizes;
}

}  // namespace robosync::tool
