#include "compiler/codegen/records.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "compiler/config/devices.hpp"
#include "vm/drivers.hpp"

namespace robosync::compiler {
namespace {

class RecordMaker {
public:
  RecordMaker(const ir::Program& program, const Robot& robot, const Tables& tables,
              Strings& strings)
      : program_(program), robot_(robot), tables_(tables), strings_(strings) {}

  Records make() {
    sensors();
    for (const auto& [place, number] : tables_.actuators())
      served(place);
    for (const auto& [ref, number] : tables_.channels())
      channel(ref);
    for (const auto& [place, number] : tables_.actuators())
      actuator(place);
    for (const auto& [place, number] : tables_.groups()) {
      const GroupConfig& config = robot_.groups[place];
      records_.groups.push_back(
          {strings_.offset(config.name.text), 0, tables_.mask_of(config.members)});
    }
    for (const auto& [place, number] : tables_.motion_groups())
      motion_group(program_.motions[place]);
    for (const ir::Motion& one : program_.motions)
      motion(one);
    for (const ir::Verb& verb : tables_.verbs())
      records_.verbs.push_back({strings_.offset(verb.name), verb.action, verb.takes});
    for (const ir::Word& word : tables_.words())
      records_.words.push_back({strings_.offset(word.name), word.param, 0, word.value});
    for (const ir::Variable& one : program_.variables)
      variable(one);
    for (const ir::Check& one : program_.checks)
      check(one);
    if (robot_.scheduler && robot_.scheduler->alpha > 0)
      records_.adaptations.push_back(
          {robot_.scheduler->alpha, robot_.scheduler->window_ms, robot_.scheduler->cap, {}});
    traits();
    return std::move(records_);
  }

private:
  void sensors();
  void served(std::size_t place);
  void servo_chip(const ServoChip& chip);
  void channel(ChannelRef ref);
  void actuator(std::size_t place);
  void variable(const ir::Variable& variable);
  void check(const ir::Check& check);
  void traits();
  void motion_group(const ir::Motion& motion);
  void motion(const ir::Motion& motion);

