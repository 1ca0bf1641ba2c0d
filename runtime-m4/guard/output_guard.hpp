// The output guard: the only code that drives an output of the board (tests/structure holds everybody to that). It
// stands between the drivers and the pins, with privileges, and believes neither image nor driver:
//
// * A pin is driven only for an actuator of the running program. All others are off.
// * No pulse leaves the range that the board gives its pin, nor changes faster (Board::pins()); 0, which is off,
//   always may.
// * An actuator that is halted goes to its safe state at once, without its driver, and takes no order until it is let
//   go. A pin that is off stays off: nothing begins to move because something is wrong.
//
// A motor on an H-bridge has two pins. At most one of them is on: before the other one is, it goes off.
//
// The lights of a board that has some are kept in the same way: who shows a picture owns them, they go dark with a halt
// unless its safe state is to hold, and with the program. The speaker of one that has it is silent then, whatever its safe
// state.
//
// The trigger pins of sensors are outputs, too: a pulse of some microseconds, for a sensor of the running program, which no halt
// holds back, for nothing moves by it and SAFETY reads what comes of it.
//
// A pin that can be an output and an analog input is let go while the running program has an analog sensor there, and low
// otherwise. No image that the board takes drives such a pin, too.
//
// Servos on a chip get their pulses from it, over a bus that the guard never uses: who serves the chip
// (drivers/servo_chip.hpp) asks for what may stand on its channels. What the guard has is the chip's enable pin, and that
// takes all its pulses away at once:
//
// * It is off until the chip has been set up and has all pulses that it shall have, and goes off with a halt of one of its
//   servos (unless they hold in their safe state), with the program, and when nobody knows any more what stands on the chip.
// * It does not go on while such a halt lasts; and what went off stays off, of all its servos, until each gets another order.
//
// A display shows a picture, which its server (drivers/screen.hpp) asks for in the same way. Of a halt it comes to know in its
// next frame, some 50 ms later: nobody is hurt by that.
//
// A sound player is told on its serial line what to play, at the next check of the safety monitor, and silence in a halt, whatever
// its safe state; between two commands there is the time that it needs (policy/player.hpp). Only the last order counts.
//
// A panel of lights is told its picture in the same way, and goes dark as the lights of a board do. Its pin is its own; a program
// that drives it otherwise takes it from the panel first.
//
// A check and its write are one under the kernel's lock: who is interrupted in between writes nothing old later.
// docs/safety.md says what follows from that.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/features.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "vm/drivers.hpp"
#include "vm/image.hpp"

namespace robosync::guard {

class OutputGuard {
public:
  using Mask = std::uint32_t;  // one bit for each actuator

  OutputGuard(kernel::Kernel& kernel, boards::Board& board) : kernel_(kernel), board_(board) {}

  // Another program comes: these of its actuators are halted from its first moment, besides those that halt() names
  // from now on.
  void begin_with(Mask halted);
  // The actuators of `image`, which is verified and fits the board, own their pins from now on; those that are halted
  // go to their safe states. A pin that was driven in another way before, or that none of them has, goes off.
  void own(const vm::Image& image);
  // There is no program: all pins go off.
  void disown();

  // Pulse on the actuator's pin, in microseconds of the 20 ms frame; 0: off.
  void drive(unsigned actuator, std::uint32_t pulse_us, kernel::Time now);
  // A servo on a chip has a new order: it may be driven again, if it went limp.
  void begin_order(unsigned actuator);
  // … of one that has two pins: on its first one, or where it is negative, so long on its second one.
  void drive_either(unsigned actuator, std::int32_t pulse_us, kernel::Time now);
  // The picture on the lights (boards::Board::show()), or on the actuator's display or panel.
  void show(unsigned actuator, std::uint32_t picture);
  // The tone of the speaker (boards::Board::sound()).
  void sound(unsigned actuator, std::uint32_t hertz);
  // The sound that the player on the actuator's line is to play, from 1 on; 0: none.
  void play(unsigned actuator, std::uint16_t sound);
  // A pulse on the trigger pin of a sensor (boards::Board::ping()).
  void ping(unsigned sensor);

  // --- for who serves the servo chip that is this sensor of the image; of another one: nothing ---
  // Has it been set up, and does everybody know what stands on its channels?
  [[nodiscard]] bool knows_chip(unsigned sensor) const;
  // Nobody knows what stands on it, nor that it will do as it is told: off.
  void lose_chip(unsigned sensor);
  // It has just been set up: all its channels are off.
  void note_chip_set_up(unsigned sensor);
  struct Setpoint {
    std::uint8_t actuator;
    std::uint8_t channel;
    std::uint16_t pulse;  // microseconds, 0: off
  };
  // The first one from actuator number `from` on that the chip does not have yet. False: there is none.
  [[nodiscard]] bool next_setpoint(unsigned sensor, unsigned from, Setpoint& setpoint) const;
  // The chip has it.
  void note_setpoint(const Setpoint& setpoint);
  // It has all it shall have, and its pulses come: on, if they may.
  void let_chip_on(unsigned sensor);

