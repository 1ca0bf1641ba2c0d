// How sensors and actuators are connected: types, buses, addresses and pins.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/config/boards.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/robot.hpp"

namespace robosync::compiler {

struct Device;
struct SpecialPins;

struct WiringType {
  std::string_view name;
  bool for_sensors, for_actuators;
  bool bus, address, pin;  // the keys that it has
};
[[nodiscard]] std::span<const WiringType> wiring_types();
// For messages.

// Reads the "type" of a sensor or actuator. Reports a missing or wrong one and returns null.
[[nodiscard]] const WiringType* read_type(Fields& fields, bool is_sensor, Diagnostics& diagnostics);

struct Wiring {
  // Of a sensor of type GPIO: vm::ActiveLevel, its trigger pin, or the second pin of an encoder. Of an actuator with two pins: the second one.
  std::uint8_t bus = 0;
  std::uint16_t place = 0;  // I2C address or pin
};

// A servo on a chip.
struct ChipWiring {
  std::optional<ServoChip> chip;  // nullopt: its keys are wrong or incomplete
  std::uint16_t channel = 0;
};

// The keys that say how it is wired, such as "bus" and "address"; empty: it has none.
[[nodiscard]] std::span<const std::string_view> keys_of_wiring(const Device& device);
// They and its addresses in words: "`bus` and `address`, `0x68 to 0x69`".
[[nodiscard]] std::string wiring_of(const Device& device);

// Reads the buses, addresses and pins of one robot on `board`; each pin may be used once.
class WiringReader {
public:
  WiringReader(Board board, Diagnostics& diagnostics)
      : board_(std::move(board)), diagnostics_(diagnostics) {}
  // `part`: the part of the board, which has its own wiring; or null.
  [[nodiscard]] Wiring read_sensor(Fields& fields, const WiringType& type, const Board::Part* part,
                                   vm::DriverId driver);
  [[nodiscard]] Wiring read_actuator(Fields& fields, const WiringType& type,
                                     const Board::Part* part, vm::DriverId driver);
  [[nodiscard]] ChipWiring read_chip(Fields& fields);
  // A display's bus, which the board must have, and its address, which nothing else may use.
  [[nodiscard]] Wiring read_display(Fields& fields, const WiringType& type);
  // The two pins of a motor of a drive, `[4, 5]`; `side` is its key. nullopt: they are wrong.
  [[nodiscard]] std::optional<std::array<std::uint8_t, 2>> read_motor(const json::Value& value,
                                                                      std::string_view side);
  // Of a differential drive: a robot has at most one. Reports keys that it cannot have.
  void take_drive(const Fields& fields, const WiringType& type);
  // All servos of a chip must have the same safe state. `span`: where `safe` is set, or else the entry.
  void check_safe(const ServoChip& chip, vm::Release safe, Span span);
  // For drivers that use them: checks that the board has them.
  void check_bus(const Fields& fields, const Wiring& wiring);
  // Of a part on SPI: its bus, whose pins the first such part takes, and its select pin.
  void check_spi(const Fields& fields, const Wiring& wiring);
  // Of a device on I2C: no part of the board has its address for itself.
  void check_address(const Fields& fields, const Wiring& wiring);
  // Its address is one that its pins can select; otherwise this is reported, and the result false.
  bool check_own_address(const Fields& fields, const Wiring& wiring, const Device& device);
  // A sensor or actuator without a driver is virtual, but what its wiring names must exist.
  void check_without_driver(const Fields& fields, const WiringType& type, const Wiring& wiring);
  // Of what puts a voltage on pins of the board: `usual`, if its entry does not say `volts`; 0: that of the board.
  void check_volts(const Fields& fields, vm::Value usual);
  void check_input(const Fields& fields, const Wiring& wiring);
  void check_echo(const Fields& fields, const Wiring& wiring);
  // Of an encoder; a robot has at most vm::kMaxEncoders.
  void check_encoder(const Fields& fields, const Wiring& wiring);
  void check_analog(const Fields& fields, const Wiring& wiring);
  // For a sound player.
  void check_line(const Fields& fields, const Wiring& wiring);
  void check_output(const Fields& fields, const Wiring& wiring, vm::DriverId driver);
  // For a panel or strip of lights. A robot has at most one.
  void check_panel(const Fields& fields, const Wiring& wiring);
  // For lights, speakers and sensors that can only be parts of a board.
  void check_part(const Fields& fields, const Board::Part* part);
  // A microphone and the analog inputs use the same converter, so a robot has either. Reported once.
  void check_converter(const Fields& fields, bool microphone);
  // When all have been read: a pin that is wrong for one of them is not also used twice.
  void report_pins_used_twice();
  [[nodiscard]] const Board& board() const { return board_; }

private:
  struct OnBus {
    Span span;
    bool alone = false;              // no second sensor may use the address
    const Device* device = nullptr;  // its chip: no other one may use the address
    std::optional<ServoChip> chip{};
    Span enable{};
    std::map<std::uint16_t, Span> channels{};  // used by servos
    std::optional<vm::Release> safe{};
    Span safe_span{};
  };

