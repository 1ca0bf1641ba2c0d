// Sensors that read the level of a pin or count its edges, and parts of the board: what the verifier refuses.
#include <functional>
#include <utility>

#include <catch2/catch.hpp>

#include "tests/vm/companion.hpp"
#include "tests/vm/refusal_checks.hpp"
#include "vm/drivers.hpp"
#include "vm/verifier.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
namespace robot = robosync::vm::test::companion;

namespace {

using Sensors = decltype(ImageBuilder::sensors);

void refused(Refusal refusal, std::uint16_t index, const std::function<void(Sensors&)>& wrong) {
  check_refused([&](ImageBuilder& image) { wrong(image.sensors); },
                {refusal, Section::sensors, index});
}

void place(Sensor& sensor, DriverId driver, unsigned pin) {
  sensor.driver = driver;
  sensor.bus = 0;
  sensor.address = static_cast<std::uint16_t>(pin);
  sensor.period_ms = 20;
}

void by_echo(Sensor& sensor, unsigned trigger, unsigned echo) {
  place(sensor, DriverId::hc_sr04, echo);
  sensor.bus = static_cast<std::uint8_t>(trigger);
  sensor.period_ms = kMinEchoPeriodMs;
}

}  // namespace

TEST_CASE("the level of a pin is read by one sensor, and the pin is nothing else's") {
  const auto kLevel = DriverId::digital_input, kVoltage = DriverId::analog_input;
  for (const auto& [first, second] :
       {std::pair{kLevel, kLevel}, {kVoltage, kLevel}, {kLevel, kVoltage}})
    refused(Refusal::shared_pin, 1, [&, first = first, second = second](Sensors& sensors) {
      place(sensors[0], first, 2);
      place(sensors[1], second, 2);
    });
  for (const unsigned pin : {20, 40})
    refused(Refusal::shared_pin, 1, [&](Sensors& sensors) {
      by_echo(sensors[0], 20, 40);
      place(sensors[1], kLevel, pin);
    });
  ImageBuilder image = robot::make();
  place(image.sensors[0], kLevel, 12);
  place(image.sensors[1], kLevel, 13);
  image.actuators[1].pin = 14;
  check_accepted(image);
  image.actuators[1].pin = 13;
  check_refused(image, {Refusal::shared_pin, Section::actuators, 1});
}

TEST_CASE("a part of the board has no place, and is measured again and again") {
  ImageBuilder image = robot::make();
  place(image.sensors[0], DriverId::board_part, 0);
  check_accepted(image);
  refused(Refusal::bad_value, 0,
          [](Sensors& sensors) { place(sensors[0], DriverId::board_part, 1); });
  refused(Refusal::bad_value, 0, [](Sensors& sensors) {
    place(sensors[0], DriverId::board_part, 0);
    sensors[0].bus = 1;
  });
  refused(Refusal::bad_value, 0, [](Sensors& sensors) {
    place(sensors[0], DriverId::board_part, 0);
    sensors[0].period_ms = 0;
  });
}

TEST_CASE("an encoder has its one or two pins for itself, is asked often, and there are two") {
  const auto encoder = [](Sensor& sensor, unsigned a, unsigned b) {
    place(sensor, DriverId::encoder, a);
    sensor.bus = static_cast<std::uint8_t>(b);
    sensor.period_ms = kMostEncoderPeriodMs;
  };
  ImageBuilder image = robot::make();
  encoder(image.sensors[0], 40, 41);
  encoder(image.sensors[1], 42, kNoSecondPin);
  check_accepted(image);
  for (const int pin : {40, 41, 42}) {
    ImageBuilder taken = image;
    taken.actuators[1].pin = static_cast<std::uint16_t>(pin);
    check_refused(taken, {Refusal::shared_pin, Section::actuators, 1});
  }
  image.actuators[1].pin = kNoSecondPin;  // which no encoder with one pin has
  check_accepted(image);
  refused(Refusal::shared_pin, 0, [&](Sensors& sensors) { encoder(sensors[0], 40, 40); });
  for (const auto& [a, b] : {std::pair{40U, 43U}, {41U, 43U}, {43U, 40U}, {43U, 41U}})
    refused(Refusal::shared_pin, 1, [&, a = a, b = b](Sensors& sensors) {
      encoder(sensors[0], 40, 41);
      encoder(sensors[1], a, b);
    });
  for (const unsigned period : {0U, kMostEncoderPeriodMs + 1U})
    refused(Refusal::bad_value, 0, [&](Sensors& sensors) {
      encoder(sensors[0], 40, 41);
      sensors[0].period_ms = static_cast<std::uint16_t>(period);
    });
  // It may lose edges: what SAFETY reads of it grows stale.
  check_refused(
      [&](ImageBuilder& safe) {
        encoder(safe.sensors[0], 40, 41);
        safe.channels[1].stale_ms = 0;
      },
      {Refusal::never_stale, Section::behaviors, 0});
  ImageBuilder third = robot::make();
  for (std::size_t s = 0; s < 2; ++s)
    encoder(third.sensors[s], static_cast<unsigned>(40 + s), kNoSecondPin);
  third.sensors.push_back(third.sensors[1]);
  third.sensors[2].address = 42;
  third.sensors[2].first_channel =
      static_cast<std::uint8_t>(third.sensors[1].first_channel + third.sensors[1].channel_count);
  third.sensors[2].channel_count = 0;
  check_refused(third, {Refusal::too_many, Section::sensors, 2});
}
