// See sampler.hpp. The verifier has checked that scale_den is not 0.
#include "runtime-m4/layers/sampler.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/screen.hpp"
#include "runtime-m4/drivers/served.hpp"
#include "runtime-m4/drivers/servo_chip.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::layers {

// Not inline: a sample is taken on the deepest path of the sensor's stack.
[[gnu::noinline]] vm::Value scaled(std::int32_t raw, const vm::Channel& channel) {
  const std::int64_t product = std::int64_t{raw} * channel.scale_num;  // |product| <= 2^62
  const std::int64_t half = channel.scale_den / 2;
  const std::int64_t quotient = (product < 0 ? product - half : product + half) / channel.scale_den;
  const std::int64_t value =
      std::clamp<std::int64_t>(quotient, -(std::int64_t{1} << 33), std::int64_t{1} << 33) +
      channel.offset;
  return static_cast<vm::Value>(std::clamp<std::int64_t>(value, vm::kValueMin, vm::kValueMax));
}

bool DriverSampler::sample(const vm::Image& image, std::uint8_t channel, vm::Value& value) {
  const vm::Channel& wiring = image.channels[channel];
  const vm::Sensor& sensor = image.sensors[wiring.sensor];
  if (boards::kHasMicrophone && vm::is_microphone(sensor.driver))
    return microphone_.sample(board_, channel == sensor.first_channel, wiring, value);
  if (sensor.driver == vm::DriverId::encoder) [[unlikely]]
    return sample_encoder(image, channel, value);
  std::int32_t raw = 0;
  {
    const kernel::MutexGuard mine(kernel_, buses_);
    if (!drivers::driver(sensor.driver).read(board_, sensor, wiring, raw)) return false;
  }
  value = scaled(raw, wiring);
  return true;
}

// It is on no bus. Not inlined: most sensors are no encoders.
[[gnu::noinline]] bool DriverSampler::sample_encoder(const vm::Image& image, std::uint8_t channel,
                                                     vm::Value& value) {
  const vm::Channel& wiring = image.channels[channel];
  const vm::Sensor& sensor = image.sensors[wiring.sensor];
  std::int32_t raw = 0;
  if (!encoders_.sample(outputs_, sensor, vm::encoder_number(image, wiring.sensor),
                        channel == sensor.first_channel, wiring.input, kernel_.now(), raw))
    return false;
  value = scaled(raw, wiring);
  return true;
}

kernel::Duration DriverSampler::asks_ahead(const vm::Sensor& sensor) const {
  if (vm::is_by_echo(sensor.driver)) return kernel::milliseconds(policy::kEchoMs);
  if (vm::is_served(sensor.driver)) return 0;  // its thread waits for the bus itself
  const bool on_bus = vm::is_on_i2c(sensor.driver) || vm::is_on_spi(sensor.driver);
  return on_bus ? board_.buses_ask_ahead() * kernel::kTick : 0;
}

drivers::ServedBus DriverSampler::bus_of(const vm::Sensor& sensor) {
  return {.kernel = kernel_,
          .board = board_,
          .buses = buses_,
          .bus = sensor.bus,
          .address = static_cast<std::uint8_t>(sensor.address)};
}

// Many parts have registers, and for those this selects the first one and reads it.
bool DriverSampler::probe(std::uint8_t bus, std::uint8_t address) {
  std::byte got{};
  return drivers::exchange(
      {.kernel = kernel_, .board = board_, .buses = buses_, .bus = bus, .address = address},
      std::array{std::byte{0}}, std::span(&got, 1), 1);
}

bool DriverSampler::serve_chip(const vm::Image& image, unsigned sensor) {
  if (vm::is_display(image.sensors[sensor].driver)) return serve_display(image, sensor);
  return drivers::serve_pca9685(bus_of(image.sensors[sensor]), outputs_, sensor);
}

[[gnu::noinline]] bool DriverSampler::serve_display(const vm::Image& image, unsigned sensor) {
  return drivers::serve_ssd1306(bus_of(image.sensors[sensor]), outputs_, sensor);
}

// There is no answer yet, so what the driver makes of it is ignored.
void DriverSampler::ask(const vm::Image& image, std::uint8_t channel) {
  const vm::Channel& wiring = image.channels[channel];
  const vm::Sensor& sensor = image.sensors[wiring.sensor];
  if (vm::is_by_echo(sensor.driver)) {
    if (channel == sensor.first_channel) outputs_.ping(wiring.sensor);
    return;
  }
  std::int32_t raw = 0;
  const kernel::MutexGuard mine(kernel_, buses_);
  board_.ask_buses(true);
  static_cast<void>(drivers::driver(sensor.driver).read(board_, sensor, wiring, raw));
  board_.ask_buses(false);
}

}  // namespace robosync::layers
