// The output guard: the only code that drives an output of the board (tests/structure enforces that). It is between the
// drivers and the pins, runs privileged, and trusts neither image nor driver:
//
// * A pin is driven only for an actuator of the running program. All other pins are off.
// * No pulse leaves the range that the board gives its pin, or changes faster than the board allows (Board::pins()). 0, which
//   is off, is always allowed.
// * An actuator that is halted goes to its safe state immediately, without its driver, and takes no order until it is released.
//   A pin that is off stays off: a failure never makes anything start to move.
//
// A motor on an H-bridge has two pins. At most one of them is on: it goes off before the other one goes on.
// A drive has two such motors, which get their power together and are halted together.
//
// The lights of a board are guarded in the same way. The actuator that shows a picture owns them. They go dark when the program
// ends, and with a halt unless the safe state is to hold. The speaker of a board goes silent in both cases, whatever its safe
// state.
//
// The trigger pins of sensors are outputs too: a pulse of some microseconds, for a sensor of the running program. A halt does not
// prevent it, because it moves nothing and SAFETY reads the result.
//
// An SPI bus has its pins while the running program has a part there, and so does each of the parts its select pin: they may be
// outputs, or inputs, of other programs. A halt does not concern them. The board accepts no image that has another use for them.
//
// A pin that can be an output or an analog input is released while the running program has an analog sensor there, and low
// otherwise. The board accepts no image that both measures and drives such a pin.
//
// Servos on a chip get their pulses from the chip, over a bus that the guard never uses. The chip's server
// (drivers/servo_chip.hpp) asks the guard for the pulses of the channels. The guard drives only the chip's enable pin, which
// turns all its pulses off immediately:
//
// * It is off until the chip has been set up and has all its pulses. It goes off with a halt of one of its servos (unless their
//   safe state is to hold), with the program, and when the state of the chip is no longer known.
// * It does not go on while such a halt lasts. After it went off, each servo of the chip stays off until it gets another order.
//   So does a servo that would hold, but gets no pulse from the chip yet when it is halted.
//
// A display shows a picture, which its server (drivers/screen.hpp) gets from the guard in the same way. It shows a halt in its
// next frame, some 50 ms later, which harms nobody.
//
// A sound player gets its order on its serial line at the next check of the safety monitor, and the order to be silent in a halt,
// whatever its safe state. Commands are spaced by the time that the player needs (policy/player.hpp), also after its program has
// ended. Only the latest order counts.
//
// A panel of lights gets its picture in the same way, and goes dark like the lights of a board. It keeps its pin; if a later
// program has another use for the pin, the pin is taken from the panel first.
//
// A check and its write are one critical section under the kernel's lock, so a thread that is preempted never writes an outdated
// value later. docs/safety.md lists the guarantees.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/features.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/policy/travel.hpp"
#include "vm/drive.hpp"
#include "vm/drivers.hpp"
#include "vm/image.hpp"

namespace robosync::guard {

// The encoders of a drive, and its driver's progress by them. Only the driver uses it; reset with each program.
struct CountedDrive {
  vm::WheelEncoders encoders{};
  policy::Travel travel;
  policy::EncoderCounts counts{};
  std::array<std::int16_t, 2> pulses{};  // of its wheels, without what travel takes from them
  std::int8_t heading = 0;               // how its way counts: 1 or -1; 0: it turns
};

class OutputGuard {
public:
  using Mask = std::uint32_t;  // one bit for each actuator

  OutputGuard(kernel::Kernel& kernel, boards::Board& board) : kernel_(kernel), board_(board) {}

  // Before the next program begins: these of its actuators are halted from its start, and those that halt() names
  // from now on.
  void begin_with(Mask halted);
  // Gives the actuators of `image` their pins; the image is verified and fits the board. Halted actuators go to their
  // safe states. Pins that were driven in another way before, or that no actuator has, go off.
  void own(const vm::Image& image);
  // When there is no program: all pins go off.
  void disown();

