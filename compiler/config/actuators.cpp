// Reads one entry of "actuators".
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/config/entries.hpp"
#include "compiler/config/values.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {
namespace {

constexpr vm::Value kDefaultSoundLength = 1 * vm::kScale;  // the player's own default, in seconds

void read_position_range(const json::Value& value, ActuatorConfig& actuator,
                         Diagnostics& diagnostics) {
  actuator.range_span = value.span;
  if (actuator.to_unit == nullptr || actuator.shows_numbers()) {
    diagnostics.report(Code::E0205, "this device has no position, so it cannot have a range")
        .label(value.span);
    return;
  }
  const auto range = read_range(value, *actuator.to_unit, diagnostics);
  if (!range) return;
  if (range->low < actuator.lowest || range->high > actuator.highest) {
    diagnostics
        .report(Code::E0205, "this range is larger than the device's own range, " +
                                 format_value(actuator.lowest, *actuator.to_unit) + " to " +
                                 format_value(actuator.highest, *actuator.to_unit))
        .label(value.span);
    return;
  }
  actuator.min = range->low;
  actuator.max = range->high;
}

std::string span_text(const vm::ServoPulses& pulses) {
  return fmt::format("{}ms to {}ms", pulses.at_min / 1000.0, pulses.at_max / 1000.0);
}

// ["0.6ms", "2.4ms"]: at the lower and at the upper end of the range.
void read_pulses(const json::Value& value, const Board& board, ActuatorConfig& actuator,
                 Diagnostics& diagnostics) {
  const auto read = read_microseconds(value, diagnostics);
  if (!read) return;
  const bool on_pin = vm::drives_pin(actuator.driver);
  const auto [least, most] = on_pin ? board.servo_pulses(actuator.pin) : vm::kServoPulses;
  actuator.pulses = {(*read)[0], (*read)[1]};
  for (std::size_t i = 0; i < read->size(); ++i) {
    const std::uint16_t pulse = (*read)[i];
    const std::uint16_t nearest = std::clamp(pulse, least, most);
    if (pulse == nearest) continue;
    diagnostics
        .report(Code::E0205,
                fmt::format("this pulse is {}ms, but a servo {}gets {}", pulse / 1000.0,
                            on_pin ? "at this pin " : "", span_text({least, most})))
        .label(value.items[i].span)
        .fix(value.items[i].span, fmt::format("\"{}us\"", nearest), Applicability::likely);
  }
  if (actuator.pulses.at_min == actuator.pulses.at_max)
    diagnostics.report(Code::E0205, "the two pulses are equal: the servo would not move")
        .label(value.span);
}

// The board shortens and lengthens pulses to what the pin may give.
void check_usual_pulses(const Fields& fields, const Board& board, const ActuatorConfig& actuator,
                        Diagnostics& diagnostics) {
  const auto* pin = fields.find("pin");
  const vm::ServoPulses given = board.servo_pulses(actuator.pin);
  if (pin == nullptr || !vm::drives_pin(actuator.driver) || given == vm::kServoPulses) return;
  diagnostics
      .report(Code::W0223,
              fmt::format("without `pulse` this servo gets {}, but this pin gives only {}: "
                          "it does not reach the ends of its range",
                          span_text(vm::kServoPulses), span_text(given)))
      .label(pin->span)
      .helps(fmt::format("write `\"pulse\": [\"{}us\", \"{}us\"]`, and as `range` how far it turns "
                         "between these",
                         given.at_min, given.at_max));
}

// Each word replaces an earlier one of the same name.
void put_words(std::vector<WordConfig> words, ActuatorConfig& actuator) {
  NameIndex last;
  for (std::size_t i = words.size(); i > 0; --i)
    last.add(words[i - 1].name, i - 1);
  std::erase_if(actuator.words,
                [&](const WordConfig& word) { return last.find(word.name).has_value(); });
  for (std::size_t i = 0; i < words.size(); ++i)
    if (last.find(words[i].name) == i) actuator.words.push_back(words[i]);
}

// {"SLOWLY": "30deg/s"}: changes the device's words and adds new ones.
void read_speeds(const json::Value& value, ActuatorConfig& actuator, Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::object, diagnostics)) return;
  report_repeated_keys(value, diagnostics);
  if (actuator.at_unit == nullptr) {
    diagnostics.report(Code::E0205, "this device has no speeds").label(value.span);
    return;
  }
  std::vector<WordConfig> speeds;
  for (const json::Member& member : value.members) {
    check_name({member.key, member.key_span}, diagnostics);
    const auto speed = read_quantity(member.value, *actuator.at_unit, diagnostics);
    if (!speed) continue;
    if (*speed <= 0)
      diagnostics.report(Code::E0205, "a speed must be above 0").label(member.value.span);
    speeds.push_back({member.key, vm::Param::at, *speed, false, {}});
  }
  put_words(std::move(speeds), actuator);
}

