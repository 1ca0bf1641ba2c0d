// Sensors, actuators and their verbs. One line per record, in the image's order.
#include <bit>
#include <vector>

#include <fmt/format.h>

#include "rsc/dump/parts.hpp"
#include "rsc/names.hpp"
#include "rsc/quantity.hpp"
#include "runtime-m4/algorithms/modules.hpp"
#include "runtime-m4/policy/threads.hpp"
#include "vm/drive.hpp"

namespace robosync::tool {
namespace {

constexpr std::array<std::string_view, static_cast<std::size_t>(vm::Release::count_)> kReleases = {
    "hold", "rest", "coast"};
constexpr std::array<std::string_view, static_cast<std::size_t>(vm::Action::count_)> kActions = {
    "move", "play", "set", "stop", "perform", "follow"};
constexpr std::array<std::string_view, static_cast<std::size_t>(vm::Param::count_)> kParams = {
#define PARAM(name, spelling, doc) #name,
#include "vm/params.def"
#undef PARAM
};

std::string number(vm::Value value) {
  return format_quantity(value, vm::Dimension::number);
}

std::string labels_text(const vm::Image& image, std::size_t first, std::size_t count) {
  std::vector<std::string_view> labels;
  for (std::size_t i = 0; i < count; ++i)
    labels.push_back(image.string(image.labels[first + i]));
  return count == 0 ? "" : fmt::format(", labels {}", fmt::join(labels, " | "));
}

std::string channel_text(const vm::Image& image, std::size_t index) {
  const vm::Channel& channel = image.channels[index];
  const auto shown = [&](vm::Value value) { return format_quantity(value, channel.dimension); };
  return fmt::format(
      "    channel {} {}: input {}, x {}/{} + {}, range {} … {}, change {}, {}{}\n", index,
      image.string(channel.name), channel.input, channel.scale_num, channel.scale_den,
      channel.offset, shown(channel.min), shown(channel.max), shown(channel.change),
      channel.stale_ms == 0 ? "never stale" : fmt::format("stale after {} ms", channel.stale_ms),
      labels_text(image, channel.first_label, channel.label_count));
}

// With its named parameters.
std::string algorithm_text(const vm::Image& image, const vm::Sensor& sensor) {
  const robosync_description* const module = algorithms::find_description(sensor.bus);
  std::string text =
      fmt::format("  {}: {} of channel {} on, every {} ms\n", image.string(sensor.name),
                  module == nullptr ? "a module that rsc does not know" : module->name,
                  sensor.first_input, sensor.period_ms);
  for (std::size_t p = 0; module != nullptr && p < module->module->parameters; ++p)
    if (sensor.address + p < image.constants.size())
      text += fmt::format("    {} {}\n", module->parameters[p].name,
                          number(image.constants[sensor.address + p]));
  return text;
}

std::string place_of(const vm::Sensor& sensor) {
  if (vm::is_analog(sensor.driver)) return fmt::format("analog pin {}", sensor.address);
  if (vm::is_of_board(sensor.driver)) return "the board";
  if (vm::counts_edges(sensor.driver))
    return fmt::format("pin {}", sensor.address) +
           (vm::has_second_input(sensor) ? fmt::format(" and {}", sensor.bus) : "");
  if (vm::is_servo_chip(sensor.driver))
    return fmt::format("bus {} address 0x{:x}, enable pin {}", sensor.bus, sensor.address,
                       sensor.first_input);
  if (vm::is_on_spi(sensor.driver))
    return fmt::format("spi bus {} select pin {}", sensor.bus, sensor.address);
  return vm::is_by_echo(sensor.driver)
             ? fmt::format("trigger {} and echo {}", sensor.bus, sensor.address)
             : fmt::format("bus {} address 0x{:x}", sensor.bus, sensor.address);
}

std::string sensors(const vm::Image& image) {
  std::string text = "\nsensors\n";
  for (const vm::Sensor& sensor : image.sensors) {
    if (policy::is_algorithm(sensor))
      text += algorithm_text(image, sensor);
    else
      text += fmt::format(
          "  {}: {} on {}, {}\n", image.string(sensor.name), driver_name(sensor.driver),
          place_of(sensor),
          sensor.period_ms == 0 ? "when fed" : fmt::format("every {} ms", sensor.period_ms));
    for (std::size_t i = 0; i < sensor.channel_count; ++i)
      text += channel_text(image, sensor.first_channel + i);
  }
  return text;
}

std::string verb_names(const vm::Image& image, std::uint32_t mask) {
  std::vector<std::string_view> verbs;
  for (; mask != 0; mask &= mask - 1) {
    verbs.push_back(
        image.string(image.verbs[static_cast<std::size_t>(std::countr_zero(mask))].name));
  }
  return fmt::format("{}", fmt::join(verbs, " "));
}

std::string encoders_text(const vm::DriveParameters& drive, int difference) {
  if (!vm::has_encoders(drive)) return "";
  return fmt::format(", encoders: sensors {} and {}, virtual wheels differ by {} %",
                     drive.encoders[0] - 1, drive.encoders[1] - 1, difference);
}

std::string drive_text(const vm::DriveParameters& drive) {
  return fmt::format(
      "pins {} and {} (left, {} %), {} and {} (right, {} %), {} with full power, track {}, usually "
      "{}",
      drive.pins[0], drive.pins[1], drive.trim[0], drive.pins[2], drive.pins[3], drive.trim[1],
      number(drive.speed), number(drive.track), number(drive.usual));
}

std::string place_of(const vm::Image& image, const vm::Actuator& actuator) {
  if (vm::drives_wheels(actuator.driver) &&
      actuator.pin + vm::kDriveValues <= image.constants.size())
    return drive_text(vm::drive_of(image.constants.data() + actuator.pin)) +
           encoders_text(vm::drive_of(image.constants.data() + actuator.pin),
                         vm::difference_of(actuator));
  if (vm::drives_channel(actuator.driver))
    return fmt::format("channel {} of sensor {}", actuator.pin, actuator.bus);
  if (vm::drives_screen(actuator.driver)) return fmt::format("sensor {}", actuator.bus);
  if (vm::drives_panel(actuator.driver)) return fmt::format("pin {}", actuator.pin);
  return vm::has_two_pins(actuator.driver)
             ? fmt::format("pins {} and {}", actuator.pin, actuator.bus)
             : fmt::format("bus {} pin {}", actuator.bus, actuator.pin);
}

// A panel has a colour instead of a speed limit.
std::string limit_of(const vm::Actuator& actuator) {
  if (vm::is_strip(actuator.driver))
    return fmt::format("white {:06x}, {} lights", actuator.speed_limit, actuator.bus);
  if (vm::drives_panel(actuator.driver))
    return fmt::format("colour {:06x}, lights {} x {}{}", actuator.speed_limit,
                       (actuator.bus & vm::kPanelIsLarge) != 0 ? "8" : "5",
                       (actuator.bus & vm::kPanelIsLarge) != 0 ? "8" : "5",
                       (actuator.bus & vm::kPanelGoesBack) != 0 ? " in zigzag" : "");
  return "speed limit " +
         (actuator.speed_limit == vm::kValueMax ? "none" : number(actuator.speed_limit));
}

std::string traits_text(const vm::Image& image, std::size_t actuator) {
  std::string text;
  if (const std::uint16_t most = image.acceleration_of(actuator); most != 0)
    text = fmt::format(", acceleration limit {}", most);
  if (vm::is_servo(image.actuators[actuator].driver)) {
    const vm::ServoPulses pulses = vm::pulses_of(image.traits, actuator);
    if (pulses != vm::kServoPulses)
      text += fmt::format(", pulses {} … {} us", pulses.at_min, pulses.at_max);
  }
  return text;
}

std::string actuators(const vm::Image& image) {
  std::string text = "\nactuators\n";
  for (std::size_t i = 0; i < image.actuators.size(); ++i) {
    const vm::Actuator& actuator = image.actuators[i];
    text += fmt::format("  {} {}: {} on {}, range {} … {}, {}, release {}, safe {}; {}\n", i,
                        image.string(actuator.name), driver_name(actuator.driver),
                        place_of(image, actuator), number(actuator.min), number(actuator.max),
                        limit_of(actuator) + traits_text(image, i),
                        word_of(kReleases, actuator.on_release), word_of(kReleases, actuator.safe),
                        verb_names(image, actuator.verbs));
  }
  for (const vm::Group& group : image.groups) {
    text += fmt::format("  group {}: {}\n", image.string(group.name),
                        actuator_names(image, group.members));
  }
  return text;
}

std::string verbs(const vm::Image& image) {
  std::string text = "\nverbs\n";
  for (const vm::Verb& verb : image.verbs) {
    std::vector<std::string_view> params;
    for (std::uint32_t mask = verb.params; mask != 0; mask &= mask - 1)
      params.push_back(kParams.at(static_cast<std::size_t>(std::countr_zero(mask))));
    text += fmt::format("  {}: {} ({})\n", image.string(verb.name), word_of(kActions, verb.action),
                        fmt::join(params, " "));
  }
  if (!image.words.empty()) text += "\nwords\n";
  for (const vm::WordEntry& entry : image.words) {
    text += fmt::format("  {}: {} {}\n", image.string(entry.name), word_of(kParams, entry.param),
                        number(entry.value));
  }
  return text;
}

std::string motions(const vm::Image& image) {
  std::string text = image.motions.empty() ? "" : "\nmotions\n";
  for (const vm::Motion& motion : image.motions) {
    text += fmt::format("  {}: {}\n", image.string(motion.name),
                        format_quantity(motion.length, vm::Dimension::duration));
    for (const vm::Track& track : image.tracks.subspan(motion.first_track, motion.track_count)) {
      std::vector<std::string> keys;
      for (const vm::Key& key : image.keys.subspan(track.first_key, track.key_count))
        keys.push_back(fmt::format("{} at {}", number(key.to),
                                   format_quantity(key.time, vm::Dimension::duration)));
      text += fmt::format("    {}: {}\n", image.string(image.actuators[track.actuator].name),
                          fmt::join(keys, ", "));
    }
  }
  return text;
}

}  // namespace

std::string actuator_names(const vm::Image& image, std::uint32_t mask) {
  std::vector<std::string_view> names;
  for (; mask != 0; mask &= mask - 1) {
    const auto index = static_cast<std::size_t>(std::countr_zero(mask));
    names.push_back(image.string(image.actuators[index].name));
  }
  return fmt::format("{}", fmt::join(names, " "));
}

std::string dump_wiring(const vm::Image& image) {
  return sensors(image) + actuators(image) + verbs(image) + motions(image);
}

}  // namespace robosync::tool
