// How sensors and actuators are connected: types, buses, addresses and pins.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "compiler/config/boards.hpp"
#include "compiler/config/fields.hpp"
#include "compiler/config/robot.hpp"

namespace robosync::compiler {

struct WiringType {
  std::string_view name;
  bool for_sensors, for_actuators;
  bool bus, address, pin;  // which of these keys it has
};
[[nodiscard]] std::span<const WiringType> wiring_types();

// The "type" of a sensor or actuator. Reports and gives nothing when it is missing or wrong.
[[nodiscard]] const WiringType* read_type(Fields& fields, bool is_sensor, Diagnostics& diagnostics);

struct Wiring {
  std::uint8_t bus = 0;
  std::uint16_t place = 0;  // I2C address or pin
};

// Reads buses, addresses and pins of one robot, which has `board`; a pin may be used once.
class WiringReader {
public:
  WiringReader(Board board, Diagnostics& diagnostics)
      : board_(std::move(board)), diagnostics_(diagnostics) {}
  [[nodiscard]] Wiring read(Fields& fields, const WiringType& type, bool is_sensor);
  // For those whose driver uses them: the board must have them.
  void check_bus(const Fields& fields, const Wiring& wiring);
  void check_output(const Fields& fields, const Wiring& wiring);

private:
  std::uint16_t read_pin(const json::Value& value);
  void report_foreign(const Fields& fields, const WiringType& type);

  Board board_;
  Diagnostics& diagnostics_;
  std::map<std::uint16_t, Span> pins_;
};

// Which of `names` a string is, any case; reports E0205 with the choice when none.
[[nodiscard]] std::optional<std::size_t> read_choice(const json::Value& value,
                                                     std::span<const std::string_view> names,
                                                     Diagnostics& diagnostics);
[[nodiscard]] std::optional<vm::Release> read_release(const json::Value& value,
                                                      Diagnostics& diagnostics);

// The unit in which an actuator understands a parameter, of `verb` if it has one of its own.
[[nodiscard]] const Unit& param_unit(const ActuatorConfig& actuator, vm::Param param,
                                     const VerbConfig* verb = nullptr);

}  // namespace robosync::compiler
