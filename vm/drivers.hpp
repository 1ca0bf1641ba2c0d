// What the verifier, the board and rsc need to know about a driver, from vm/drivers.def.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vm/image.hpp"

namespace robosync::vm {

// The output of an actuator's driver.
//   pulses      give a position: while they stay the same, the actuator stays where it is
//   level       is power: a motor runs as long as it is on
//   picture, tones   go to the lights and the speaker, of which a board has one each, not to a pin of the actuator
//   either_way  a level on its pin or on a second one, the image's `bus`; the other pin is off then
//   channel     pulses from a servo chip, which is among the image's sensors because it is a device on a bus: `bus` is its index
//               there, `pin` the chip's channel
//   screen      a picture on a display, which is among the sensors in the same way
//   line        commands to a sound player on a serial line of the board, the image's `bus`
//   panel       a picture, or a colour, on a chain of lights at its pin; a robot has one panel
//   wheels      the power of two motors, each like either_way; a robot has one such drive, and vm/drive.hpp says where its image
//               has the pins
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
  panel,
  wheels
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
// It runs as long as its pin is on.
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
constexpr bool is_servo(DriverId driver) {
  return pin_use(driver) == PinUse::pulses || drives_channel(driver);
}
// Serial line 0 is the link's.
inline constexpr std::uint8_t kFirstPlayerLine = 1;
constexpr bool drives_player(DriverId driver) {
  return pin_use(driver) == PinUse::line;
}
constexpr bool drives_panel(DriverId driver) {
  return pin_use(driver) == PinUse::panel;
}
// All lights of a strip have the same colour; it shows no pictures.
constexpr bool is_strip(DriverId driver) {
  return driver == DriverId::ws2812_strip;
}
constexpr bool shows_pictures_on_a_panel(DriverId driver) {
  return drives_panel(driver) && !is_strip(driver);
}
constexpr bool drives_wheels(DriverId driver) {
  return pin_use(driver) == PinUse::wheels;
}
// It gets its orders in messages, and each message takes time.
constexpr bool is_told(DriverId driver) {
  return drives_player(driver) || drives_panel(driver);
}
// It continues on its own until it is ended, so it cannot hold in a halt.
constexpr bool drives_on(DriverId driver) {
  return gives_power(driver) || drives_speaker(driver) || drives_player(driver) ||
         drives_wheels(driver);
}

// How a driver's sensors are measured; nothing: they are fed, or it has no sensors. Echo: a pulse on an output, the sensor's
// `bus` in the image, and how long its input is high after that. Adc: the voltage of an analog input. Sound: the board's
// microphone. Spi: a transfer while its select pin, `address` in the image, is low. Part: another part of the board. Edges: those of
// an input, `address` in the image, are counted; its `bus` is a second input, whose level gives the direction, or kNoSecondPin.
enum class Bus : std::uint8_t { nothing, i2c, pin, echo, adc, sound, spi, part, edges };

struct Sampling {
  Bus bus = Bus::nothing;
  bool once = false;  // all channels of a sensor come from the same transfers
};

constexpr Sampling sampling_of(DriverId driver) {
  const auto fed = [] { return Sampling{}; };
  const auto computed = [] { return Sampling{}; };
  const auto i2c = [](unsigned, unsigned) { return Sampling{Bus::i2c}; };
  const auto i2c_once = [](unsigned, unsigned) { return Sampling{Bus::i2c, true}; };
  const auto spi = [](unsigned) { return Sampling{Bus::spi}; };
  const auto pin = [] { return Sampling{Bus::pin}; };
  const auto echo = [] { return Sampling{Bus::echo}; };
  const auto adc = [] { return Sampling{Bus::adc}; };
  const auto sound = [] { return Sampling{Bus::sound, true}; };
  const auto part = [] { return Sampling{Bus::part}; };
  const auto edges = [] { return Sampling{Bus::edges}; };
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

// A sensor's driver must not be taken for that of an actuator, or the other way round.
#define SENSOR_DRIVER(name, ...) static_assert(pin_use(DriverId::name) == PinUse::nothing);
#define ACTUATOR_DRIVER(name, ...) static_assert(bus_of(DriverId::name) == Bus::nothing);
#include "vm/drivers.def"
#undef SENSOR_DRIVER
#undef ACTUATOR_DRIVER

constexpr bool is_on_i2c(DriverId driver) {
  return bus_of(driver) == Bus::i2c;
}
constexpr bool is_on_spi(DriverId driver) {
  return bus_of(driver) == Bus::spi;
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
constexpr bool counts_edges(DriverId driver) {
  return bus_of(driver) == Bus::edges;
}
// Its `address` is a pin that is its own.
constexpr bool reads_pin(DriverId driver) {
  return is_on_pin(driver) || is_by_echo(driver) || is_analog(driver) || counts_edges(driver);
}
inline constexpr std::uint8_t kNoSecondPin = UINT8_MAX;
constexpr bool has_second_input(const Sensor& sensor) {
  return counts_edges(sensor.driver) && sensor.bus != kNoSecondPin;
}
// It has a position and a speed, also if a command says none: it can have a limit of acceleration.
constexpr bool moves_at_a_speed(const Actuator& actuator) {
  if (actuator.driver == DriverId::virtual_motion) return actuator.pin != 0;
  return is_servo(actuator.driver);
}
// The inputs of a microphone from here on are its spectrum, which costs something of its own.
inline constexpr unsigned kFirstOfSpectrum = 4;
// The microphone of the board, which has at most one.
constexpr bool is_microphone(DriverId driver) {
  return bus_of(driver) == Bus::sound;
}
// A part of the board that needs no wiring and no bus. Which one: the input of its channel (boards::Part).
constexpr bool is_board_part(DriverId driver) {
  return bus_of(driver) == Bus::part;
}
// There is no such sensor that could be wired.
constexpr bool is_of_board(DriverId driver) {
  return is_microphone(driver) || is_board_part(driver);
}
// It takes a single measurement on request, which takes a while and may find nothing.
constexpr bool measures_when_told(DriverId driver) {
  return driver == DriverId::vl53l0x;
}
// If its device does not answer, there is no new reading, and the last one grows old.
constexpr bool may_be_silent(DriverId driver) {
  return is_on_i2c(driver) || is_on_spi(driver) || is_by_echo(driver) || is_analog(driver) ||
         is_of_board(driver) || counts_edges(driver);
}

// A chip that makes the pulses of servos. It has no readings: it is among the sensors so that its bus has one user at a time, and
// so that it is reported if it does not answer. `first_input` is the board's pin at the chip's OE input.
constexpr bool is_servo_chip(DriverId driver) {
  return driver == DriverId::pca9685;
}
// A display, which is among the sensors for the same reasons.
constexpr bool is_display(DriverId driver) {
  return driver == DriverId::ssd1306;
}
// It gets data in each of its frames, and has no readings.
constexpr bool is_served(DriverId driver) {
  return is_servo_chip(driver) || is_display(driver);
}
inline constexpr unsigned kMaxDisplays = 2;  // of a program
inline constexpr std::uint16_t kDisplayFrameMs = 50;
// The addresses of an SSD1306, selected by its pin SA0 (Solomon Systech SSD1306 Rev. 1.1, 8.1.5).
inline constexpr std::uint16_t kFirstDisplayAddress = 0x3C;
inline constexpr std::uint16_t kLastDisplayAddress = 0x3D;
inline constexpr unsigned kChipChannels = 16;
inline constexpr unsigned kMaxServoChips = 4;  // of a program
inline constexpr std::uint16_t kServoFrameMs = 20;
// The addresses of a PCA9685, selected by six pins (NXP PCA9685 Rev. 4, 7.1.1); at 0x70 all of them answer at power-up (7.1.3).
inline constexpr std::uint16_t kFirstChipAddress = 0x40;
inline constexpr std::uint16_t kAllChipsAddress = 0x70;

// An SPI transfer: it writes one byte, and reads at most two.
inline constexpr std::size_t kMostSpiBytes = 3;

// The echoes of one burst must have died away before the next one.
inline constexpr std::uint16_t kMinEchoPeriodMs = 60;
// A microphone is sampled as often as there is a new block of sound (runtime-m4/drivers/ear.hpp).
inline constexpr std::uint16_t kSoundPeriodMs = 20;
// A VL53L0X takes some 33 ms from one result to the next; this leaves a margin.
inline constexpr std::uint16_t kMinRangingPeriodMs = 50;

// Encoders. Each edge is an interrupt: so a board counts at most kEdgesPerMs of each encoder, and has to be asked at least every
// kMostEncoderPeriodMs, as all the edges of a period may come at once (runtime-m4/policy/rules.hpp).
inline constexpr unsigned kMaxEncoders = 2;  // of a program
inline constexpr unsigned kEdgesPerMs = 4;
inline constexpr std::uint16_t kMostEncoderPeriodMs = 50;
inline constexpr std::uint8_t kDistanceInput = 0;  // the input of the channel that counts edges
inline constexpr unsigned kSpeedParts = 16;  // a count of speed is this part of an edge per second
// Which of the program's encoders it is.
constexpr unsigned encoder_number(const Image& image, std::size_t sensor) {
  unsigned number = 0;
  for (std::size_t s = 0; s < sensor; ++s)
    number += counts_edges(image.sensors[s].driver) ? 1 : 0;
  return number;
}

// The shortest period at which a sensor with this driver gives readings; 0: any.
constexpr std::uint16_t min_period_ms(DriverId driver) {
  if (is_by_echo(driver)) return kMinEchoPeriodMs;
  if (is_microphone(driver)) return kSoundPeriodMs;
  return measures_when_told(driver) ? kMinRangingPeriodMs : 0;
}

// For a panel, `bus` is the layout of its lights, and `speed_limit` the colour of a lit one, 0xRRGGBB; for a strip, the number of
// its lights, and their brightest white. No component exceeds kMostLight: so 25 white lights take 0.3 A, which a board gets from
// USB, instead of 1.5 A.
inline constexpr std::uint8_t kPanelGoesBack = 1;  // every second row is wired from right to left
inline constexpr std::uint8_t kPanelIsLarge =
    2;                                      // 8 x 8 lights, with the picture centred; else 5 x 5
inline constexpr unsigned kMostLight = 51;  // of 255
inline constexpr unsigned kMostPanelLights = 64;
constexpr bool is_panel(const Actuator& actuator) {
  const Value color = actuator.speed_limit;
  const bool has_layout = is_strip(actuator.driver)
                              ? actuator.bus > 0 && actuator.bus <= kMostPanelLights
                              : actuator.bus <= (kPanelGoesBack | kPanelIsLarge);
  if (!has_layout || color < 0 || color > 0xFF'FFFF) return false;
  for (unsigned part = 0; part < 24; part += 8)
    if ((static_cast<std::uint32_t>(color) >> part & 0xFF) > kMostLight) return false;
  return true;
}

// How many samples a program discards at its start: one that measures on request may hold a result of any age, which a part of
// the board gives twice, and a microphone is loud while its voltage settles.
constexpr std::uint8_t first_samples_discarded(DriverId driver) {
  if (is_microphone(driver)) return 6;
  if (is_board_part(driver)) return 2;
  return measures_when_told(driver) ? 1 : 0;
}

// The I2C specification reserves all other addresses.
inline constexpr std::uint16_t kFirstAddress = 0x08;
inline constexpr std::uint16_t kLastAddress = 0x77;

}  // namespace robosync::vm
