// The host as a board: PWM pins that remember their last pulse, inputs that are never read (a scenario says what sensors
// measure), but for the encoders of a drive, whose wheels it has (policy/virtual_wheels.hpp); no bus, no line, a watchdog that only
// counts. It takes programs for all boards, so every pin may be an input, and every bus exists.
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/pins.hpp"

namespace robosync::sim {

class HostBoard final : public boards::Board {
public:
  const char* name() const override { return "host"; }
  link::ResetReason reset_reason() const override { return link::ResetReason::power; }
  const policy::BoardPins& pins() const override { return kPins; }

  bool i2c_transfer(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                    std::span<std::byte> in) override;
  bool i2c_select(std::uint8_t, std::uint8_t, std::span<const std::byte>) override { return false; }
  boards::BusState buses() const override { return {}; }
  bool input(std::uint16_t) const override { return false; }
  void pwm_write(std::uint16_t pin, std::uint32_t pulse_us) override { pulses_[pin] = pulse_us; }
  std::uint32_t pwm_read(std::uint16_t pin) const override;
  bool take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most,
                  boards::Turned& turned) override;
  void end_edges(unsigned number) override { begun_[number] = false; }
  policy::VirtualWheels* wheels() override { return &wheels_; }

  std::size_t link_write(std::span<const std::byte> bytes) override { return bytes.size(); }
  std::size_t link_read(std::span<std::byte>) override { return 0; }
  void link_start(const boards::LineEvents&) override {}

  void watchdog_start() override {}
  void watchdog_kick() override { ++kicks_; }
  std::uint32_t watchdog_ms() const override { return 50; }
  std::uint64_t kicks() const { return kicks_; }

private:
  static constexpr policy::PinRange kAny[] = {{0, UINT16_MAX}};
  static constexpr policy::BoardPins kPins = {.outputs = boards::kOutputs,
                                              .inputs = kAny,
                                              .echoes = kAny,
                                              .analog = kAny,
                                              .enables = kAny,
                                              .panels = kAny,
                                              .i2c_buses = UINT8_MAX,
                                              .serial_lines = UINT8_MAX,
                                              .spi_buses = UINT8_MAX,
                                              .selects = kAny};

  std::map<std::uint16_t, std::uint32_t> pulses_;
  policy::VirtualWheels wheels_;
  std::array<bool, vm::kMaxEncoders> begun_{};
  std::uint64_t kicks_ = 0;
};

}  // namespace robosync::sim
