// The verifier on a drive of two motors: each wrong record, and each pin that something else has.
#include <catch2/catch.hpp>

#include "tests/vm/companion.hpp"
#include "tests/vm/refusal_checks.hpp"
#include "vm/drive.hpp"

namespace verifier_drive_test {

using namespace robosync::vm;
using namespace robosync::vm::test;
namespace robot = robosync::vm::test::companion;

namespace {

// A drive of two motors on pins that nothing else uses.
void add_drive(ImageBuilder& image, std::size_t actuator, DriveParameters parameters) {
  Actuator& drive = image.actuators[actuator];
  drive.driver = DriverId::differential_drive;
  drive.bus = 0;
  drive.safe = Release::coast;
  drive.pin = static_cast<std::uint16_t>(image.constants.size());
  const DriveValues values = values_of(parameters);
  image.constants.insert(image.constants.end(), values.begin(), values.end());
}

constexpr DriveParameters kDrive{.pins = {20, 21, 22, 23},
                                 .trim = {100, 50},
                                 .encoders = {0, 0},
                                 .speed = 40 * kScale,
                                 .track = kMostTrack,
                                 .usual = 1};

}  // namespace

TEST_CASE("a drive of two motors") {
  ImageBuilder good = robot::make();
  add_drive(good, 1, kDrive);
  check_accepted(good);
  const auto refused = [](Refusal refusal, auto wrong) {
    check_refused(
        [&](ImageBuilder& i) {
          DriveParameters parameters = kDrive;
          wrong(parameters, i.actuators[0]);
          add_drive(i, 1, parameters);
        },
        {refusal, Section::actuators, 1});
  };
  for (std::size_t pin = 0; pin < kDrive.pins.size(); ++pin) {
    INFO(pin);
    refused(Refusal::shared_pin,
            [&](auto& drive, auto& arm) { drive.pins[pin] = static_cast<std::uint8_t>(arm.pin); });
    refused(Refusal::shared_pin,
            [&](auto& drive, auto&) { drive.pins[pin] = drive.pins[(pin + 1) % 4]; });
    // Nor may a later actuator or a sensor have it.
    check_refused(
        [&](ImageBuilder& i) {
          add_drive(i, 0, kDrive);
          i.actuators[1].pin = kDrive.pins[pin];
        },
        {Refusal::shared_pin, Section::actuators, 1});
    check_refused(
        [&](ImageBuilder& i) {
          i.sensors[0].driver = DriverId::digital_input;
          i.sensors[0].bus = 0;
          i.sensors[0].address = kDrive.pins[pin];
          add_drive(i, 1, kDrive);
        },
        {Refusal::shared_pin, Section::actuators, 1});
  }
  refused(Refusal::bad_value, [](auto& drive, auto&) { drive.trim[0] = 0; });
  refused(Refusal::bad_value, [](auto& drive, auto&) { drive.trim[1] = 101; });
  refused(Refusal::bad_index, [](auto& drive, auto&) { drive.encoders = {1, 2}; });  // not encoders
  refused(Refusal::bad_value, [](auto& drive, auto&) { drive.encoders[1] = 1; });
  refused(Refusal::bad_value, [](auto& drive, auto&) { drive.speed = 0; });
  refused(Refusal::bad_value, [](auto& drive, auto&) { drive.track = 0; });
  refused(Refusal::bad_value, [](auto& drive, auto&) { drive.track = kMostTrack + 1; });
  refused(Refusal::bad_value, [](auto& drive, auto&) { drive.usual = -1; });
  const auto changed = [](Refusal refusal, auto wrong) {
    check_refused(
        [&](ImageBuilder& i) {
          add_drive(i, 1, kDrive);
          wrong(i.actuators[1]);
        },
        {refusal, Section::actuators, 1});
  };
  changed(Refusal::drives_on, [](auto& drive) { drive.safe = Release::hold; });
  changed(Refusal::bad_value, [](auto& drive) { drive.bus = 1; });
  changed(Refusal::bad_index, [](auto& drive) { ++drive.pin; });
  changed(Refusal::bad_index, [](auto& drive) { drive.pin = kNoIndex; });
  check_refused(
      [](ImageBuilder& i) {
        add_drive(i, 0, kDrive);
        DriveParameters other = kDrive;
        other.pins = {24, 25, 26, 27};
        add_drive(i, 1, other);
      },
      {Refusal::too_many, Section::actuators, 1});
}

TEST_CASE("a drive with encoders") {
  const auto with_encoders = [](ImageBuilder& image, auto wrong) {
    for (const std::size_t s : {std::size_t{0}, std::size_t{1}}) {
      Sensor& sensor = image.sensors[s];
      sensor.driver = DriverId::encoder;
      sensor.bus = kNoSecondPin;
      sensor.address = static_cast<std::uint16_t>(30 + s);
      sensor.period_ms = 20;
      Channel& channel = image.channels[sensor.first_channel];
      channel.input = kDistanceInput;
      channel.scale_num = 20'420;
      channel.scale_den = 40;
    }
    image.channels[robot::touch_force].input = 1;
    DriveParameters parameters = kDrive;
    parameters.encoders = {2, 1};
    wrong(parameters, image);
    add_drive(image, 1, parameters);
  };
  ImageBuilder good = robot::make();
  with_encoders(good, [](auto&, auto&) {});
  good.actuators[1].bus = static_cast<std::uint8_t>(-kMostDifference);
  check_accepted(good);
  const auto refused = [&](Refusal refusal, auto wrong) {
    check_refused([&](ImageBuilder& i) { with_encoders(i, wrong); },
                  {refusal, Section::actuators, 1});
  };
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    INFO(side);
    refused(Refusal::bad_index, [&](auto& drive, auto& image) {
      drive.encoders[side] = static_cast<std::uint8_t>(image.sensors.size() + 1);
    });
    refused(Refusal::bad_index, [&](auto& drive, auto&) { drive.encoders[side] = UINT8_MAX; });
    refused(Refusal::bad_value,
            [&](auto& drive, auto&) { drive.encoders[side] = drive.encoders[1 - side]; });
    refused(side == 0 ? Refusal::bad_value : Refusal::bad_index,
            [&](auto& drive, auto&) { drive.encoders[side] = 0; });
    refused(Refusal::bad_index, [&](auto&, auto& image) {
      image.channels[image.sensors[side].first_channel].input = 1;
    });
    refused(Refusal::bad_index, [&](auto&, auto& image) {
      image.channels[image.sensors[side].first_channel].scale_num = 0;
    });
    refused(Refusal::bad_index, [&](auto&, auto& image) {
      image.channels[image.sensors[side].first_channel].scale_num = -1;
    });
    refused(Refusal::bad_index,
            [&](auto&, auto& image) { image.sensors[side].driver = DriverId::virtual_sensor; });
  }
  for (const int difference : {kMostDifference + 1, -kMostDifference - 1})
    check_refused(
        [&](ImageBuilder& i) {
          with_encoders(i, [](auto&, auto&) {});
          i.actuators[1].bus = static_cast<std::uint8_t>(difference);
        },
        {Refusal::bad_value, Section::actuators, 1});
}

}  // namespace verifier_drive_test