  const ir::Program& program_;
  const Robot& robot_;
  const Tables& tables_;
  Strings& strings_;
  Records records_;
  std::vector<std::size_t> sensor_places_;                 // by record: the index in Robot::sensors
  std::vector<std::pair<ServoChip, std::uint8_t>> chips_;  // and the index of the record
  std::map<std::size_t, std::uint8_t> displays_;           // by actuator: the index of the record
};

void RecordMaker::sensors() {
  for (const auto& [ref, number] : tables_.channels()) {
    if (sensor_places_.empty() || sensor_places_.back() != ref.sensor) {
      const SensorConfig& sensor = robot_.sensors[ref.sensor];
      records_.sensors.push_back({strings_.offset(sensor.name.text), sensor.driver, sensor.bus,
                                  sensor.address, sensor.period_ms, number, 0, sensor.format, 0});
      sensor_places_.push_back(ref.sensor);
    }
    ++records_.sensors.back().channel_count;
  }
}

// Adds the record of the bus device that drives an actuator: a servo chip or a display.
void RecordMaker::served(std::size_t place) {
  const ActuatorConfig& config = robot_.actuators[place];
  if (config.chip) servo_chip(*config.chip);
  if (!vm::drives_screen(config.driver)) return;
  displays_[place] = static_cast<std::uint8_t>(records_.sensors.size());
  records_.sensors.push_back({strings_.offset("ssd1306"), vm::DriverId::ssd1306, config.bus,
                              config.pin, vm::kDisplayFrameMs,
                              static_cast<std::uint8_t>(tables_.channels().size()), 0, 0, 0});
}

void RecordMaker::servo_chip(const ServoChip& chip) {
  if (std::ranges::find(chips_, chip, [](const auto& known) { return known.first; }) !=
      chips_.end())
    return;
  chips_.emplace_back(chip, static_cast<std::uint8_t>(records_.sensors.size()));
  records_.sensors.push_back(
      {strings_.offset("pca9685"), vm::DriverId::pca9685, chip.bus, chip.address, vm::kServoFrameMs,
       static_cast<std::uint8_t>(tables_.channels().size()), 0, chip.enable, 0});
}

void RecordMaker::channel(ChannelRef ref) {
  const ChannelConfig& config = robot_.sensors[ref.sensor].channels[ref.channel];
  const auto sensor = std::find(sensor_places_.begin(), sensor_places_.end(), ref.sensor);
  vm::Channel record{};
  record.name = strings_.offset(config.name.text);
  record.sensor = static_cast<std::uint8_t>(sensor - sensor_places_.begin());
  record.input = config.input;
  record.dimension = config.unit->dimension;
  record.label_count = static_cast<std::uint8_t>(config.labels.size());
  record.stale_ms = config.stale_ms;
  record.scale_num = config.scale.numerator;
  record.scale_den = config.scale.denominator;
  record.first_label = strings_.row(config.labels);
  record.offset = config.offset;
  record.min = config.min;
  record.max = config.max;
  record.change = config.change;
  records_.channels.push_back(record);
}

// True if AT is the speed of the movement that TO specifies.
bool moves(const ActuatorConfig& config) {
  if (config.to_unit == nullptr || config.at_unit == nullptr) return false;
  using vm::Dimension;
  const Dimension at = config.at_unit->dimension;
  switch (config.to_unit->dimension) {
    case Dimension::angle:
      return at == Dimension::angular_speed;
    case Dimension::length:
      return at == Dimension::speed;
    case Dimension::percent:
      return at == Dimension::percent;
    default:
      return false;
  }
}

// The position must be kept if the actuator moves at a set speed, or if its speed is limited.
bool keeps_its_place(const ActuatorConfig& config, vm::Value speed_limit) {
  return moves(config) && (config.usual_speed > 0 || speed_limit < vm::kValueMax);
}

// TO sets the power, like AT, so the limit applies to its range. The trace then shows the power that is output.
void keep_power(vm::Actuator& record) {
  record.min = std::clamp(record.min, -record.speed_limit, record.speed_limit);
  record.max = std::clamp(record.max, -record.speed_limit, record.speed_limit);
}

void RecordMaker::actuator(std::size_t place) {
  const ActuatorConfig& config = robot_.actuators[place];
  vm::Actuator record{};
  record.name = strings_.offset(config.name.text);
  record.driver = config.driver;
  record.bus = config.bus;
  record.pin = config.pin;
  for (const auto& [chip, sensor] : chips_)
    if (config.chip == chip) record.bus = sensor;
  if (const auto display = displays_.find(place); display != displays_.end()) {
    record.bus = display->second;
    record.pin = 0;
  }
  record.on_release = config.on_release;
  record.safe = config.safe;
  record.verbs = tables_.verbs_of(config, place);
  record.min = config.min;
  record.max = config.max;
  record.speed_limit = config.speed_limit;
  for (const auto& [limited, speed] : program_.speed_limits)
    if (limited == place) record.speed_limit = std::min(record.speed_limit, speed);
  if (config.panel && vm::drives_panel(config.driver)) {
    record.bus = config.panel->lay;
    record.speed_limit = config.panel->color;
  }
  if (config.drive) records_.drive = config.drive;
  if (config.drive && config.encoders)
    for (std::size_t side = 0; side < config.encoders->size(); ++side)
      records_.drive->encoders[side] = static_cast<std::uint8_t>(
          std::ranges::find(sensor_places_, (*config.encoders)[side]) - sensor_places_.begin() + 1);
  if (gets_power(config)) keep_power(record);
  if (config.driver == vm::DriverId::virtual_actuator &&
      keeps_its_place(config, record.speed_limit)) {
    record.driver = vm::DriverId::virtual_motion;
    record.bus = static_cast<std::uint8_t>(config.sweeps ? vm::VirtualMotion::sweeps
                                                         : vm::VirtualMotion::goes);
    record.pin = config.usual_speed;
  }
  records_.actuators.push_back(record);
}

// 0: the usual one, which the image does not have.
std::uint16_t trait_of(const ActuatorConfig& config, vm::TraitKind kind) {
  if (kind == vm::TraitKind::acceleration) return config.acceleration;
  if (!vm::is_servo(config.driver)) return 0;
  const auto end =
      kind == vm::TraitKind::pulse_at_min ? &vm::ServoPulses::at_min : &vm::ServoPulses::at_max;
  return config.pulses.*end == vm::kServoPulses.*end ? 0 : config.pulses.*end;
}

void RecordMaker::traits() {
  if (!robot_.name.empty())
    records_.traits.push_back({strings_.offset(robot_.name), 0, vm::TraitKind::name});
  using vm::TraitKind;
  for (const TraitKind kind :
       {TraitKind::acceleration, TraitKind::pulse_at_min, TraitKind::pulse_at_max})
    for (const auto& [place, number] : tables_.actuators())
      if (const std::uint16_t value = trait_of(robot_.actuators[place], kind); value != 0)
        records_.traits.push_back({value, number, kind});
}

void RecordMaker::variable(const ir::Variable& variable) {
  vm::Variable record{};
  record.name = strings_.offset(variable.name);
  record.kind = variable.kind;
  record.dimension = variable.dimension;
  record.first_label = strings_.row(variable.labels);
  record.label_count = static_cast<std::uint8_t>(variable.labels.size());
  record.initial = variable.initial;
  record.min = variable.min;
  record.max = variable.max;
  record.fades_to = variable.fade != 0 ? variable.fades_to : 0;
  record.fade = variable.fade;
  records_.variables.push_back(record);
}

void RecordMaker::check(const ir::Check& check) {
  vm::Check record{};
  record.variable = static_cast<std::uint8_t>(check.variable);
  record.input = check.input.operation == Operation::input ? tables_.input(check.input.channel)
                                                           : tables_.variable(check.input.index);
  record.first_band = static_cast<std::uint8_t>(records_.bands.size());
  record.band_count = static_cast<std::uint8_t>(check.bands.size());
  record.window = check.window;
  record.sample_ms = check.sample_ms;
  records_.checks.push_back(record);
  records_.bands.insert(records_.bands.end(), check.bands.begin(), check.bands.end());
}

void RecordMaker::motion_group(const ir::Motion& motion) {
  std::vector<std::size_t> actuators;
  for (const ir::Track& track : motion.tracks)
    actuators.push_back(track.actuator);
  records_.groups.push_back({strings_.offset(motion.name), 0, tables_.mask_of(actuators)});
}

void RecordMaker::motion(const ir::Motion& motion) {
  records_.motions.push_back({strings_.offset(motion.name),
                              static_cast<std::uint8_t>(records_.tracks.size()),
                              static_cast<std::uint8_t>(motion.tracks.size()),
                              std::max(motion.length, static_cast<vm::Value>(vm::kMinKeyGapMs))});
  for (const ir::Track& track : motion.tracks) {
    records_.tracks.push_back({tables_.number_of(track.actuator),
                               static_cast<std::uint8_t>(track.keys.size()),
                               static_cast<std::uint16_t>(records_.keys.size())});
    records_.keys.insert(records_.keys.end(), track.keys.begin(), track.keys.end());
  }
}

}  // namespace

Records make_records(const ir::Program& program, const Robot& robot, const Tables& tables,
                     Strings& strings) {
  return RecordMaker(program, robot, tables, strings).make();
}

}  // namespace robosync::compiler
