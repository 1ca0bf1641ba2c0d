// The runtime itself, on the host's kernel and a board that records what is done to it: for tests of
// what a Robot (robot.hpp) does not show.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/pins.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/event_sink.hpp"
#include "runtime-m4/runtime.hpp"
#include "runtime-m4/sim/arena.hpp"

namespace robosync::test {

class NotingPanel final : public boards::PanelOutput {
public:
  void begin(const policy::Panel& panel) override { begun.push_back(panel); }
  void show(std::uint32_t picture) override { pictures.push_back(picture); }
  void end() override { ++ends; }

  std::vector<policy::Panel> begun;     // all
  std::vector<std::uint32_t> pictures;  // all
  unsigned ends = 0;
};

class NotingBoard final : public boards::Board {
public:
  struct Transfer {
    std::uint8_t bus, address;
    std::vector<std::byte> out;
    std::size_t in;
  };

  const char* name() const override { return "noting"; }
  link::ResetReason reset_reason() const override { return link::ResetReason::watchdog; }
  const policy::BoardPins& pins() const override { return board_pins; }
  bool i2c_transfer(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                    std::span<std::byte> in) override {
    transfers.push_back({bus, address, {out.begin(), out.end()}, in.size()});
    if (on_bus) return on_bus(bus, address, out, in);
    if (on_transfer) return on_transfer(out, in);
    for (std::byte& byte : in) {
      if (answers.empty()) return false;
      byte = answers.front();
      answers.pop_front();
    }
    return acknowledges;
  }
  bool spi_transfer(std::uint8_t bus, std::uint16_t select, std::span<const std::byte> out,
                    std::span<std::byte> in) override {
    return on_spi && on_spi(bus, select, out, in);
  }
  void spi_open(std::uint8_t bus, std::uint16_t select) override {
    if (on_spi_pins) on_spi_pins();
    opened.emplace_back(bus, select);
  }
  void spi_close() override {
    if (!opened.empty() && on_spi_pins) on_spi_pins();
    opened.clear();
  }
  bool i2c_select(std::uint8_t bus, std::uint8_t address,
                  std::span<const std::byte> page) override {
    return i2c_transfer(bus, address, page, {});
  }
  boards::BusState buses() const override { return bus_state; }
  unsigned buses_ask_ahead() const override { return asks_ahead; }
  void ask_buses(bool ahead) override { asked_ahead = ahead; }
  bool buses_busy() const override { return busy && busy(); }
  bool input(std::uint16_t pin) const override { return level(pin); }
  void ping(std::uint16_t trigger, std::uint16_t echo) override {
    pings.emplace_back(trigger, echo);
  }
  std::uint32_t take_echo(std::uint16_t echo) override {
    ++takes;
    return echo_us ? echo_us(echo) : 0;
  }
  bool take_edges(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most,
                  boards::Turned& turned) override {
    return edges_of && edges_of(number, a, b, most, turned);
  }
  policy::EncoderCount edges_so_far(unsigned number) override {
    return count_of ? count_of(number) : policy::EncoderCount{};
  }
  void end_edges(unsigned number) override { ended_edges.push_back(number); }
  bool analog(std::uint16_t pin, std::uint16_t& voltage) override {
    const auto found = voltage_of ? voltage_of(pin) : std::nullopt;
    voltage = found.value_or(0);
    return found.has_value();
  }
  bool measure(boards::Part part, std::int32_t& raw) override {
    return measure_of && measure_of(part, raw);
  }
  void listen(bool on) override { listened.push_back(on); }
  bool hear(boards::SoundBlock sound) override { return sound_of && sound_of(sound); }
  void let_go(std::uint16_t pin, boards::Reads what) override {
    if (on_let_go) on_let_go(pin);
    handed.emplace_back(pin, true);
    read[pin] = what;
  }
  void take_back(std::uint16_t pin) override { handed.emplace_back(pin, false); }
  void pwm_write(std::uint16_t pin, std::uint32_t pulse_us) override {
    if (on_pin) on_pin();
    pulses[pin].push_back(pulse_us);
    writes.emplace_back(pin, pulse_us);
  }
  std::uint32_t pwm_read(std::uint16_t pin) const override {
    if (on_pin) on_pin();
    return pulse(pin);
  }
  std::uint32_t pulse(std::uint16_t pin) const {
    const auto found = pulses.find(pin);
    return found == pulses.end() ? 0 : found->second.back();
  }
  void enable(std::uint16_t pin, bool on) override {
    if (on_pin) on_pin();
    enables.emplace_back(pin, on);
    enabled[pin] = on;
  }
  void show(std::uint32_t picture) override { pictures.push_back(picture); }
  void sound(std::uint32_t hertz) override { sounds.push_back(hertz); }
  void say(std::uint8_t line, const policy::PlayerCommand& command) override {
    said.emplace_back(line, command);
  }
  boards::PanelOutput& panel() override { return noting_panel; }
  std::size_t link_write(std::span<const std::byte> bytes) override { return bytes.size(); }
  std::size_t link_read(std::span<std::byte>) override { return 0; }
  void link_start(const boards::LineEvents&) override {}
  void watchdog_start() override { watching = true; }
  void watchdog_kick() override { ++kicks; }
  std::uint32_t watchdog_ms() const override { return first_time_out_ms; }