// "greeting.wav" or {"file": "greeting.wav", "duration": "2s"}.
std::optional<WordConfig> read_sound(const json::Value& value, Diagnostics& diagnostics) {
  WordConfig sound{{}, vm::Param::item, 0, true, {}};
  const json::Value* file = &value;
  if (value.kind == json::Kind::object) {
    Fields fields(value, Object::sound, diagnostics);
    file = fields.require("file", "a sound");
    if (const auto* duration = fields.find("duration")) {
      const auto length = read_milliseconds(*duration, diagnostics);
      if (length && *length != kDefaultSoundLength) sound.duration = *length;
    }
  }
  if (file == nullptr) return std::nullopt;
  const auto text = read_text(*file, diagnostics);
  if (!text) return std::nullopt;
  sound.name = *text;
  return sound;
}

// A player's tracks are numbered from 1 in the order of the list.
void read_sounds(const json::Value& value, const Device& device, ActuatorConfig& actuator,
                 Diagnostics& diagnostics) {
  if (!expect_kind(value, json::Kind::array, diagnostics)) return;
  if (!device.has_sounds) {
    diagnostics.report(Code::E0205, "this device plays no sounds").label(value.span);
    return;
  }
  vm::Value track = 0;
  std::unordered_set<std::string> known;
  for (const json::Value& item : value.items) {
    track += vm::kScale;
    auto sound = read_sound(item, diagnostics);
    if (!sound) continue;
    if (!known.insert(sound->name).second)
      diagnostics.report(Code::E0101, "the sound `" + sound->name + "` is given twice")
          .label(item.span);
    sound->value = track;
    actuator.words.push_back(std::move(*sound));
  }
}

void read_speed_limit(const json::Value& speed, ActuatorConfig& actuator,
                      Diagnostics& diagnostics) {
  if (actuator.at_unit == nullptr) {
    diagnostics.report(Code::E0205, "this device has no speed to limit").label(speed.span);
    return;
  }
  const auto limit = read_quantity(speed, *actuator.at_unit, diagnostics);
  if (limit && *limit <= 0)
    diagnostics.report(Code::E0205, "a speed must be above 0").label(speed.span);
  else if (limit && *limit < actuator.speed_limit) {
    actuator.speed_limit = *limit;
    actuator.limit_span = speed.span;
  }
}

struct OwnedKey {
  std::string_view key;
  bool (*has)(vm::DriverId driver);
  std::string_view owner;
};
constexpr std::string_view kPanelPhrase = "a panel of lights (`ws2812`)";
constexpr std::string_view kDrive = "a `differential_drive`";
constexpr std::array kOwnedKeys = {
    OwnedKey{"pulse", vm::is_servo, "a servo (`servo`, `pca9685_servo`)"},
    OwnedKey{"size", vm::shows_pictures_on_a_panel, kPanelPhrase},
    OwnedKey{"zigzag", vm::shows_pictures_on_a_panel, kPanelPhrase},
    OwnedKey{"color", vm::shows_pictures_on_a_panel, kPanelPhrase},
    OwnedKey{"brightness", vm::drives_panel,
             "a panel or strip of lights (`ws2812`, `ws2812_strip`)"},
    OwnedKey{"lights", vm::is_strip, "a strip of lights (`ws2812_strip`)"},
    OwnedKey{"left", vm::drives_wheels, kDrive},
    OwnedKey{"right", vm::drives_wheels, kDrive},
    OwnedKey{"speed", vm::drives_wheels, kDrive},
    OwnedKey{"track", vm::drives_wheels, kDrive},
    OwnedKey{"trim", vm::drives_wheels, kDrive},
    OwnedKey{"encoders", vm::drives_wheels, kDrive},
    OwnedKey{"simulated_difference", vm::drives_wheels, kDrive}};

void report_keys_of_others(const Fields& fields, vm::DriverId driver, Diagnostics& diagnostics) {
  for (const OwnedKey& owned : kOwnedKeys) {
    const auto* value = fields.find(owned.key);
    if (value == nullptr || owned.has(driver)) continue;
    Diagnostic& error =
        diagnostics.report(Code::E0205, fmt::format("only {} has `{}`", owned.owner, owned.key))
            .label(value->span);
    if (vm::is_strip(driver) && owned.key == "color")
      error.helps("the program gives a strip its colour: `LIGHT eyes red`");
  }
}

