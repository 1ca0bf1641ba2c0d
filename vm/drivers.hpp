// What the verifier, the board and rsc must know of a driver, from vm/drivers.def.
#pragma once

#include <cstdint>

#include "vm/image.hpp"

namespace robosync::vm {

// What an actuator's driver puts out on its pin. Pulses say where to go: while they stay as they are, so does the
// actuator. A level is power: as long as it is there, a motor runs. A picture and tones are on no pin of an actuator's own,
// but on the lights and the speaker, which a board has once. Either way: a level on its pin or on a second one, which the
// image has as its `bus`; the other pin is off then. Channel: pulses, by a servo chip, which the image has among its sensors, as
// it is a device on a bus: `bus` says where, `pin` is the chip's channel. Screen: a picture, on a display, which is among the
// sensors in the same way. Line: commands to a sound player, on a serial line of the board, which the image has as the `bus`.
// Panel: a picture, on lights in a chain at its pin, of which a robot has one.
enum class PinUse : std::uint8_t {
  nothing,
  pulses,
  level,
  picture,
  tones,
  either_way,
  channel,
  screen,
  line,
  panel
};

constexpr PinUse pin_use(DriverId driver) {
  switch (driver) {
#define SENSOR_DRIVER(name, ...) \
  case DriverId::name:           \
    return PinUse::nothing;
#define ACTUATOR_DRIVER(name, start, advance, release, ends, output, doc) \
  case DriverId::name:                                                    \
    return PinUse::output;
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER
    case DriverId::count_:
      break;
  }
  return PinUse::nothing;
}

constexpr bool has_two_pins(DriverId driver) {
  return pin_use(driver) == PinUse::either_way;
}
// What runs as long as its pin is on.
constexpr bool gives_power(DriverId driver) {
  return pin_use(driver) == PinUse::level || has_two_pins(driver);
}
constexpr bool drives_pin(DriverId driver) {
  return pin_use(driver) == PinUse::pulses || gives_power(driver);
}
constexpr bool drives_lights(DriverId driver) {
  return pin_use(driver) == PinUse::picture;
}
constexpr bool drives_speaker(DriverId driver) {
  return pin_use(driver) == PinUse::tones;
}
constexpr bool drives_channel(DriverId driver) {
  return pin_use(driver) == PinUse::channel;
}
constexpr bool drives_screen(DriverId driver) {
  return pin_use(driver) == PinUse::screen;
}
// Of the serial lines 0 is the link's.
inline constexpr std::uint8_t kFirstPlayerLine = 1;
constexpr bool drives_player(DriverId driver) {
  return pin_use(driver) == PinUse::line;
}
constexpr bool drives_panel(DriverId driver) {
  return pin_use(driver) == PinUse::panel;
}
// What gets its orders in messages, each of which takes its time.
constexpr bool is_told(DriverId driver) {
  return drives_player(driver) || drives_panel(driver);
}
// What goes on by itself as long as nobody ends it: it cannot be held in a halt.
constexpr bool drives_on(DriverId driver) {
  return gives_power(driver) || drives_speaker(driver) || drives_player(driver);
}

// By what a driver's sensors are measured; nothing: they are fed, or it has no sensors. Echo: a pulse on an output, which the
// image has as the sensor's `bus`, and how long its input is high then. Adc: the voltage of an analog input.
enum class Bus : std::uint8_t { nothing, i2c, pin, echo, adc };

struct Sampling {
  Bus bus = Bus::nothing;
  bool once = false;  // all channels of a sensor are made of the same answers of its device
};

constexpr Sampling sampling_of(DriverId driver) {
  const auto fed = [] { return Sampling{}; };
  const auto computed = [] { return Sampling{}; };
  const auto i2c = [](unsigned, unsigned) { return Sampling{Bus::i2c}; };
  const auto i2c_once = [](unsigned, unsigned) { return Sampling{Bus::i2c, true}; };
  const auto pin = [] { return Sampling{Bus::pin}; };
  const auto echo = [] { return Sampling{Bus::echo}; };
  const auto adc = [] { return Sampling{Bus::adc}; };
  switch (driver) {
#define SENSOR_DRIVER(name, sample, doc) \
  case DriverId::name:                   \
    return sample;
#define ACTUATOR_DRIVER(name, ...) \
  case DriverId::name:             \
    return Sampling{};
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER
    case DriverId::count_:
      break;
  }
  return Sampling{};
}

constexpr Bus bus_of(DriverId driver) {
  return sampling_of(driver).bus;
}
constexpr bool is_asked_once(DriverId driver) {
  return sampling_of(driver).once;
}

// No sensor's driver is taken for that of an actuator next to it in the list, nor the other way round.
#define SENSOR_DRIVER(name, ...) static_assert(pin_use(DriverId::name) == PinUse::nothing);
#define ACTUATOR_DRIVER(name, ...) static_assert(bus_of(DriverId::name) == Bus::nothing);
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER

constexpr bool is_on_i2c(DriverId driver) {
  return bus_of(driver) == Bus::i2c;
}
constexpr bool is_on_pin(DriverId driver) {
  return bus_of(driver) == Bus::pin;
}

constexpr bool is_by_echo(DriverId driver) {
  return bus_of(driver) == Bus::echo;
}
constexpr bool is_analog(DriverId driver) {
  return bus_of(driver) == Bus::adc;
}
// It measures once, for a while, when a sample tells it to, and may find nothing.
constexpr bool measures_when_told(DriverId driver) {
  return driver == DriverId::vl53l0x;
}
// It says nothing when nothing answers: what it measured last grows old.
constexpr bool may_be_silent(DriverId driver) {
  return is_on_i2c(driver) || is_by_echo(driver) || is_analog(driver);
}

// A chip that gives servos their pulses. It has no channels of readings: it is among the sensors so that its bus has one user
// at a time, and that whether it answers is told. `first_input` is the pin of the board at its OE input.
constexpr bool is_servo_chip(DriverId driver) {
  return driver == DriverId::pca9685;
}
// A display: it stands there for the same reasons.
constexpr bool is_display(DriverId driver) {
  return driver == DriverId::ssd1306;
}
// What is told something in each of its frames, and asked for nothing.
constexpr bool is_served(DriverId driver) {
  return is_servo_chip(driver) || is_display(driver);
}
inline constexpr unsigned kMaxDisplays = 2;  // of a program
inline constexpr std::uint16_t kDisplayFrameMs = 50;
// Where its pin SA0 can put an SSD1306 (Solomon Systech SSD1306 Rev. 1.1, 8.1.5).
inline constexpr std::uint16_t kFirstDisplayAddress = 0x3C;
inline constexpr std::uint16_t kLastDisplayAddress = 0x3D;
inline constexpr unsigned kChipChannels = 16;
inline constexpr unsigned kMaxServoChips = 4;  // of a program
inline constexpr std::uint16_t kServoFrameMs = 20;
// Where the six address pins of a PCA9685 can put it (NXP PCA9685 Rev. 4, 7.1.1); at 0x70 all of them answer at power-up (7.1.3).
inline constexpr std::uint16_t kFirstChipAddress = 0x40;
inline constexpr std::uint16_t kAllChipsAddress = 0x70;

// The echoes of one burst must have died away before the next one.
inline constexpr std::uint16_t kMinEchoPeriodMs = 60;
// A VL53L0X takes some 33 ms from one result to the next, and has some more for that.
inline constexpr std::uint16_t kMinRangingPeriodMs = 50;

// Who is sampled more often than that gets no readings; 0: nobody is.
constexpr std::uint16_t min_period_ms(DriverId driver) {
  if (is_by_echo(driver)) return kMinEchoPeriodMs;
  return measures_when_told(driver) ? kMinRangingPeriodMs : 0;
}

// Of a panel `bus` says how its lights lie, and `speed_limit` the colour of a lit one, 0xRRGGBB, of which no part is more than
// kMostLight: 25 lights of white take 0.3 A then, which a board gets by USB, and not 1.5.
inline constexpr std::uint8_t kPanelGoesBack = 1;  // each second row is wired from right to left
inline constexpr std::uint8_t kPanelIsLarge =
    2;  // 8 x 8 lights, with the picture in their midst; else 5 x 5
inline constexpr unsigned kMostLight = 51;  // of 255
constexpr bool is_panel(std::uint8_t lay, Value color) {
  if (lay > (kPanelGoesBack | kPanelIsLarge) || color < 0 || color > 0xFF'FFFF) return false;
  for (unsigned part = 0; part < 24; part += 8)
    if ((static_cast<std::uint32_t>(color) >> part & 0xFF) > kMostLight) return false;
  return true;
}

// Others are reserved by the I2C specification.
inline constexpr std::uint16_t kFirstAddress = 0x08;
inline constexpr std::uint16_t kLastAddress = 0x77;

}  // namespace robosync::vm
