// Verifier, part: the records of the image.
//
// One walk over the sections in their order, with one check for each kind of record. A check may rely
// on the sections before its own.
#include <cstddef>
#include <type_traits>

#include "vm/drive.hpp"
#include "vm/drivers.hpp"
#include "vm/pictures.hpp"
#include "vm/timers.hpp"
#include "vm/verification.hpp"

namespace robosync::vm {
namespace {

// The context of the checks, and their state from the records before.
struct Walk {
  const Image& image;
  const Limits& limits;
  std::uint32_t next_channel = 0;
  std::uint32_t next_rule = 0;
  std::uint32_t cells = 0;  // of all frames
  std::int32_t last_priority = kSafetyPriority + 1;
  std::uint32_t safety_rules = 0;  // number of SAFETY rules, which come first
  std::uint32_t samples = 0;       // of all windows
  std::uint32_t timer_words = 0;
  std::uint32_t next_track = 0;
  std::uint32_t next_key = 0;
  std::uint32_t last_word = 0;  // of the source lines
  bool reads_pins = false;      // there is a sensor that uses pins
  std::uint32_t servo_chips = 0;
  std::uint32_t displays = 0;
  std::uint32_t microphones = 0;
  std::uint32_t encoders = 0;
  std::uint32_t drives = 0;
};

enum class DriverKind : std::uint8_t { sensor, actuator };

constexpr DriverKind kDriverKinds[] = {
#define SENSOR_DRIVER(name, ...) DriverKind::sensor,
#define ACTUATOR_DRIVER(name, ...) DriverKind::actuator,
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER
};
static_assert(std::size(kDriverKinds) <= 64, "one bit each in Limits::drivers");

constexpr std::array kDimensions = {
#define DIMENSION(name, unit, doc) Dimension::name,
#include "vm/dimensions.def"
#undef DIMENSION
};

// The pool ends with a NUL (check_records), so every offset inside it is the start of a string.
bool is_string(const Walk& walk, std::uint16_t name) {
  return name < walk.image.strings.size();
}

bool is_dimension(Dimension dimension) {
  return static_cast<std::size_t>(dimension) < kDimensions.size();
}

// Are the `count` records from `first` on within `all` records?
bool is_inside(std::size_t first, std::size_t count, std::size_t all) {
  return first + count <= all;
}

bool is_range(Value min, Value max) {
  return min != kUnknown && min <= max;
}

// Variable::fade is the fraction of the distance that is left, times this; at this value nothing fades.
constexpr std::uint32_t kNoFade = std::uint32_t{1} << 31;

template <typename Enum>
constexpr bool is_enumerator(Enum value) {
  return value < Enum::count_;
}

// Are the `length` words from `start` on within the code?
bool is_code(const Walk& walk, std::uint32_t start, std::uint32_t length) {
  return length > 0 && is_inside(start, length, walk.image.code.size());
}

Refusal check_driver(const Walk& walk, DriverId driver, DriverKind kind) {
  const auto number = static_cast<std::size_t>(driver);
  if (number >= std::size(kDriverKinds)) return Refusal::no_driver;
  if (kDriverKinds[number] != kind) return Refusal::bad_value;
  return good_or(Refusal::no_driver, (walk.limits.drivers >> number & 1) != 0);
}

// An algorithm reads an earlier sensor, so algorithms cannot wait for each other. The firmware checks
// the parameters of its module (runtime-m4/algorithms/judge.hpp).
Refusal check_algorithm(const Sensor& sensor) {
  if (sensor.first_input >= sensor.first_channel) return Refusal::bad_index;
  return good_or(Refusal::bad_value, sensor.period_ms > 0);
}

// Is `pin` used by one of the first `count` sensors?
bool is_of_sensor(const Image& image, std::uint32_t pin, std::size_t count) {
  for (const Sensor& sensor : image.sensors.first(count)) {
    if (sensor.address == pin && (reads_pin(sensor.driver) || is_on_spi(sensor.driver)))
      return true;
    if ((is_by_echo(sensor.driver) || has_second_input(sensor)) && sensor.bus == pin) return true;
    if (is_servo_chip(sensor.driver) && sensor.first_input == pin) return true;
  }
  return false;
}

// An echo sensor shares neither of its two pins.
Refusal check_echo(Walk& walk, const Sensor& sensor, std::size_t index) {
  walk.reads_pins = true;
  const bool shared = sensor.bus == sensor.address || is_of_sensor(walk.image, sensor.bus, index) ||
                      is_of_sensor(walk.image, sensor.address, index);
  if (shared) return Refusal::shared_pin;
  return good_or(Refusal::bad_value, sensor.period_ms >= kMinEchoPeriodMs);
}

// A sensor does not share the pin that it reads, which may be one that the board can drive.
Refusal check_pin(Walk& walk, const Sensor& sensor, std::size_t index) {
  walk.reads_pins = true;
  if (is_of_sensor(walk.image, sensor.address, index)) return Refusal::shared_pin;
  const bool reads = is_analog(sensor.driver) ? sensor.bus == 0
                                              : is_enumerator(static_cast<ActiveLevel>(sensor.bus));
  return good_or(Refusal::bad_value, sensor.period_ms > 0 && reads);
}

// An encoder shares neither of its pins. All edges of a period may interrupt at once, so the period is short.
Refusal check_encoder(Walk& walk, const Sensor& sensor, std::size_t index) {
  walk.reads_pins = true;
  if (++walk.encoders > kMaxEncoders) return Refusal::too_many;
  if (is_of_sensor(walk.image, sensor.address, index)) return Refusal::shared_pin;
  if (has_second_input(sensor) &&
      (sensor.bus == sensor.address || is_of_sensor(walk.image, sensor.bus, index)))
    return Refusal::shared_pin;
  return good_or(Refusal::bad_value,
                 sensor.period_ms > 0 && sensor.period_ms <= kMostEncoderPeriodMs);
}

// A part on SPI has its select pin for itself.
Refusal check_spi(Walk& walk, const Sensor& sensor, std::size_t index) {
  walk.reads_pins = true;
  if (is_of_sensor(walk.image, sensor.address, index)) return Refusal::shared_pin;
  const bool format = sensor.driver == DriverId::spi_register
                          ? is_enumerator(static_cast<SpiFormat>(sensor.first_input))
                          : sensor.first_input == 0;
  return good_or(Refusal::bad_value, sensor.period_ms > 0 && format);
}

// There is one, which needs no place, and it shares the converter with no analog sensor.
Refusal check_microphone(Walk& walk, const Sensor& sensor) {
  if (++walk.microphones > 1) return Refusal::too_many;
  for (const Sensor& other : walk.image.sensors)
    if (is_analog(other.driver)) return Refusal::bad_value;
  return good_or(Refusal::bad_value,
                 sensor.period_ms == kSoundPeriodMs && sensor.bus == 0 && sensor.address == 0);
}

Refusal check_board_part(const Sensor& sensor) {
  return good_or(Refusal::bad_value,
                 sensor.period_ms > 0 && sensor.bus == 0 && sensor.address == 0);
}

bool answers_at(const Sensor& sensor, const Sensor& chip) {
  return is_on_i2c(sensor.driver) && sensor.bus == chip.bus && sensor.address == chip.address;
}

// No other sensor has its address on its bus.
bool is_alone(const Image& image, const Sensor& chip, std::size_t index) {
  for (std::size_t s = 0; s < image.sensors.size(); ++s)
    if (s != index && answers_at(image.sensors[s], chip)) return false;
  return true;
}

// A servo chip shares neither its address nor its enable pin.
Refusal check_servo_chip(Walk& walk, const Sensor& chip, std::size_t index) {
  walk.reads_pins = true;
  if (++walk.servo_chips > kMaxServoChips) return Refusal::too_many;
  if (is_of_sensor(walk.image, chip.first_input, index)) return Refusal::shared_pin;
  const bool place = chip.address >= kFirstChipAddress && chip.address <= kLastAddress &&
                     chip.address != kAllChipsAddress;
  return good_or(Refusal::bad_value, place && chip.channel_count == 0 &&
                                         chip.period_ms == kServoFrameMs &&
                                         is_alone(walk.image, chip, index));
}

Refusal check_display(Walk& walk, const Sensor& display, std::size_t index) {
  if (++walk.displays > kMaxDisplays) return Refusal::too_many;
  const bool place =
      display.address >= kFirstDisplayAddress && display.address <= kLastDisplayAddress;
  return good_or(Refusal::bad_value, place && display.channel_count == 0 &&
                                         display.period_ms == kDisplayFrameMs &&
                                         is_alone(walk.image, display, index));
}

Refusal check_sensor(Walk& walk, const Sensor& sensor, std::size_t index) {
  if (sensor.first_channel != walk.next_channel) return Refusal::bad_index;
  walk.next_channel += sensor.channel_count;
  if (walk.next_channel > walk.image.channels.size()) return Refusal::bad_index;
  const Refusal driver = check_driver(walk, sensor.driver, DriverKind::sensor);
  if (driver != Refusal::none) return driver;
  if (sensor.driver == DriverId::algorithm) return check_algorithm(sensor);
  if (sensor.room != 0) return Refusal::bad_value;
  if (is_servo_chip(sensor.driver)) return check_servo_chip(walk, sensor, index);
  if (is_on_spi(sensor.driver)) return check_spi(walk, sensor, index);
  if (sensor.first_input != 0) return Refusal::bad_value;
  if (is_display(sensor.driver)) return check_display(walk, sensor, index);
  if (bus_of(sensor.driver) == Bus::nothing) return Refusal::none;
  if (is_by_echo(sensor.driver)) return check_echo(walk, sensor, index);
  if (counts_edges(sensor.driver)) return check_encoder(walk, sensor, index);
  if (is_microphone(sensor.driver)) return check_microphone(walk, sensor);
  if (is_board_part(sensor.driver)) return check_board_part(sensor);
  if (reads_pin(sensor.driver)) return check_pin(walk, sensor, index);
  const bool place = sensor.address >= kFirstAddress && sensor.address <= kLastAddress;
  const bool alone = !measures_when_told(sensor.driver) || is_alone(walk.image, sensor, index);
  return good_or(Refusal::bad_value, sensor.period_ms > 0 && place && alone &&
                                         sensor.period_ms >= min_period_ms(sensor.driver));
}

// Each channel names its sensor, and is in that sensor's range. The ranges follow each other without
// gaps, so a channel after the last range has no sensor to name.
Refusal check_channel(Walk& walk, const Channel& channel, std::size_t index) {
  if (channel.sensor >= walk.image.sensors.size()) return Refusal::bad_index;
  const Sensor& sensor = walk.image.sensors[channel.sensor];
  if (index - sensor.first_channel >= sensor.channel_count) return Refusal::bad_index;
  if (!is_inside(channel.first_label, channel.label_count, walk.image.labels.size()))
    return Refusal::bad_index;
  return good_or(Refusal::bad_value, is_dimension(channel.dimension) && channel.scale_den != 0 &&
                                         channel.offset != kUnknown &&
                                         is_range(channel.min, channel.max) && channel.change >= 0);
}

// Outputs that an actuator does not share: its pins, the lights, the speaker, a display, a serial line, or the panel.
constexpr std::uint32_t kNothing = UINT32_MAX;
constexpr std::uint32_t kLights = UINT16_MAX + 1;
constexpr std::uint32_t kSpeaker = kLights + 1;
constexpr std::uint32_t kDisplays = kSpeaker + 1;
constexpr std::uint32_t kLines = kDisplays + UINT8_MAX + 1;
constexpr std::uint32_t kPanel = kLines + UINT8_MAX + 1;

std::uint32_t output_of(const Actuator& actuator) {
  switch (pin_use(actuator.driver)) {
    case PinUse::picture:
      return kLights;
    case PinUse::screen:
      return kDisplays + actuator.bus;
    case PinUse::tones:
      return kSpeaker;
    case PinUse::line:
      return kLines + actuator.bus;
    case PinUse::pulses:
    case PinUse::level:
    case PinUse::either_way:
    case PinUse::panel:
      return actuator.pin;
    case PinUse::channel:
    case PinUse::wheels:
    case PinUse::nothing:
      break;
  }
  return kNothing;
}

std::uint32_t second_output_of(const Actuator& actuator) {
  if (drives_panel(actuator.driver)) return kPanel;
  return has_two_pins(actuator.driver) ? actuator.bus : kNothing;
}

// The drive's parameters must have been checked.
DriveParameters drive_of(const Image& image, const Actuator& drive) {
  return vm::drive_of(image.constants.data() + drive.pin);
}

bool owns(const Image& image, const Actuator& actuator, std::uint32_t output) {
  if (drives_wheels(actuator.driver)) {
    for (const std::uint8_t pin : drive_of(image, actuator).pins)
      if (pin == output) return true;
    return false;
  }
  return output_of(actuator) == output || second_output_of(actuator) == output;
}

// Does an actuator before this one, or a sensor, use the output?
bool is_taken(const Walk& walk, std::uint32_t output, std::size_t index) {
  if (walk.reads_pins && is_of_sensor(walk.image, output, walk.image.sensors.size())) return true;
  for (std::size_t a = 0; a < index; ++a)
    if (owns(walk.image, walk.image.actuators[a], output)) return true;
  return false;
}

// An output has one owner, and no sensor reads its pin. An output that runs until it is ended must not hold in its safe state.
Refusal check_output(const Walk& walk, const Actuator& actuator, std::size_t index) {
  const std::uint32_t output = output_of(actuator);
  const std::uint32_t second = second_output_of(actuator);
  if (output == kNothing) return Refusal::none;
  if (output == second || is_taken(walk, output, index)) return Refusal::shared_pin;
  if (second != kNothing && is_taken(walk, second, index)) return Refusal::shared_pin;
  if (second == kPanel && !is_panel(actuator)) return Refusal::bad_value;
  return good_or(Refusal::drives_on, !drives_on(actuator.driver) || actuator.safe != Release::hold);
}

// A channel of a chip has one owner. In a halt, the chip's single enable pin turns all its pulses off. So the servos of a chip go
// limp together, or all hold, and none can be brought to rest.
Refusal check_channel_of_chip(const Walk& walk, const Actuator& servo, std::size_t index) {
  const Image& image = walk.image;
  if (servo.bus >= image.sensors.size() || !is_servo_chip(image.sensors[servo.bus].driver) ||
      servo.pin >= kChipChannels)
    return Refusal::bad_index;
  if (servo.safe == Release::rest) return Refusal::needs_the_bus;
  for (const Actuator& other : image.actuators.first(index)) {
    if (!drives_channel(other.driver) || other.bus != servo.bus) continue;
    if (other.pin == servo.pin) return Refusal::shared_pin;
    if (other.safe != servo.safe) return Refusal::needs_the_bus;
  }
  return Refusal::none;
}

bool is_trim(std::uint8_t percent) {
  return percent > 0 && percent <= kFullTrim;
}

// It has two encoders, one for each wheel, or none.
Refusal check_encoders(const Image& image, const Actuator& drive, const DriveParameters& has) {
  if (!has_encoders(has))
    return good_or(Refusal::bad_value, drive.bus == 0 && has.encoders[1] == 0);
  for (const Side side : kSides)
    if (!encoder_of(image, has, side)) return Refusal::bad_index;
  const std::int8_t difference = difference_of(drive);
  return good_or(Refusal::bad_value, has.encoders[0] != has.encoders[1] &&
                                         difference >= -kMostDifference &&
                                         difference <= kMostDifference);
}

// Each of the four pins is an output of its own, and neither motor may go on in the safe state.
Refusal check_drive(Walk& walk, const Actuator& drive, std::size_t index) {
  if (++walk.drives > kMaxDrives) return Refusal::too_many;
  if (!is_inside(drive.pin, kDriveValues, walk.image.constants.size())) return Refusal::bad_index;
  const DriveParameters has = drive_of(walk.image, drive);
  for (std::size_t p = 0; p < has.pins.size(); ++p) {
    if (is_taken(walk, has.pins[p], index)) return Refusal::shared_pin;
    for (std::size_t before = 0; before < p; ++before)
      if (has.pins[before] == has.pins[p]) return Refusal::shared_pin;
  }
  if (drive.safe == Release::hold) return Refusal::drives_on;
  const bool good = is_trim(has.trim[0]) && is_trim(has.trim[1]) && has.speed > 0 &&
                    has.track > 0 && has.track <= kMostTrack && has.usual > 0;
  return good ? check_encoders(walk.image, drive, has) : Refusal::bad_value;
}

bool has_display(const Image& image, const Actuator& face) {
  return face.bus < image.sensors.size() && is_display(image.sensors[face.bus].driver);
}

Refusal check_actuator(Walk& walk, const Actuator& actuator, std::size_t index) {
  if ((actuator.verbs & ~low_bits(walk.image.verbs.size())) != 0) return Refusal::bad_index;
  const bool good = is_enumerator(actuator.on_release) && is_enumerator(actuator.safe) &&
                    is_range(actuator.min, actuator.max) && actuator.speed_limit >= 0;
  if (!good) return Refusal::bad_value;
  const Refusal driver = check_driver(walk, actuator.driver, DriverKind::actuator);
  if (driver != Refusal::none) return driver;
  if (drives_screen(actuator.driver) && !has_display(walk.image, actuator))
    return Refusal::bad_index;
  if (drives_wheels(actuator.driver)) return check_drive(walk, actuator, index);
  return drives_channel(actuator.driver) ? check_channel_of_chip(walk, actuator, index)
                                         : check_output(walk, actuator, index);
}

Refusal check_group(Walk& walk, const Group& group, std::size_t) {
  if ((group.members & ~low_bits(walk.image.actuators.size())) != 0) return Refusal::bad_index;
  return good_or(Refusal::bad_value, group.members != 0 && group.reserved == 0);
}

Refusal check_verb(Walk&, const Verb& verb, std::size_t) {
  constexpr std::uint32_t kParams = low_bits(static_cast<std::size_t>(Param::count_));
  return good_or(Refusal::bad_value, is_enumerator(verb.action) && (verb.params & ~kParams) == 0);
}

Refusal check_word(Walk&, const WordEntry& word, std::size_t) {
  const bool known = word.param == Param::item ? word.value >= item_of_picture(kAllLights)
                                               : word.value != kUnknown;
  return good_or(Refusal::bad_value, is_enumerator(word.param) && word.reserved == 0 && known);
}

Refusal check_variable(Walk& walk, const Variable& variable, std::size_t) {
  if (!is_inside(variable.first_label, variable.label_count, walk.image.labels.size()))
    return Refusal::bad_index;
  const bool is_band = variable.kind == VariableKind::band;
  const bool has_labels = is_band || variable.kind == VariableKind::state;
  const auto in_range = [&](Value value) { return variable.min <= value && value <= variable.max; };
  // Who carries a state over to the next program looks up its label (runtime-m4/layers/carried.cpp).
  const bool is_label = variable.kind != VariableKind::state ||
                        (variable.min >= 0 && variable.max / kScale < variable.label_count);
  const bool fades = variable.kind == VariableKind::feeling && variable.fade < kNoFade &&
                     in_range(variable.fades_to);
  return good_or(Refusal::bad_value,
                 is_enumerator(variable.kind) && is_dimension(variable.dimension) &&
                     has_labels == (variable.label_count > 0) && variable.reserved == 0 &&
                     is_range(variable.min, variable.max) && is_label &&
                     (is_band ? variable.initial == kUnknown : in_range(variable.initial)) &&
                     (variable.fade == 0 || fades));
}

// A check's bands are the labels of its variable. It reads no band, so the order of checks has no effect.
Refusal check_check(Walk& walk, const Check& check, std::size_t) {
  const Image& image = walk.image;
  const std::size_t channels = image.channels.size();
  if (check.variable >= image.variables.size() ||
      check.input >= channels + image.variables.size() ||
      !is_inside(check.first_band, check.band_count, image.bands.size()))
    return Refusal::bad_index;
  const Variable& variable = image.variables[check.variable];
  const bool reads_band =
      check.input >= channels && image.variables[check.input - channels].kind == VariableKind::band;
  if (variable.kind != VariableKind::band || variable.label_count != check.band_count || reads_band)
    return Refusal::bad_value;
  if (check.window == 0 || check.window > kMaxWindow || (check.window > 1 && check.sample_ms == 0))
    return Refusal::bad_value;
  if (check.window > 1) walk.samples += check.window;
  return good_or(Refusal::too_many, walk.samples <= walk.limits.samples);
}

Refusal check_band(Walk&, const Band& band, std::size_t) {
  const bool holds_nothing = band.stay_low > band.stay_high;
  const bool holds_itself = is_range(band.stay_low, band.low) && band.high <= band.stay_high;
  return good_or(Refusal::bad_value, band.low <= band.high && (holds_nothing || holds_itself));
}

// Does the input become unknown to SAFETY some time after its sensor falls silent?
bool grows_stale(const Image& image, std::uint8_t input) {
  if (input >= image.channels.size()) return true;  // a variable
  const Channel& channel = image.channels[input];
  const Sensor& sensor = image.sensors[channel.sensor];
  const Channel& measured =
      sensor.driver == DriverId::algorithm ? image.channels[sensor.first_input] : channel;
  return channel.stale_ms > 0 || !may_be_silent(image.sensors[measured.sensor].driver);
}

bool all_grow_stale(const Image& image, const Behavior& safety) {
  const std::uint8_t* const inputs = image.inputs.data() + safety.first_input;
  for (std::size_t i = 0; i < safety.input_count; ++i)
    if (!grows_stale(image, inputs[i])) return false;
  return true;
}

// Behaviours are in order of strictly falling priority, and their rules follow each other without gaps.
Refusal check_behavior(Walk& walk, const Behavior& behavior, std::size_t index) {
  if (behavior.name != kNoIndex && !is_string(walk, behavior.name)) return Refusal::bad_string;
  if (index > 0 && behavior.priority == walk.last_priority) return Refusal::same_priority;
  if (behavior.priority >= walk.last_priority || behavior.priority < kMinPriority)
    return Refusal::bad_value;
  walk.last_priority = behavior.priority;
  if (index == kSafetyBehavior && walk.image.has_safety()) walk.safety_rules = behavior.rule_count;

  if (behavior.first_rule != walk.next_rule || behavior.rule_count == 0) return Refusal::bad_index;
  walk.next_rule += behavior.rule_count;
  if (walk.next_rule > walk.image.rules.size() ||
      !is_inside(behavior.first_input, behavior.input_count, walk.image.inputs.size()))
    return Refusal::bad_index;

  if (behavior.priority == kSafetyPriority && !all_grow_stale(walk.image, behavior))
    return Refusal::never_stale;

  if (behavior.cells < behavior.input_count + behavior.locals + count_watches(walk.image, behavior))
    return Refusal::bad_value;
  walk.cells += behavior.cells;
  return good_or(Refusal::too_many, walk.cells <= walk.limits.frame_cells);
}

Refusal check_modifiers(Walk&, const Modifiers& modifiers, std::size_t) {
  const auto& reserved = modifiers.reserved;
  return good_or(Refusal::bad_value, modifiers.cooldown >= 0 && modifiers.waiting >= 0 &&
                                         modifiers.restarting <= 1 &&
                                         (reserved[0] | reserved[1] | reserved[2]) == 0);
}

// Timers follow each other in the timer memory.
Refusal check_timer(Walk& walk, const Timer& timer, std::size_t) {
  const bool good =
      is_enumerator(timer.kind) && timer.state == walk.timer_words && timer.duration >= 0 &&
      (info_of(timer.kind).counts ? timer.count > 0 && timer.count <= kMaxEdges : timer.count == 0);
  if (!good) return Refusal::bad_value;
  walk.timer_words += timer_words(timer);
  return good_or(Refusal::too_many, walk.timer_words <= walk.limits.timer_words);
}

// The parts of a rule, by its kind; it must have no others.
enum Part : std::uint8_t { kCondition = 1, kThen = 2, kElse = 4, kModified = 8, kSafety = 16 };

constexpr std::uint8_t parts_of(RuleKind kind) {
  switch (kind) {
    case RuleKind::when:
    case RuleKind::while_:
    case RuleKind::every:
      return kCondition | kThen | kModified;
    case RuleKind::when_else:
      return kCondition | kThen | kElse | kModified;
    case RuleKind::start:
      return kThen;
    case RuleKind::watch:
      return kCondition;
    case RuleKind::safety:
      return kCondition | kThen | kSafety;
    case RuleKind::resume:
      return kCondition | kSafety;
    case RuleKind::count_:
      break;
  }
  return 0;
}

bool has_response(const Walk& walk, std::uint16_t index, bool wanted) {
  return wanted ? index < walk.image.responses.size() : index == kNoIndex;
}

// SAFETY rules come first, in a behaviour that contains nothing else.
Refusal check_rule(Walk& walk, const Rule& rule, std::size_t index) {
  if (index >= walk.next_rule) return Refusal::bad_index;  // no behaviour has it
  const std::uint8_t parts = parts_of(rule.kind);
  if (parts == 0 || ((parts & kSafety) != 0) != (index < walk.safety_rules))
    return Refusal::bad_value;
  const bool follows = index > 0 && walk.image.rules[index - 1].kind == RuleKind::safety;
  if (rule.kind == RuleKind::resume && !follows) return Refusal::bad_value;
  const bool code = (parts & kCondition) != 0
                        ? is_code(walk, rule.condition_start, rule.condition_length)
                        : rule.condition_start == 0 && rule.condition_length == 0;
  const bool modified = (parts & kModified) != 0 && rule.modifiers < walk.image.modifiers.size();
  return good_or(Refusal::bad_index, code && (modified || rule.modifiers == kNoModifiers) &&
                                         has_response(walk, rule.then_response, parts & kThen) &&
                                         has_response(walk, rule.else_response, parts & kElse));
}

Refusal check_response(Walk& walk, const Response& response, std::size_t) {
  return good_or(Refusal::bad_index, is_code(walk, response.start, response.length));
}

Refusal check_input(Walk& walk, const std::uint8_t& input, std::size_t) {
  return good_or(Refusal::bad_index,
                 input < walk.image.channels.size() + walk.image.variables.size());
}

Refusal check_label(Walk& walk, const std::uint16_t& label, std::size_t) {
  return good_or(Refusal::bad_string, is_string(walk, label));
}

// The interpreter's comparisons with a constant rely on the constant being known.
Refusal check_constant(Walk&, const Value& constant, std::size_t) {
  return good_or(Refusal::bad_value, constant != kUnknown);
}

Refusal check_source_line(Walk& walk, const SourceLine& line, std::size_t) {
  if (line.word >= walk.image.code.size()) return Refusal::bad_index;
  const bool sorted = line.word >= walk.last_word;
  walk.last_word = line.word;
  return good_or(Refusal::bad_value, sorted);
}

Refusal check_adaptation(Walk&, const Adaptation& adaptation, std::size_t) {
  const auto& reserved = adaptation.reserved;
  return good_or(Refusal::bad_value, adaptation.alpha > 0 &&
                                         adaptation.window_ms >= kMinAdaptationMs &&
                                         adaptation.cap > 0 && adaptation.cap <= kMaxPriority &&
                                         (reserved[0] | reserved[1] | reserved[2]) == 0);
}

bool can_have(const Actuator& actuator, const Trait& trait) {
  if (trait.kind == TraitKind::acceleration) return trait.value > 0 && moves_at_a_speed(actuator);
  return is_servo(actuator.driver) && trait.value >= kServoPulses.at_min &&
         trait.value <= kServoPulses.at_max;
}

// A name comes first. An actuator has at most one trait of each other kind.
Refusal check_trait(Walk& walk, const Trait& trait, std::size_t index) {
  const Image& image = walk.image;
  if (trait.kind == TraitKind::name) {
    if (!is_string(walk, trait.value)) return Refusal::bad_string;
    const std::size_t length = image.string(trait.value).size();
    return good_or(Refusal::bad_value,
                   index == 0 && length <= kMaxRobotName && trait.actuator == 0);
  }
  if (!is_enumerator(trait.kind)) return Refusal::bad_value;
  if (trait.actuator >= image.actuators.size()) return Refusal::bad_index;
  const auto rank = [](const Trait& one) { return std::pair(one.kind, one.actuator); };
  const bool in_order = index == 0 || image.traits[index - 1].kind == TraitKind::name ||
                        rank(image.traits[index - 1]) < rank(trait);
  return good_or(Refusal::bad_value, in_order && can_have(image.actuators[trait.actuator], trait));
}

// The tracks of the motions follow each other without gaps, and so do the keys of the tracks. Tracks
// and keys that belong to none are refused.
Refusal check_motion(Walk& walk, const Motion& motion, std::size_t) {
  if (motion.first_track != walk.next_track) return Refusal::bad_index;
  walk.next_track += motion.track_count;
  if (walk.next_track > walk.image.tracks.size()) return Refusal::bad_index;
  return good_or(Refusal::bad_value,
                 motion.track_count > 0 && motion.length >= static_cast<Value>(kMinKeyGapMs));
}

Refusal check_track(Walk& walk, const Track& track, std::size_t index) {
  if (index >= walk.next_track || track.actuator >= walk.image.actuators.size() ||
      track.first_key != walk.next_key)
    return Refusal::bad_index;
  walk.next_key += track.key_count;
  if (walk.next_key > walk.image.keys.size()) return Refusal::bad_index;
  const Key* const keys = walk.image.keys.data() + track.first_key;
  for (std::size_t k = 1; k < track.key_count; ++k)
    if (std::int64_t{keys[k].time} - keys[k - 1].time < kMinKeyGapMs) return Refusal::bad_value;
  return good_or(Refusal::bad_value, track.key_count > 0);
}

Refusal check_key(Walk& walk, const Key& key, std::size_t index) {
  if (index >= walk.next_key) return Refusal::bad_index;
  return good_or(Refusal::bad_value, key.time >= 0 && key.to != kUnknown);
}

using RecordCheck = Refusal (*)(Walk&, const std::byte* record, std::size_t index);

// A section for the walk: the number of records in the header, their size, and their check.
struct SectionInfo {
  RecordCheck check;  // null: nothing to check
  std::uint8_t record_size;
  std::uint8_t count_place;  // offset in the header
  std::uint8_t count_size;
  bool named;  // the records begin with their name
};

// A behaviour's name is at another offset, and may be absent: check_behavior.
template <typename Record>
constexpr bool is_named() {
  if constexpr (requires { &Record::name; }) return offsetof(Record, name) == 0;
  return false;
}

// For sections that another part of the verifier checks: code (verify_object.cpp), strings (check_records).
constexpr std::nullptr_t unchecked = nullptr;

template <typename Record, auto check>
constexpr RecordCheck check_of() {
  if constexpr (std::is_null_pointer_v<decltype(check)>)
    return nullptr;
  else
    return [](Walk& walk, const std::byte* record, std::size_t index) {
      return check(walk, *reinterpret_cast<const Record*>(record), index);
    };
}

// In the order of Section, from the section after the header on.
constexpr SectionInfo kSections[] = {
#define IMAGE_SECTION(records, Record, Count, check, name)                                   \
  {check_of<Record, check>(), sizeof(Record), offsetof(ImageHeader, records), sizeof(Count), \
   is_named<Record>()},
#include "vm/sections.def"
#undef IMAGE_SECTION
};

std::size_t record_count(const ImageHeader& header, const SectionInfo& section) {
  const auto* const place = reinterpret_cast<const std::uint8_t*>(&header) + section.count_place;
  return section.count_size == 1 ? *place : *place | std::size_t{place[1]} << 8;
}

}  // namespace

std::size_t count_watches(const Image& image, const Behavior& behavior) {
  std::size_t watches = 0;
  const Rule* const rules = image.rules.data() + behavior.first_rule;
  for (std::size_t r = 0; r < behavior.rule_count; ++r)
    watches += rules[r].kind == RuleKind::watch ? 1 : 0;
  return watches;
}

bool check_records(Verification& verification) {
  const Image& image = verification.image;
  if (!image.strings.empty() && image.strings.back() != 0)
    return verification.refuse(Refusal::bad_string, Section::strings, 0);
  Walk walk{image, verification.limits};
  const auto* next = reinterpret_cast<const std::byte*>(image.header + 1);
  for (std::size_t s = 0; s < std::size(kSections); ++s) {
    const SectionInfo& section = kSections[s];
    const auto here = static_cast<Section>(s + 1);
    const std::size_t count = record_count(*image.header, section);
    if (count == 0) continue;
    for (std::size_t i = 0; i < count && section.check != nullptr; ++i) {
      const std::byte* const record = next + i * section.record_size;
      if (section.named && !is_string(walk, *reinterpret_cast<const std::uint16_t*>(record)))
        return verification.refuse(Refusal::bad_string, here, i);
      const Refusal refusal = section.check(walk, record, i);
      if (refusal != Refusal::none) return verification.refuse(refusal, here, i);
    }
    next += count * section.record_size;
    for (; reinterpret_cast<std::uintptr_t>(next) % 4 != 0; ++next)
      if (*next != std::byte{0}) return verification.refuse(Refusal::bad_value, here, 0);
  }
  return true;
}

}  // namespace robosync::vm