void read_acceleration_limit(const json::Value& acceleration, ActuatorConfig& actuator,
                             Diagnostics& diagnostics) {
  actuator.acceleration_span = acceleration.span;
  if (!actuator.moves_at_a_speed()) {
    diagnostics
        .report(Code::E0205,
                "this device starts and stops without a ramp, so it has no ACCELERATION to limit")
        .label(acceleration.span)
        .helps(
            "servos, a `joint` and a `drive` have ramps; a `differential_drive` and a motor do "
            "not");
    return;
  }
  actuator.acceleration =
      read_acceleration(acceleration, *actuator.at_unit, diagnostics).value_or(0);
}

void read_limits(const json::Value& value, ActuatorConfig& actuator, Diagnostics& diagnostics) {
  const Fields fields(value, Object::limits, diagnostics);
  if (const auto* speed = fields.find("SPEED")) read_speed_limit(*speed, actuator, diagnostics);
  if (const auto* acceleration = fields.find("ACCELERATION"))
    read_acceleration_limit(*acceleration, actuator, diagnostics);
}

// A program takes as long as it would with the real actuator.
void make_virtual(ActuatorConfig& actuator) {
  const vm::DriverId real = actuator.driver;
  const bool shows = vm::drives_lights(real) || vm::drives_screen(real) || vm::drives_panel(real);
  const bool sounds = vm::drives_speaker(real);
  actuator.driver = vm::DriverId::virtual_actuator;
  if (!shows && !sounds && !vm::gives_power(real)) return;
  actuator.driver = vm::DriverId::virtual_output;
  actuator.bus = static_cast<std::uint8_t>(shows    ? vm::VirtualOutput::picture
                                           : sounds ? vm::VirtualOutput::tones
                                                    : vm::VirtualOutput::level);
}

// An actuator that would keep running on power alone must not hold.
void read_safe(const json::Value& value, ActuatorConfig& actuator, Diagnostics& diagnostics) {
  actuator.safe = read_release(value, diagnostics).value_or(actuator.safe);
  if (actuator.safe == vm::Release::rest && vm::drives_channel(actuator.driver)) {
    diagnostics
        .report(Code::E0205,
                "a servo on a chip cannot go to rest when the robot is halted: that "
                "would need the bus, which may have failed")
        .label(value.span)
        .helps("`safe` can be `coast` (limp) or `hold` here");
    actuator.safe = vm::Release::coast;
  }
  if (actuator.safe != vm::Release::hold || !vm::drives_on(actuator.driver)) return;
  const bool sounds = vm::drives_speaker(actuator.driver) || vm::drives_player(actuator.driver);
  diagnostics
      .report(Code::E0205, std::string(sounds ? "a tone with `hold` keeps sounding"
                                              : "a motor with `hold` keeps running") +
                               " when the robot is halted")
      .label(value.span)
      .helps(
          "`safe` can be `coast` (off) here; what stands still on its own may `hold`: a servo, a "
          "`joint`, a picture");
}

// Only a bus brings a voltage of the part to the board: its pull-ups may have another supply.
void check_voltage(const Fields& fields, const WiringType& type, const Device& device,
                   WiringReader& wiring, Diagnostics& diagnostics) {
  if (type.name == "I2C") return wiring.check_volts(fields, device.volts);
  const auto* const volts = fields.find("volts");
  if (volts == nullptr || type.name == "VIRTUAL") return;
  diagnostics.report(Code::E0205, "an output has no `volts`: the board drives it")
      .label(volts->span);
}

// How it is wired, by its type.
void read_place(Fields& fields, const WiringType& type, const Board::Part* part,
                std::span<const SensorConfig> sensors, WiringReader& wiring,
                ActuatorConfig& actuator, Diagnostics& diagnostics) {
  if (type.name != "VIRTUAL" && vm::drives_channel(actuator.driver)) {
    const ChipWiring place = wiring.read_chip(fields);
    actuator.chip = place.chip;
    actuator.pin = place.channel;
  } else if (type.name == "I2C" && vm::drives_screen(actuator.driver)) {
    const Wiring place = wiring.read_display(fields, type);
    actuator.bus = place.bus;
    actuator.pin = place.place;
  } else if (type.name == "PWM" && vm::drives_wheels(actuator.driver)) {
    wiring.take_drive(fields, type);
    actuator.drive = read_drive(fields, wiring, actuator, diagnostics);
    read_wheel_encoders(fields, sensors, actuator, diagnostics);
  } else {
    const bool of_board = type.name != "VIRTUAL" && (vm::drives_lights(actuator.driver) ||
                                                     vm::drives_speaker(actuator.driver));
    if (of_board) wiring.check_part(fields, part);
    const Wiring place = of_board && part == nullptr
                             ? Wiring{}
                             : wiring.read_actuator(fields, type, part, actuator.driver);
    actuator.bus = place.bus;
    actuator.pin = place.place;
    if (type.name == "VIRTUAL") make_virtual(actuator);
    if (type.name != "VIRTUAL" && actuator.driver == vm::DriverId::virtual_actuator)
      wiring.check_without_driver(fields, type, place);
    if (vm::drives_pin(actuator.driver)) wiring.check_output(fields, place, actuator.driver);
    if (vm::drives_player(actuator.driver)) wiring.check_line(fields, place);
    if (vm::drives_panel(actuator.driver)) wiring.check_panel(fields, place);
  }
}

