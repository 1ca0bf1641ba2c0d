// See output_guard.hpp.
#include "runtime-m4/guard/output_guard.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "runtime-m4/policy/panel.hpp"
#include "runtime-m4/policy/player.hpp"
#include "runtime-m4/policy/pulses.hpp"
#include "vm/drivers.hpp"

namespace robosync::guard {
namespace {

constexpr unsigned kLongestStep = 20;  // ms; a change of pulse covers no more time than this

constexpr OutputGuard::Mask bit(unsigned actuator) {
  return OutputGuard::Mask{1} << actuator;
}

// The limits for channels of servo chips: the pulses of hobby servos.
constexpr policy::PinLimit kOnChips{
    .first = 0,
    .last = vm::kChipChannels - 1,
    .shortest = vm::kServoPulses.at_min,
    .longest = vm::kServoPulses.at_max,
    .rise = 0,
};

// Calls take(actuator) for each actuator of the mask. The loop tests at its end, which is faster.
template <class Take>
[[gnu::always_inline]] inline void each_of(OutputGuard::Mask actuators, Take take) {
  if (actuators == 0) return;
  do {
    take(static_cast<unsigned>(std::countr_zero(actuators)));
    actuators &= actuators - 1;
  } while (actuators != 0);
}

// 0 is off, and always allowed.
std::uint16_t within(const policy::PinLimit& limit, std::uint32_t pulse_us) {
  if (pulse_us == 0) return 0;
  return static_cast<std::uint16_t>(
      std::clamp<std::uint32_t>(pulse_us, limit.shortest, limit.longest));
}

// The actuator's pin or serial line.
constexpr std::uint16_t place_of(const vm::Actuator& actuator) {
  return vm::drives_player(actuator.driver) ? actuator.bus : actuator.pin;
}

bool can_tell(const vm::Actuator& actuator, const policy::BoardPins& pins) {
  if (vm::drives_player(actuator.driver)) return policy::is_line(pins, actuator.bus);
  return boards::kHasPanel && vm::drives_panel(actuator.driver) &&
         policy::is_for_panel(pins, actuator.pin);
}

constexpr bool is_on_panel(vm::DriverId driver) {
  return boards::kHasPanel && vm::drives_panel(driver);
}

}  // namespace

// Does a driver's order reach the actuator?
[[gnu::always_inline]] inline bool OutputGuard::is_free(unsigned actuator) const {
  return (free_ & bit(actuator)) != 0;
}

void OutputGuard::exchange(Slot& slot) {
  std::swap(slot.pin, slot.other);
  std::swap(slot.limit, slot.other_limit);
  slot.second = !slot.second;
}

// Does the program drive the pins of `slot` in the same way? A servo's pulse would be power to a motor.
bool OutputGuard::drives(const vm::Image& image, const Slot& slot) {
  const std::uint16_t first = slot.second ? slot.other : slot.pin;
  const std::uint16_t second = slot.second ? slot.pin : slot.other;
  return vm::any_wired(image, [&](const vm::Actuator& actuator) {
    const std::uint16_t place = place_of(actuator);
    return place == first && actuator.driver == slot.driver &&
           (second == kNoPin || actuator.bus == second);
  });
}

void OutputGuard::listen(bool on) {
  if (boards::kHasMicrophone) board_.listen(on);
}

// Turns off the pins that `next` does not drive in the same way. With SAFETY rules it also turns off power: the rules are not
// evaluated before their readings are known, so nothing would stop a motor meanwhile. A servo's pulses stay, because a servo
// that gets the same pulse does not move. Meanwhile nothing drives any pin, not even to its safe state, because that would be
// the safe state of another actuator.
void OutputGuard::switch_off(const vm::Image* next) {
  Mask owned = 0;
  {
    const auto lock = kernel_.lock();
    owned = std::exchange(owned_, 0);
    free_ = lagging_ = 0;
  }
  if (boards::kHasSpi) board_.spi_close();
  take_back_all_but(next != nullptr ? read_by(*next) : ReadPins{});
  if (lights() != 0) board_.show(0);
  if (speaker() != 0) board_.sound(0);
  switch_chips_off();
  for (Mask left = owned & ~(lights() | speaker() | on_chips_); left != 0; left &= left - 1) {
    const auto actuator = static_cast<unsigned>(std::countr_zero(left));
    end(slots_[actuator], next);
    if (is_drive(actuator)) end(right_wheel_, next);
  }
  lights_ = speaker_ = on_chips_ = drive_ = 0;
  drive_parameters_ = nullptr;
  counts_wheels_ = false;
  if (policy::VirtualWheels* const wheels = board_.wheels()) wheels->end_all();
}

void OutputGuard::end(const Slot& slot, const vm::Image* next) {
  const bool moves = next != nullptr && next->has_safety() && vm::gives_power(slot.driver);
  if (next == nullptr || !drives(*next, slot) || moves) switch_off(slot);
}

void OutputGuard::switch_off(const Slot& slot) {
  if (vm::drives_player(slot.driver)) {
    {
      const auto lock = kernel_.lock();
      ended_player_ = {slot.pin, slot.changed};
    }
    silence_ended_player(kernel_.now());
  } else if (is_on_panel(slot.driver)) {
    board_.panel().show(0);
  } else {
    board_.pwm_write(slot.pin, 0);
  }
}

void OutputGuard::disown() {
  end_measurements();
  listen(false);
  switch_off(nullptr);
  traits_ = {};
}

void OutputGuard::begin_with(Mask halted) {
  const auto lock = kernel_.lock();
  halted_ = halted;
}

// All but those on chips and displays.
OutputGuard::Mask OutputGuard::own_actuators(const vm::Image& image) {
  const policy::BoardPins& pins = board_.pins();
  limits_ = pins.outputs.data();
  traits_ = image.traits;
  Mask owned = 0;
  gradual_ = apart_ = 0;
  for (unsigned a = 0; a < image.actuators.size(); ++a) {
    const vm::Actuator& actuator = image.actuators[a];
    if (boards::kHasLights && vm::drives_lights(actuator.driver)) {
      own_lights(a, actuator.safe);
      owned |= bit(a);
    }
    if (boards::kHasSpeaker && vm::drives_speaker(actuator.driver)) owned |= speaker_ = bit(a);
    if (can_tell(actuator, pins)) {
      own_told(a, actuator);
      owned |= bit(a);
    }
    if (vm::drives_wheels(actuator.driver) && own_wheels(a, image)) owned |= bit(a);
    if (!vm::drives_pin(actuator.driver) || !policy::can_drive(actuator, pins)) continue;
    slots_[a] = slot_of(actuator, pulses_of(a));
    owned |= bit(a);
    if (limits_[slots_[a].limit].rise != 0) gradual_ |= bit(a);
    if (slots_[a].safe == kStays) apart_ |= bit(a);
  }
  return owned;
}

void OutputGuard::own(const vm::Image& image) {
  switch_off(&image);
  if (boards::kHasPanel) free_panel_pin(image);
  if (boards::kHasSpi) open_spi(image);
  Mask owned = own_actuators(image);
  own_chips(image);
  own_displays(image);
  owned |= on_chips_;
  apart_ |= on_chips_;
  let_go_of(read_by(image));
  listen(std::ranges::any_of(
      image.sensors, [](const vm::Sensor& sensor) { return vm::is_microphone(sensor.driver); }));
  {
    const auto lock = kernel_.lock();
    sensors_ = image.sensors;
    owned_ = owned;
    free_ = owned & ~halted_;
  }
  make_halted_safe(kernel_.now());
}

// For a new program: its halted actuators did not own their pins yet when they were halted. Lights and speaker are off.
void OutputGuard::make_halted_safe(kernel::Time now) {
  for (Mask left = owned_ & ~(lights() | speaker() | on_chips_); left != 0; left &= left - 1) {
    const auto actuator = static_cast<unsigned>(std::countr_zero(left));
    const auto lock = kernel_.lock();
    if ((halted_ & bit(actuator)) != 0) make_safe(actuator, now);
  }
}

// The pins of `actuator` must be outputs of the board.
OutputGuard::Slot OutputGuard::slot_of(const vm::Actuator& actuator, vm::ServoPulses pulses) const {
  const policy::PinLimit& limit = *policy::limit_of(board_.pins(), actuator.pin);
  const auto pulse = static_cast<std::uint16_t>(board_.pwm_read(actuator.pin));
  const auto safe = policy::safe_pulse(actuator, pulses);
  const auto place = static_cast<std::uint8_t>(&limit - limits_);
  Slot slot{.pin = actuator.pin,
            .other = kNoPin,
            .pulse = pulse,
            .target = pulse,
            .changed = 0,
            .safe = safe ? within(limit, *safe) : kStays,
            .limit = place,
            .other_limit = place,
            .second = false,
            .driver = actuator.driver};
  if (!vm::has_two_pins(actuator.driver)) return slot;
  slot.other = actuator.bus;
  slot.other_limit =
      static_cast<std::uint8_t>(policy::limit_of(board_.pins(), actuator.bus) - limits_);
  const auto back = static_cast<std::uint16_t>(board_.pwm_read(actuator.bus));
  if (back == 0) return slot;
  exchange(slot);
  slot.pulse = slot.target = back;
  return slot;
}

// The image must be verified. A halt treats a drive apart, because it has two motors.
bool OutputGuard::own_wheels(unsigned actuator, const vm::Image& image) {
  const vm::Actuator& drive = image.actuators[actuator];
  const vm::DriveParameters parameters = vm::drive_of(image.constants.data() + drive.pin);
  if (!policy::can_drive(drive, parameters, board_.pins())) return false;
  slots_[actuator] = slot_of(vm::motor_of(drive, parameters, vm::Side::left));
  right_wheel_ = slot_of(vm::motor_of(drive, parameters, vm::Side::right));
  drive_ = bit(actuator);
  drive_parameters_ = image.constants.data() + drive.pin;
  own_encoders(image, drive, parameters);
  apart_ |= bit(actuator);
  return true;
}

void OutputGuard::own_lights(unsigned actuator, vm::Release safe) {
  lights_ = bit(actuator);
  lights_stay_ = safe == vm::Release::hold;
}

void OutputGuard::show(unsigned actuator, std::uint32_t picture) {
  const auto lock = kernel_.lock();
  if (!is_free(actuator)) return;
  if ((lights() & bit(actuator)) != 0) return board_.show(picture);
  const vm::DriverId driver = slots_[actuator].driver;
  if (boards::kHasPanel && vm::is_strip(driver)) picture = policy::limited_color(picture);
  if (is_on_panel(driver) && picture != on_panel_) {
    on_panel_ = picture;
    lagging_ |= bit(actuator);
  }
  for (Display& display : std::span(displays_).first(display_count_))
    if (display.actuator == actuator) display.picture = picture;
}

void OutputGuard::sound(unsigned actuator, std::uint32_t hertz) {
  const auto lock = kernel_.lock();
  if ((free_ & speaker() & bit(actuator)) != 0) board_.sound(hertz);
}

void OutputGuard::play(unsigned actuator, std::uint16_t sound) {
  const auto lock = kernel_.lock();
  Slot& slot = slots_[actuator];
  if (!is_free(actuator) || !vm::drives_player(slot.driver)) return;
  slot.target = sound;
  lagging_ |= bit(actuator);
}

[[gnu::noinline]] void OutputGuard::drive(unsigned actuator, std::uint32_t pulse_us,
                                          kernel::Time now) {
  const auto lock = kernel_.lock();
  if (!is_free(actuator)) return;
  Slot& slot = slots_[actuator];
  if (is_on_chip(actuator)) {
    slot.pulse = (limp_ & bit(actuator)) != 0 ? std::uint16_t{0} : within(kOnChips, pulse_us);
    return;
  }
  settle(slot, actuator, within(limits_[slot.limit], pulse_us), now);
}

[[gnu::noinline]] void OutputGuard::drive_either(unsigned actuator, std::int32_t pulse_us,
                                                 kernel::Time now) {
  const auto lock = kernel_.lock();
  if (!is_free(actuator) || is_on_chip(actuator)) return;
  Slot& slot = slots_[actuator];
  const bool second = pulse_us < 0;
  std::uint32_t length = static_cast<std::uint32_t>(pulse_us);
  if (second) length = 0 - length;
  if (slot.other == kNoPin && second) length = 0;
  if (length != 0 && second != slot.second) turn(slot, actuator, now);
  settle(slot, actuator, within(limits_[slot.limit], length), now);
}

// Changes to the other pin, after turning this one off.
void OutputGuard::change_pin(Slot& slot, kernel::Time now) {
  board_.pwm_write(slot.pin, 0);
  exchange(slot);
  slot.pulse = 0;
  slot.changed = static_cast<std::uint16_t>(now / 1000);
}

void OutputGuard::turn(Slot& slot, unsigned actuator, kernel::Time now) {
  change_pin(slot, now);
  limits_[slot.limit].rise != 0 ? gradual_ |= bit(actuator) : gradual_ &= ~bit(actuator);
}

// `pulse` must be within the limits.
[[gnu::always_inline]] inline void OutputGuard::settle(Slot& slot, unsigned actuator,
                                                       std::uint16_t pulse, kernel::Time now) {
  slot.target = pulse;
  if ((gradual_ & bit(actuator)) != 0) [[unlikely]]
    return put(actuator, now);
  slot.pulse = pulse;
  board_.pwm_write(slot.pin, pulse);
}

[[gnu::always_inline]] inline bool OutputGuard::is_drive(unsigned actuator) const {
  return (drive_ & bit(actuator)) != 0;
}

[[gnu::noinline]] void OutputGuard::drive_wheels(unsigned actuator, std::int32_t left_us,
                                                 std::int32_t right_us, kernel::Time now) {
  const auto lock = kernel_.lock();
  if (!is_free(actuator) || !is_drive(actuator)) return;
  aim_wheel(slots_[actuator], left_us, now);
  aim_wheel(right_wheel_, right_us, now);
  put_wheels(actuator, now);
}

// Negative: on the second pin.
void OutputGuard::aim_wheel(Slot& wheel, std::int32_t pulse_us, kernel::Time now) {
  const bool second = pulse_us < 0;
  const auto length = static_cast<std::uint32_t>(pulse_us);
  if (pulse_us != 0 && second != wheel.second) change_pin(wheel, now);
  wheel.target = within(limits_[wheel.limit], second ? 0 - length : length);
}

void OutputGuard::put_wheels(unsigned actuator, kernel::Time now) {
  lagging_ &= ~bit(actuator);
  for (Slot* const wheel : {&slots_[actuator], &right_wheel_}) {
    const std::uint16_t rise = limits_[wheel->limit].rise;
    wheel->pulse = rise == 0 ? wheel->target : next_pulse(*wheel, rise, false, now);
    if (wheel->pulse != wheel->target) lagging_ |= bit(actuator);
    board_.pwm_write(wheel->pin, wheel->pulse);
  }
  if (counts_wheels_) turn_virtual_wheels(actuator, static_cast<std::uint32_t>(now));
}

void OutputGuard::go_on(kernel::Time now) {
  if (boards::kHasSerialLine && ended_player_) silence_ended_player(now);
  for (Mask left = lagging_; left != 0; left &= left - 1) {
    const auto actuator = static_cast<unsigned>(std::countr_zero(left));
    if (vm::is_told(slots_[actuator].driver)) {
      tell(actuator, now);
    } else {
      const auto lock = kernel_.lock();
      is_drive(actuator) ? put_wheels(actuator, now) : put(actuator, now);
    }
  }
}

// Moves the pulse as far towards its target as the time since the last write allows. Not for a drive.
[[gnu::noinline]] void OutputGuard::put(unsigned actuator, kernel::Time now) {
  Slot& slot = slots_[actuator];
  const policy::PinLimit& limit = limits_[slot.limit];
  slot.pulse = next_pulse(slot, limit.rise, limit.shortest != 0, now);
  slot.pulse == slot.target ? lagging_ &= ~bit(actuator) : lagging_ |= bit(actuator);
  board_.pwm_write(slot.pin, slot.pulse);
}

// Power may fall immediately. Servo pulses may stop immediately, and start anywhere, because the position is unknown then.
std::uint16_t OutputGuard::next_pulse(Slot& slot, std::uint16_t rise, bool pulses,
                                      kernel::Time now) const {
  const auto at = static_cast<std::uint16_t>(now / 1000);
  const unsigned passed = static_cast<std::uint16_t>(at - slot.changed);
  const unsigned most = rise * std::min(passed, kLongestStep);
  slot.changed = at;
  const unsigned pulse = slot.pulse;
  const unsigned target = slot.target;
  const bool at_once = pulses ? target == 0 || pulse == 0 : target <= pulse;
  if (at_once) return slot.target;
  if (target > pulse) return static_cast<std::uint16_t>(std::min(target, pulse + most));
  return static_cast<std::uint16_t>(std::max(target, pulse - std::min(pulse, most)));
}

// Sets the mask first: from then on no driver can undo what follows. The lock only holds off thread switches, so it delays no
// thread that outranks the safety thread, which is the one that halts several actuators in one call.
[[gnu::noinline]] void OutputGuard::halt(Mask actuators) {
  const auto lock = kernel_.lock();
  const Mask fresh = actuators & owned_ & ~halted_;
  halted_ |= actuators;
  free_ = owned_ & ~halted_;
  if ((fresh & lights()) != 0 && !lights_stay_) board_.show(0);
  if ((fresh & speaker()) != 0) board_.sound(0);
  const Mask pins = fresh & ~(lights() | speaker());
  const Mask others = pins & (gradual_ | apart_);
  each_of(pins & ~others, [&](unsigned actuator) { shut(slots_[actuator]); });
  if (others != 0) [[unlikely]]
    make_all_safe(others, kernel_.now());
}

// For an actuator whose safe state is a pulse, and whose pulse may change immediately: so its target is its pulse. A pin that is
// off stays off.
[[gnu::always_inline]] inline void OutputGuard::shut(Slot& slot) {
  if (slot.pulse == 0) return;
  slot.pulse = slot.target = slot.safe;
  board_.pwm_write(slot.pin, slot.safe);
}

[[gnu::noinline]] void OutputGuard::make_all_safe(Mask actuators, kernel::Time now) {
  if ((actuators & on_chips_) != 0) halt_chips(actuators);
  each_of(actuators & ~on_chips_, [&](unsigned actuator) { make_safe(actuator, now); });
}

void OutputGuard::make_safe(unsigned actuator, kernel::Time now) {
  Slot& slot = slots_[actuator];
  if (vm::is_told(slot.driver)) {
    if (slot.safe == kStays) return;
    slot.target = 0;
    if (is_on_panel(slot.driver)) on_panel_ = 0;
    lagging_ |= bit(actuator);
    return;
  }
  if (is_drive(actuator)) {
    slot.target = right_wheel_.target = 0;
    return put_wheels(actuator, now);
  }
  if (slot.safe != kStays && slot.pulse != 0) return settle(slot, actuator, slot.safe, now);
  slot.target = slot.pulse;
  lagging_ &= ~bit(actuator);
}

// --- chips ---

[[gnu::always_inline]] inline bool OutputGuard::is_on_chip(unsigned actuator) const {
  return (on_chips_ & bit(actuator)) != 0;
}

// The image must be verified and fit the board. The state of its chips is unknown, so they are off.
void OutputGuard::own_chips(const vm::Image& image) {
  for (unsigned s = 0; s < image.sensors.size() && chip_count_ < chips_.size(); ++s) {
    const vm::Sensor& sensor = image.sensors[s];
    if (!vm::is_servo_chip(sensor.driver) || !policy::is_enable(board_.pins(), sensor.first_input))
      continue;
    Chip chip{.enable = sensor.first_input,
              .sensor = static_cast<std::uint8_t>(s),
              .on = false,
              .known = false,
              .holds = false,
              .actuators = 0};
    for (unsigned a = 0; a < image.actuators.size(); ++a) {
      const vm::Actuator& actuator = image.actuators[a];
      if (!vm::drives_channel(actuator.driver) || actuator.bus != s) continue;
      slots_[a] = {};
      slots_[a].pin = actuator.pin;
      chip.holds = actuator.safe == vm::Release::hold;
      chip.actuators |= bit(a);
    }
    on_chips_ |= chip.actuators;
    chips_[chip_count_++] = chip;
  }
}

template <class Guard>
auto* OutputGuard::chip_of(Guard& guard, unsigned sensor) {
  auto* chip = guard.chips_.data();
  for (unsigned left = guard.chip_count_; left != 0; --left, ++chip)
    if (chip->sensor == sensor) return chip;
  return static_cast<decltype(chip)>(nullptr);
}

// Each servo of the chip stays off until its next order.
void OutputGuard::switch_chip_off(Chip& chip) {
  board_.enable(chip.enable, false);
  chip.on = false;
  limp_ |= chip.actuators;
  for (Mask left = chip.actuators; left != 0; left &= left - 1)
    slots_[static_cast<unsigned>(std::countr_zero(left))].pulse = 0;
}

// Turns off the chips of a program that ends.
void OutputGuard::switch_chips_off() {
  const auto lock = kernel_.lock();
  for (unsigned c = 0; c < chip_count_; ++c)
    board_.enable(chips_[c].enable, false);
  chip_count_ = display_count_ = 0;
  limp_ = 0;
}

// An order that a halt refuses must not let the servo move after the halt.
void OutputGuard::begin_order(unsigned actuator) {
  const auto lock = kernel_.lock();
  if (is_free(actuator)) limp_ &= ~bit(actuator);
}

// All servos of a chip go limp, because it has one enable pin; unless they hold.
[[gnu::noinline]] void OutputGuard::halt_chips(Mask fresh) {
  for (Chip& chip : std::span(chips_).first(chip_count_)) {
    if ((chip.actuators & fresh) == 0) continue;
    chip.holds ? hold(chip, chip.actuators & fresh) : switch_chip_off(chip);
  }
  for (Display& display : std::span(displays_).first(display_count_))
    if ((fresh & bit(display.actuator)) != 0 && !display.holds) display.picture = 0;
}

// They keep the pulses that the chip gives. One without a pulse must not begin to move: it stays off until its next order.
void OutputGuard::hold(const Chip& chip, Mask servos) {
  each_of(servos, [&](unsigned actuator) {
    Slot& slot = slots_[actuator];
    slot.pulse = chip.on ? slot.target : std::uint16_t{0};
    if (slot.pulse == 0) limp_ |= bit(actuator);
  });
}

bool OutputGuard::knows_chip(unsigned sensor) const {
  const auto lock = kernel_.lock();
  const Chip* const chip = chip_of(*this, sensor);
  return chip != nullptr && chip->known;
}

void OutputGuard::lose_chip(unsigned sensor) {
  const auto lock = kernel_.lock();
  Chip* const chip = chip_of(*this, sensor);
  if (chip == nullptr) return;
  chip->known = false;
  switch_chip_off(*chip);
}

void OutputGuard::note_chip_set_up(unsigned sensor) {
  const auto lock = kernel_.lock();
  Chip* const chip = chip_of(*this, sensor);
  if (chip == nullptr) return;
  chip->known = true;
  for (Mask left = chip->actuators; left != 0; left &= left - 1)
    slots_[static_cast<unsigned>(std::countr_zero(left))].target = 0;
}

bool OutputGuard::next_setpoint(unsigned sensor, unsigned from, Setpoint& setpoint) const {
  const auto lock = kernel_.lock();
  const Chip* const chip = chip_of(*this, sensor);
  if (chip == nullptr) return false;
  for (Mask left = chip->actuators; left != 0; left &= left - 1) {
    const auto actuator = static_cast<unsigned>(std::countr_zero(left));
    const Slot& slot = slots_[actuator];
    if (actuator < from || slot.pulse == slot.target) continue;
    setpoint = {.actuator = static_cast<std::uint8_t>(actuator),
                .channel = static_cast<std::uint8_t>(slot.pin),
                .pulse = slot.pulse};
    return true;
  }
  return false;
}

// A servo that was told to hold meanwhile holds there.
void OutputGuard::note_setpoint(const Setpoint& setpoint) {
  const auto lock = kernel_.lock();
  if (setpoint.actuator >= slots_.size() || !is_on_chip(setpoint.actuator)) return;
  Slot& slot = slots_[setpoint.actuator];
  slot.target = setpoint.pulse;
  if (!is_free(setpoint.actuator) && slot.pulse != 0) slot.pulse = setpoint.pulse;
}

// A halt may have changed setpoints after the chip got them. Then the chip stays off until it has the new ones.
void OutputGuard::let_chip_on(unsigned sensor) {
  const auto lock = kernel_.lock();
  Chip* const chip = chip_of(*this, sensor);
  if (chip == nullptr || chip->on || !chip->known) return;
  if (!chip->holds && (chip->actuators & halted_) != 0) return;
  bool driven = false;
  for (Mask left = chip->actuators; left != 0; left &= left - 1) {
    const Slot& slot = slots_[static_cast<unsigned>(std::countr_zero(left))];
    if (slot.pulse != slot.target) return;
    driven = driven || slot.pulse != 0;
  }
  if (!driven) return;
  board_.enable(chip->enable, true);
  chip->on = true;
}

// --- devices that are told their orders: players and the panel ---

// It is unknown what the device plays or shows: it is told to be silent or dark, unless an order comes first.
void OutputGuard::own_told(unsigned actuator, const vm::Actuator& wiring) {
  const auto now = static_cast<std::uint16_t>(kernel_.now() / 1000);
  Slot& slot = slots_[actuator];
  slot = {};
  slot.pin = place_of(wiring);
  slot.other = kNoPin;
  slot.changed = now;
  slot.safe = wiring.safe == vm::Release::hold ? kStays : std::uint16_t{0};
  slot.driver = wiring.driver;
  if (is_on_panel(wiring.driver)) {
    panel_pin_ = wiring.pin;
    on_panel_ = 0;
    board_.panel().begin(policy::panel_of(wiring));
  } else {
    const auto lock = kernel_.lock();
    ended_player_.reset();
  }
  lagging_ |= bit(actuator);
  apart_ |= bit(actuator);
}

// Sends the order, unless the device still needs time after the previous one. Sending a picture takes long, so no lock is held
// meanwhile. That is safe: the safety thread calls this, and nothing that preempts it changes the picture.
[[gnu::noinline]] void OutputGuard::tell(unsigned actuator, kernel::Time now) {
  Slot& slot = slots_[actuator];
  const bool panel = is_on_panel(slot.driver);
  if (needs_time(slot.changed, panel ? policy::kPanelGapMs : policy::kPlayerGapMs, now)) return;
  {
    const auto lock = kernel_.lock();
    slot.changed = static_cast<std::uint16_t>(now / 1000);
    lagging_ &= ~bit(actuator);
    if (!panel) return say(slot.pin, slot.target);
  }
  board_.panel().show(on_panel_);
}

void OutputGuard::say(std::uint16_t player, std::uint16_t sound) {
  board_.say(static_cast<std::uint8_t>(player), policy::player_command(sound));
}

void OutputGuard::silence_ended_player(kernel::Time now) {
  const auto lock = kernel_.lock();
  if (!ended_player_ || needs_time(ended_player_->told, policy::kPlayerGapMs, now)) return;
  say(ended_player_->pin, 0);
  ended_player_.reset();
}

// If the next program has another use for the panel's pin, the panel's picture goes too: something else is wired there.
void OutputGuard::free_panel_pin(const vm::Image& next) {
  if (panel_pin_ == kNoPin) return;
  const bool of_bus = policy::uses_spi(next) && policy::is_in(board_.pins().spi_pins, panel_pin_);
  if (!of_bus && !policy::uses_pin(next, panel_pin_)) return;
  board_.panel().end();
  panel_pin_ = kNoPin;
}

void OutputGuard::let_go(Mask actuators) {
  const auto lock = kernel_.lock();
  halted_ &= ~actuators;
  free_ = owned_ & ~halted_;
}

}  // namespace robosync::guard