  // --- for who serves the display that is this sensor of the image (drivers/screen.hpp) ---
  // What it shall show (boards::Board::show()); of another sensor: 0.
  [[nodiscard]] std::uint32_t picture_on(unsigned sensor) const;
  // How far it has come. The server's own, and new with each program; null: the sensor is none.
  struct Screen {
    std::uint64_t stale = 0;  // bit 5 * page + column of the picture: it shows something old there
    std::uint32_t picture = 0;  // that it was last to show
    std::uint8_t portion = 0;   // the next one of the round
    bool whole = false;         // it has been through a round
  };
  [[nodiscard]] Screen* screen_of(unsigned sensor);

  // No measurement goes on, and none begins until own(): before the running program's image is overwritten, which says
  // where they are.
  void end_measurements();
  // Pins whose pulse may not yet be where it shall go on. Called at each check of the safety monitor.
  void go_on(kernel::Time now);

  void halt(Mask actuators);
  void let_go(Mask actuators);

private:
  // Of two pins, `pin` is the one that is on, or was last; the other one is off. Of what is told (vm::is_told()), `pin` is its
  // line or pin, `target` the sound that it shall play, and `changed` when it was told something last.
  struct Slot {
    std::uint16_t pin;
    std::uint16_t other;    // kNoPin: it has one
    std::uint16_t pulse;    // what is on the pin
    std::uint16_t target;   // where it goes, as far as it may
    std::uint16_t changed;  // when it was written last, in ms; of pins with a limited rise
    std::uint16_t safe;     // the pulse of the safe state, inside the limits, or kStays
    std::uint8_t limit;     // in the board's list
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

  using Pins = std::uint64_t;  // bit p: pin p

  void settle(Slot& slot, unsigned actuator, std::uint16_t pulse, kernel::Time now);
  void put(unsigned actuator, kernel::Time now);
  void shut(Slot& slot);
  void make_safe(unsigned actuator, kernel::Time now);
  void make_all_safe(Mask actuators, kernel::Time now);
  void make_halted_safe(kernel::Time now);
  std::uint16_t next_pulse(Slot& slot, std::uint16_t rise, bool pulses, kernel::Time now) const;
  [[nodiscard]] bool is_free(unsigned actuator) const;
  static void exchange(Slot& slot);
  void turn(Slot& slot, unsigned actuator, kernel::Time now);
  void own_told(unsigned actuator, const vm::Actuator& wiring);
  void tell(unsigned actuator, kernel::Time now);
  void say(const Slot& player, std::uint16_t sound);
  void free_panel_pin(const vm::Image& next);
  void switch_off(const Slot& slot);
  [[nodiscard]] Slot slot_of(const vm::Actuator& actuator, const policy::BoardPins& pins) const;
  static bool drives(const vm::Image& image, const Slot& slot);
  [[nodiscard]] Pins measured_by(const vm::Image& image) const;
  void take_back_all_but(Pins measured);
  void let_go_of(Pins measured);
  void switch_off(const vm::Image* next);
  void own_lights(unsigned actuator, vm::Release safe);
  void own_chips(const vm::Image& image);
  void own_displays(const vm::Image& image);
  // Null: the sensor is none.
  template <class Guard>
  [[nodiscard]] static auto* chip_of(Guard& guard, unsigned sensor);
  void switch_chip_off(Chip& chip);
  void switch_chips_off();
  void halt_chips(Mask fresh);
  [[nodiscard]] bool is_on_chip(unsigned actuator) const;
  // The actuator that has the lights, if any.
  Mask lights() const { return boards::kHasLights ? lights_ : 0; }
  // … and the speaker.
  Mask speaker() const { return boards::kHasSpeaker ? speaker_ : 0; }

  kernel::Kernel& kernel_;
  boards::Board& board_;
  const policy::PinLimit* limits_ = nullptr;
  std::span<const vm::Sensor> sensors_;  // of the running program
  Pins let_go_ = 0;                      // it measures them, and nothing drives them
  Mask owned_ = 0;
  Mask halted_ = 0;
  Mask free_ = 0;     // owned, and not halted
  Mask gradual_ = 0;  // whose pulse may not change at once
  Mask apart_ =
      0;  // for which a halt is more than a pulse on a pin: they stay as they are, or are on a chip or a line
  Mask lagging_ = 0;  // … and is not yet where it shall be; or who was not told yet
  Mask lights_ = 0;
  Mask speaker_ = 0;
  // Of their slots: `pin` is the channel, `target` is what the chip has. Displays count as chips; their slots are empty.
  Mask on_chips_ = 0;
  Mask limp_ = 0;             // … that wait for their next orders
  bool lights_stay_ = false;  // in the safe state
  std::uint8_t chip_count_ = 0;
  std::array<Chip, vm::kMaxServoChips> chips_{};
  std::array<Slot, vm::kMaxActuators> slots_{};
  std::array<Display, vm::kMaxDisplays> displays_{};
  std::uint8_t display_count_ = 0;
  std::uint16_t panel_pin_ = kNoPin;  // the board's panel has it, also when its program has gone
  std::uint32_t on_panel_ = 0;        // the picture that it shall show
};

}  // namespace robosync::guard