  std::vector<std::pair<std::uint8_t, policy::PlayerCommand>>
      said;  // to sound players, with the line
  std::vector<Transfer> transfers;
  std::deque<std::byte> answers;  // bytes for the next reads; none left: no acknowledge
  bool acknowledges = true;
  std::function<bool(std::span<const std::byte> out, std::span<std::byte> in)>
      on_transfer;  // answers instead of `answers`
  std::function<bool(std::uint8_t bus, std::uint8_t address, std::span<const std::byte> out,
                     std::span<std::byte> in)>
      on_bus;  // … and instead of on_transfer
  std::function<bool(std::uint8_t bus, std::uint16_t select, std::span<const std::byte> out,
                     std::span<std::byte> in)>
      on_spi;
  std::vector<std::pair<std::uint8_t, std::uint16_t>>
      opened;  // the SPI bus has its pins: select pins
  std::function<void()> on_spi_pins;
  unsigned asks_ahead = 0;  // ticks
  bool asked_ahead = false;
  std::function<bool()> busy;
  boards::BusState bus_state;
  std::function<bool(std::uint16_t pin)> level = [](std::uint16_t) { return true; };  // pulled up
  std::vector<std::pair<std::uint16_t, std::uint16_t>> pings;  // trigger and echo, all
  std::function<std::uint32_t(std::uint16_t echo)> echo_us;
  unsigned takes = 0;
  std::function<bool(unsigned number, std::uint16_t a, std::uint8_t b, unsigned most,
                     boards::Turned& turned)>
      edges_of;
  std::function<policy::EncoderCount(unsigned number)> count_of;
  std::vector<unsigned> ended_edges;  // all
  std::function<std::optional<std::uint16_t>(std::uint16_t pin)> voltage_of;
  std::function<bool(boards::SoundBlock)> sound_of;
  std::vector<bool> listened;  // all
  std::function<bool(boards::Part part, std::int32_t& raw)> measure_of;
  std::function<void(std::uint16_t pin)> on_let_go;
  std::map<std::uint16_t, boards::Reads> read;         // what was last let_go() for
  std::vector<std::pair<std::uint16_t, bool>> handed;  // true: let_go(), false: take_back(); all
  std::map<std::uint16_t, std::vector<std::uint32_t>> pulses;   // all, by pin
  std::vector<std::pair<std::uint16_t, std::uint32_t>> writes;  // the same, in order
  std::vector<std::pair<std::uint16_t, bool>> enables;          // all
  std::map<std::uint16_t, bool> enabled;                        // the last, by pin
  std::function<void()> on_pin;  // before the runtime writes or reads a pin
  policy::BoardPins board_pins = boards::kPins;
  std::vector<std::uint32_t> pictures;  // all
  std::vector<std::uint32_t> sounds;    // all
  NotingPanel noting_panel;
  unsigned kicks = 0;
  std::uint32_t first_time_out_ms = 50;
  bool watching = false;
};

// A servo on pin 7, and, as actuator 1, one without a pin.
inline std::array<vm::Actuator, 2> servo_and(vm::DriverId driver, vm::Release safe) {
  std::array<vm::Actuator, 2> wiring{};
  wiring[0].driver = vm::DriverId::servo;
  wiring[0].pin = 7;
  wiring[0].max = vm::kScale;
  wiring[1].driver = driver;
  wiring[1].safe = safe;
  return wiring;
}

inline bool has_pin(const vm::Actuator& actuator, std::uint16_t pin) {
  return actuator.pin == pin || (vm::has_two_pins(actuator.driver) && actuator.bus == pin);
}

class Rig final : private EventSink {
public:
  explicit Rig(const policy::BoardMemory& memory = boards::kMemory);

  vm::Verdict activate(const std::vector<std::byte>& bytes);
  void run(std::uint64_t until_ms);
  // Does anybody listen to the trace? At first, yes.
  void listen(bool on) { set_listening(on); }
  // Now, in units of the channel.
  link::FeedError feed(std::uint8_t channel, int units, std::uint64_t at_ms = 0);
  link::FeedError feed_raw(std::uint8_t channel, vm::Value thousandths, std::uint64_t at_ms = 0);
  kernel::Thread& thread(std::string_view name);
  link::Status status() const;
  std::string only(std::string_view events) const;

  kernel::Kernel kernel;
  NotingBoard board;
  sim::Arena arena;
  Runtime runtime;
  std::vector<std::string> lines;
  std::function<void()> on_event;  // before it is recorded
  bool concerns_all = false;       // in every step (RuntimePeer)

private:
  void emit(const link::Event& event) override;
};

// The lines of `lines` with one of these events, "fire win command".
std::string select(const std::vector<std::string>& lines, std::string_view events);

}  // namespace robosync::test