// `"device": "drive"` with the keys of the drive that has pins: one mistake, however many keys there are.
const Device* meant_drive(const Fields& fields, Diagnostics& diagnostics) {
  const auto* const device = fields.find("device");
  const auto* const left = fields.find("left");
  if (device == nullptr || left == nullptr || !same_name(device->text, "drive")) return nullptr;
  diagnostics.report(Code::E0205, "a `drive` has no pins: its commands go over the link")
      .label(device->span)
      .label(left->span, "pins", false)
      .helps("did you mean `differential_drive`?")
      .fix(device->span, "\"differential_drive\"", Applicability::likely);
  return find_device("differential_drive", false);
}

}  // namespace

bool may_have(const Device& device, std::string_view key) {
  const auto* const owned = std::ranges::find(kOwnedKeys, key, &OwnedKey::key);
  if (owned != kOwnedKeys.end()) return owned->has(device.actuator.driver);
  if (key == "volts") return device.type == "I2C";
  if (key == "sounds") return device.has_sounds;
  return key != "speeds" || device.actuator.at_unit != nullptr;
}

std::optional<ActuatorConfig> read_actuator(const json::Value& value,
                                            std::span<const SensorConfig> sensors,
                                            WiringReader& wiring, Diagnostics& diagnostics) {
  Fields fields(value, Object::actuator, diagnostics);
  const auto name = read_name(fields, "an actuator", diagnostics);
  const Device* const meant = meant_drive(fields, diagnostics);
  const Board::Part* part = find_part(fields, wiring.board(), false);
  const WiringType* type =
      meant != nullptr ? nullptr : choose_type(fields, part, false, diagnostics);
  if (!name) return std::nullopt;
  const Device* const known =
      meant != nullptr ? meant
                       : choose_device(fields, type, *name, wiring.board(), false, diagnostics);
  const Device& device = known != nullptr ? *known : virtual_device(false);
  ActuatorConfig actuator = device.actuator;
  actuator.name = *name;
  if (part != nullptr) actuator.part = part->name;
  actuator.range_span = name->span;
  actuator.limit_span = name->span;
  if (known == nullptr) return actuator;
  if (type != nullptr) read_place(fields, *type, part, sensors, wiring, actuator, diagnostics);
  if (type != nullptr) check_voltage(fields, *type, device, wiring, diagnostics);
  actuator.panel = read_lights(fields, device.actuator.driver, diagnostics);
  report_keys_of_others(fields, device.actuator.driver, diagnostics);
  if (const auto* range = fields.find("range")) read_position_range(*range, actuator, diagnostics);
  if (vm::is_servo(device.actuator.driver)) {
    if (const auto* pulse = fields.find("pulse"))
      read_pulses(*pulse, wiring.board(), actuator, diagnostics);
    else
      check_usual_pulses(fields, wiring.board(), actuator, diagnostics);
  }
  if (const auto* speeds = fields.find("speeds")) read_speeds(*speeds, actuator, diagnostics);
  if (const auto* sounds = fields.find("sounds"))
    read_sounds(*sounds, device, actuator, diagnostics);
  if (actuator.drive) {
    actuator.speed_limit = actuator.drive->speed;
    actuator.limit_span = fields.find("speed")->span;
  }
  if (const auto* limits = fields.find("limits")) read_limits(*limits, actuator, diagnostics);
  if (const auto* release = fields.find("on_release"))
    actuator.on_release = read_release(*release, diagnostics).value_or(actuator.on_release);
  const auto* safe = fields.find("safe");
  if (safe != nullptr) read_safe(*safe, actuator, diagnostics);
  if (actuator.chip)
    wiring.check_safe(*actuator.chip, actuator.safe, safe != nullptr ? safe->span : name->span);
  return actuator;
}

}  // namespace robosync::compiler