  // Pulse on the actuator's pin, in microseconds of the 20 ms frame; 0: off.
  void drive(unsigned actuator, std::uint32_t pulse_us, kernel::Time now);
  // A servo on a chip has a new order: if it went limp, it may be driven again.
  void begin_order(unsigned actuator);
  // Pulse of an actuator with two pins: on the first pin if positive, on the second if negative.
  void drive_either(unsigned actuator, std::int32_t pulse_us, kernel::Time now);
  // Pulses of the two motors of a drive, each as for drive_either().
  void drive_wheels(unsigned actuator, std::int32_t left_us, std::int32_t right_us,
                    kernel::Time now);
  // The parameters of the drive, in the running program's image; null: it has no drive.
  [[nodiscard]] const vm::Value* drive_parameters() const { return drive_parameters_; }
  // Null: the running program has no drive with encoders.
  [[nodiscard]] CountedDrive* counted_drive() { return counts_wheels_ ? &counted_drive_ : nullptr; }
  // Puts into it what these encoders have counted.
  void count_wheels(kernel::Time now);
  // What the program's encoder `number`, which is this sensor, has counted (boards::Board::take_edges()), with what its virtual
  // wheel has turned.
  [[nodiscard]] bool take_edges(const vm::Sensor& sensor, unsigned number, kernel::Time time,
                                boards::Turned& turned);
  // The pulses of an actuator of the running program, a servo, at the ends of its range.
  [[nodiscard]] vm::ServoPulses pulses_of(unsigned actuator) const {
    return vm::pulses_of(traits_, actuator);
  }
  // The picture on the lights (boards::Board::show()), or on the actuator's display or panel; for a strip, its colour.
  void show(unsigned actuator, std::uint32_t picture);
  // The tone of the speaker (boards::Board::sound()).
  void sound(unsigned actuator, std::uint32_t hertz);
  // The number of the sound that the player on the actuator's line plays, from 1; 0: none.
  void play(unsigned actuator, std::uint16_t sound);
  // A pulse on the trigger pin of a sensor (boards::Board::ping()).
  void ping(unsigned sensor);

  // --- for the server of the servo chip that is this sensor of the image; no effect for other sensors ---
  // Has the chip been set up, and is the state of its channels known?
  [[nodiscard]] bool knows_chip(unsigned sensor) const;
  // The state of the chip is unknown, and it may not obey: turns it off.
  void lose_chip(unsigned sensor);
  // The chip has been set up: all its channels are off.
  void note_chip_set_up(unsigned sensor);
  struct Setpoint {
    std::uint8_t actuator;
    std::uint8_t channel;
    std::uint16_t pulse;  // microseconds, 0: off
  };
  // The first setpoint, from actuator number `from` on, that the chip does not have yet. False: there is none.
  [[nodiscard]] bool next_setpoint(unsigned sensor, unsigned from, Setpoint& setpoint) const;
  // The chip has this setpoint.
  void note_setpoint(const Setpoint& setpoint);
  // The chip is ready to give its pulses: turns it on if it has all its setpoints and no halt forbids it.
  void let_chip_on(unsigned sensor);

  // --- for the server of the display that is this sensor of the image (drivers/screen.hpp) ---
  // The picture for the display (boards::Board::show()); 0 for another sensor.
  [[nodiscard]] std::uint32_t picture_on(unsigned sensor) const;
  // The server's progress. Only the server uses it; reset with each program. Null if the sensor is no display.
  struct Screen {
    std::uint64_t stale = 0;    // bit 5 * page + column of the picture: out of date on the display
    std::uint32_t picture = 0;  // the latest picture for the display
    std::uint8_t portion = 0;   // the next one of the round
    bool whole = false;         // a round has been completed
  };
  [[nodiscard]] Screen* screen_of(unsigned sensor);

  // Ends all measurements; none begins until own(). Call it before the running program's image is overwritten, which
  // says where they are.
  void end_measurements();
  // Moves pulses on that have not reached their target, and tells devices their orders. Called at each check of the
  // safety monitor.
  void go_on(kernel::Time now);

  void halt(Mask actuators);
  void let_go(Mask actuators);

private:
  // With two pins, `pin` is the one that is on, or was last; the other one is off. For a device that is told its orders
  // (vm::is_told()), `pin` is its line or pin, `target` its sound, and `changed` the time of the latest command.
  struct Slot {
    std::uint16_t pin;
    std::uint16_t other;    // kNoPin: it has one pin
    std::uint16_t pulse;    // on the pin now
    std::uint16_t target;   // the pulse moves towards it as fast as it may
    std::uint16_t changed;  // time of the latest write, in ms; for pins with a limited rise
    std::uint16_t safe;     // pulse of the safe state, within the limits, or kStays
    std::uint8_t limit;     // index in the board's list
    std::uint8_t other_limit;
    bool second;  // `pin` is the second one
    vm::DriverId driver;
  };

  struct Chip {
    std::uint16_t enable;  // pin
    std::uint8_t sensor;   // in the image
    bool on, known, holds;
    Mask actuators;
  };

  struct Display {
    Screen screen;
    std::uint32_t picture;
    std::uint8_t sensor;  // in the image
    std::uint8_t actuator;
    bool holds;
  };

  static constexpr std::uint16_t kStays = UINT16_MAX;
  static constexpr std::uint16_t kNoPin = UINT16_MAX;

  using Pins = std::uint32_t;  // bit p: pin p
  // Pins that a program reads, and others may drive.
  struct ReadPins {
    Pins voltages = 0, levels = 0;
    Pins all() const { return voltages | levels; }
  };