  [[nodiscard]] Wiring read(Fields& fields, const WiringType& type, const Board::Part* part,
                            bool two_pins, const std::string& what);
  [[nodiscard]] Wiring read_part(const Fields& fields, const Board::Part& part);
  void take_address(const Fields& fields, const Wiring& place, const Board::Part* part, bool alone);
  [[nodiscard]] std::string owner_on_board(const Fields& fields, const Wiring& wiring,
                                           Span address) const;
  void report_taken(const OnBus& known, const Wiring& place, Span span);
  void report_same(const OnBus& known, const Wiring& place, Span span);
  void take_chip(const ServoChip& chip, const json::Value& address, const json::Value& enable);
  void refuse_pins(const Fields& fields);
  void take_channel(const ServoChip& chip, std::uint16_t channel, Span span);
  void check_bus(const Fields& fields, const Wiring& wiring, const char* kind, std::uint32_t buses);
  std::uint16_t read_pin(const json::Value& value, std::uint16_t last = UINT16_MAX - 1);
  void read_pins(Fields& fields, bool two, const std::string& what, Wiring& wiring);
  Wiring read_echo(Fields& fields, const std::string& what);
  Wiring read_encoder(Fields& fields, const WiringType& type);
  std::uint8_t read_active(const Fields& fields);
  void take_pin(std::uint16_t pin, Span span);
  void take_part(const Board::Part& part, Span span);
  void report_foreign(const Fields& fields, const WiringType& type);
  // `those`: the pins of the board for this use.
  void check_special(const json::Value& value, std::uint16_t pin,
                     std::span<const Board::Pins> those, const SpecialPins& use);
  void check_output_pin(const json::Value& value, std::uint16_t pin, bool power);
  void report_no_pin(const json::Value& value, std::uint16_t pin, const std::string& is_no,
                     const std::string& those_are, std::span<const Board::Pins> those);

  Board board_;
  Diagnostics& diagnostics_;
  struct UsedTwice {
    std::uint16_t pin;
    Span span, first;
  };
  std::map<std::uint16_t, Span> pins_;
  std::vector<UsedTwice> pins_twice_;
  std::map<std::uint8_t, Span> lines_;
  unsigned encoders_ = 0;
  std::optional<Span> panel_, drive_;
  bool on_spi_ = false;                                               // a part has been read
  std::optional<Span> microphone_, analog_;                           // the first ones
  std::map<const Board::Part*, Span> parts_;                          // without a pin
  std::map<std::pair<std::uint8_t, std::uint16_t>, OnBus> on_buses_;  // by bus and address
};

// The index of a string in `names`, ignoring case; otherwise reports E0205 with the choices.
[[nodiscard]] std::optional<std::size_t> read_choice(const json::Value& value,
                                                     std::span<const std::string_view> names,
                                                     Diagnostics& diagnostics);
[[nodiscard]] std::optional<vm::Release> read_release(const json::Value& value,
                                                      Diagnostics& diagnostics);

// The unit of an actuator's parameter; that of `verb` if it has its own.
[[nodiscard]] const Unit& param_unit(const ActuatorConfig& actuator, vm::Param param,
                                     const VerbConfig* verb = nullptr);

}  // namespace robosync::compiler