  void settle(Slot& slot, unsigned actuator, std::uint16_t pulse, kernel::Time now);
  void put(unsigned actuator, kernel::Time now);
  void shut(Slot& slot);
  void make_safe(unsigned actuator, kernel::Time now);
  void make_all_safe(Mask actuators, kernel::Time now);
  void make_halted_safe(kernel::Time now);
  std::uint16_t next_pulse(Slot& slot, std::uint16_t rise, bool pulses, kernel::Time now) const;
  [[nodiscard]] bool is_free(unsigned actuator) const;
  static void exchange(Slot& slot);
  void change_pin(Slot& slot, kernel::Time now);
  void turn(Slot& slot, unsigned actuator, kernel::Time now);
  [[nodiscard]] bool is_drive(unsigned actuator) const;
  void aim_wheel(Slot& wheel, std::int32_t pulse_us, kernel::Time now);
  void put_wheels(unsigned actuator, kernel::Time now);
  void own_encoders(const vm::Image& image, const vm::Actuator& drive,
                    const vm::DriveParameters& parameters);
  void turn_virtual_wheels(unsigned actuator, std::uint32_t now);
  void own_told(unsigned actuator, const vm::Actuator& wiring);
  void tell(unsigned actuator, kernel::Time now);
  void say(std::uint16_t player, std::uint16_t sound);
  void free_panel_pin(const vm::Image& next);
  void switch_off(const Slot& slot);
  // `told`: when the device got its last order, in ms.
  static bool needs_time(std::uint16_t told, std::uint16_t gap, kernel::Time now) {
    return static_cast<std::uint16_t>(now / 1000 - told) < gap;
  }
  void silence_ended_player(kernel::Time now);
  [[nodiscard]] Slot slot_of(const vm::Actuator& actuator, vm::ServoPulses pulses = {}) const;
  static bool drives(const vm::Image& image, const Slot& slot);
  [[nodiscard]] ReadPins read_by(const vm::Image& image) const;
  void take_back_all_but(const ReadPins& read);
  void let_go_of(const ReadPins& read);
  void let_go_of(Pins pins, boards::Reads what);
  void listen(bool on);
  void open_spi(const vm::Image& image);
  void switch_off(const vm::Image* next);
  void end(const Slot& slot, const vm::Image* next);
  [[nodiscard]] bool own_wheels(unsigned actuator, const vm::Image& image);
  void own_lights(unsigned actuator, vm::Release safe);
  [[nodiscard]] Mask own_actuators(const vm::Image& image);
  void own_chips(const vm::Image& image);
  void own_displays(const vm::Image& image);
  // Null if the sensor is no servo chip.
  template <class Guard>
  [[nodiscard]] static auto* chip_of(Guard& guard, unsigned sensor);
  void switch_chip_off(Chip& chip);
  void switch_chips_off();
  void halt_chips(Mask fresh);
  void hold(const Chip& chip, Mask servos);
  [[nodiscard]] bool is_on_chip(unsigned actuator) const;
  // The actuator that owns the lights, if any.
  Mask lights() const { return boards::kHasLights ? lights_ : 0; }
  // The one that owns the speaker.
  Mask speaker() const { return boards::kHasSpeaker ? speaker_ : 0; }

  kernel::Kernel& kernel_;
  boards::Board& board_;
  const policy::PinLimit* limits_ = nullptr;
  std::span<const vm::Sensor> sensors_;  // of the running program
  std::span<const vm::Trait> traits_;    // likewise
  ReadPins let_go_;                      // the program reads them, so nothing drives them
  Mask owned_ = 0;
  Mask halted_ = 0;
  Mask free_ = 0;     // owned, and not halted
  Mask gradual_ = 0;  // their pulse may only change gradually
  Mask apart_ =
      0;  // a halt does not write one pulse to a pin: they keep theirs, are on a chip or a line, or have two motors
  Mask lagging_ = 0;  // not yet at their target, or not told their order yet
  Mask lights_ = 0;
  Mask speaker_ = 0;
  // In their slots, `pin` is the channel, and `target` the pulse that the chip has. Displays count as chips; their slots are
  // empty.
  Mask on_chips_ = 0;
  Mask drive_ = 0;      // has two motors: its slot is the left one's
  Slot right_wheel_{};  // of the drive
  const vm::Value* drive_parameters_ = nullptr;
  bool counts_wheels_ = false;
  CountedDrive counted_drive_;
  Mask limp_ = 0;             // on chips, off until their next orders
  bool lights_stay_ = false;  // on in the safe state
  std::uint8_t chip_count_ = 0;
  std::array<Chip, vm::kMaxServoChips> chips_{};
  std::array<Slot, vm::kMaxActuators> slots_{};
  std::array<Display, vm::kMaxDisplays> displays_{};
  std::uint8_t display_count_ = 0;
  // Its program has ended, and it has not been told yet to be silent. A board has one line (boards/pins.hpp).
  struct EndedPlayer {
    std::uint16_t pin, told;  // when, in ms
  };
  std::optional<EndedPlayer> ended_player_;
  std::uint16_t panel_pin_ = kNoPin;  // of the board's panel; kept after its program has ended
  std::uint32_t on_panel_ = 0;        // the picture for the panel
};

}  // namespace robosync::guard
