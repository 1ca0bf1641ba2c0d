// What the verifier asks of the parts that a robot has one of, or that share a pin, a bus or a chip: panels, sensors that measure
// when they are told, servo chips, displays.
#include <catch2/catch.hpp>

#include "tests/vm/companion.hpp"
#include "tests/vm/refusal_checks.hpp"
#include "vm/drivers.hpp"
#include "vm/verifier.hpp"

using namespace robosync::vm;
using namespace robosync::vm::test;
namespace robot = robosync::vm::test::companion;

namespace {

// Its last sensor is this device, without channels, on the bus of the first one.
ImageBuilder with_device(DriverId driver, std::uint16_t address, std::uint16_t period_ms) {
  ImageBuilder image = robot::make();
  Sensor device = image.sensors[0];
  device.driver = driver;
  device.address = address;
  device.period_ms = period_ms;
  device.first_channel = static_cast<std::uint8_t>(image.channels.size());
  device.channel_count = 0;
  image.sensors.push_back(device);
  return image;
}

}  // namespace

TEST_CASE(
    "a panel has its pin for itself, is the only one, and takes no more than a board can give") {
  const auto with_panel = [](auto change) {
    ImageBuilder image = robot::make();
    Actuator& panel = image.actuators[1];
    panel.driver = DriverId::ws2812_face;
    panel.speed_limit = 0x33'33'33;
    change(panel, image);
    return image;
  };
  const auto refused = [&](Refusal refusal, auto change) {
    check_refused(with_panel(change), {refusal, Section::actuators, 1});
  };
  check_accepted(with_panel([](auto&...) {}));
  const auto strip = [](unsigned lights) {
    return [lights](auto& panel, auto&) {
      panel.driver = DriverId::ws2812_strip;
      panel.bus = static_cast<std::uint8_t>(lights);
    };
  };
  for (const unsigned lights : {1U, kMostPanelLights})
    check_accepted(with_panel(strip(lights)));
  for (const unsigned lights : {0U, kMostPanelLights + 1})
    refused(Refusal::bad_value, strip(lights));
  check_accepted(with_panel([](auto& panel, auto&) { panel.bus = 3; }));
  check_accepted(with_panel([](auto& panel, auto&) { panel.safe = Release::hold; }));
  refused(Refusal::bad_value, [](auto& panel, auto&) { panel.bus = 4; });
  for (const Value color : {0x34'33'33, 0x33'34'33, 0x33'33'34, 0x01'00'00'00})
    refused(Refusal::bad_value, [&](auto& panel, auto&) { panel.speed_limit = color; });
  refused(Refusal::shared_pin,
          [](auto& panel, auto& image) { panel.pin = image.actuators[0].pin; });
  refused(Refusal::shared_pin, [](auto& panel, auto& image) {
    image.actuators[0] = panel;
    image.actuators[0].pin = 9;
  });
  refused(Refusal::shared_pin, [](auto& panel, auto& image) {
    image.sensors[0].driver = DriverId::digital_input;
    image.sensors[0].bus = 0;
    image.sensors[0].address = panel.pin;
  });
}

TEST_CASE("what measures when it is told is alone at its place on the bus") {
  const auto seeing = [](auto change) {
    const std::uint16_t same = robot::make().sensors[0].address;
    ImageBuilder image = with_device(DriverId::vl53l0x, same, kMinRangingPeriodMs);
    change(image.sensors.back());
    return image;
  };
  const auto index = static_cast<std::uint16_t>(robot::make().sensors.size());
  check_refused(seeing([](auto&) {}), {Refusal::bad_value, Section::sensors, index});
  check_accepted(seeing([](auto& eye) { ++eye.bus; }));
  check_accepted(seeing([](auto& eye) { ++eye.address; }));
}

namespace {

// Its last sensor is a servo chip, which no actuator uses.
ImageBuilder with_chip() {
  ImageBuilder image = with_device(DriverId::pca9685, kFirstChipAddress, kServoFrameMs);
  image.sensors.back().first_input = 36;
  return image;
}

}  // namespace

TEST_CASE("a part on SPI has its select pin for itself, and a format that there is") {
  const auto refused = [](Refusal refusal, std::uint16_t index, auto wrong) {
    check_refused([&](ImageBuilder& i) { wrong(i.sensors); }, {refusal, Section::sensors, index});
  };
  const auto by_echo = [](Sensor& sensor, unsigned trigger, unsigned echo) {
    sensor.driver = DriverId::hc_sr04;
    sensor.bus = static_cast<std::uint8_t>(trigger);
    sensor.address = static_cast<std::uint16_t>(echo);
    sensor.period_ms = kMinEchoPeriodMs;
  };
  const auto selected = [](Sensor& sensor, unsigned pin) {
    sensor.driver = DriverId::spi_register;
    sensor.bus = 0;
    sensor.address = static_cast<std::uint16_t>(pin);
    sensor.period_ms = 20;
  };
  refused(Refusal::bad_value, 0, [&](auto& s) {
    selected(s[0], 36);
    s[0].period_ms = 0;
  });
  refused(Refusal::bad_value, 0, [&](auto& s) {
    selected(s[0], 36);
    s[0].first_input = static_cast<std::uint8_t>(SpiFormat::count_);
  });
  refused(Refusal::bad_value, 0, [&](auto& s) {
    selected(s[0], 36);
    s[0].driver = DriverId::mcp3008;
    s[0].first_input = 1;
  });
  refused(Refusal::shared_pin, 1, [&](auto& s) {
    selected(s[0], 36);
    selected(s[1], 36);
  });
  refused(Refusal::shared_pin, 1, [&](auto& s) {
    selected(s[0], 20);
    by_echo(s[1], 20, 40);
  });
  check_refused(
      [&](ImageBuilder& image) {
        selected(image.sensors[0], 36);
        image.channels[1].stale_ms = 0;
      },
      {Refusal::never_stale, Section::behaviors, 0});
  {
    ImageBuilder image = robot::make();
    selected(image.sensors[0], 36);
    image.sensors[0].first_input = static_cast<std::uint8_t>(SpiFormat::int8);
    selected(image.sensors[1], 37);
    check_accepted(image);
    image.actuators[1].pin = 37;
    check_refused(image, {Refusal::shared_pin, Section::actuators, 1});
  }
}

TEST_CASE("a servo chip has its place on the bus and its enable pin for itself") {
  const auto changed = [](auto change) {
    ImageBuilder image = with_chip();
    change(image.sensors.back(), image);
    return image;
  };
  const auto index = static_cast<std::uint16_t>(robot::make().sensors.size());
  const auto refused = [&](Refusal refusal, auto change, unsigned more = 0) {
    check_refused(changed(change),
                  {refusal, Section::sensors, static_cast<std::uint16_t>(index + more)});
  };
  check_accepted(changed([](auto&, auto&) {}));
  check_accepted(changed([](auto& chip, auto&) { chip.address = kLastAddress; }));
  for (const int address : {kFirstChipAddress - 1, kLastAddress + 1, int{kAllChipsAddress}})
    refused(Refusal::bad_value,
            [&](auto& chip, auto&) { chip.address = static_cast<std::uint16_t>(address); });
  refused(Refusal::bad_value, [](auto& chip, auto&) { ++chip.period_ms; });
  refused(Refusal::bad_value, [](auto& chip, auto& image) {
    image.channels.push_back(image.channels.back());
    image.channels.back().sensor = static_cast<std::uint8_t>(image.sensors.size() - 1);
    chip.channel_count = 1;
  });
  const auto same_place = [](auto& chip, auto& image) {
    image.sensors[0].bus = chip.bus;
    image.sensors[0].address = chip.address;
  };
  refused(Refusal::bad_value, same_place);
  check_accepted(changed([&](auto& chip, auto& image) {
    same_place(chip, image);
    image.sensors[0].driver = DriverId::digital_input;  // its address is a pin
  }));
  const auto add_chips = [](auto& image, unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      Sensor next = image.sensors.back();
      ++next.address;
      ++next.first_input;
      image.sensors.push_back(next);
    }
  };
  check_accepted(changed([&](auto&, auto& image) { add_chips(image, kMaxServoChips - 1); }));
  refused(
      Refusal::too_many, [&](auto&, auto& image) { add_chips(image, kMaxServoChips); },
      kMaxServoChips);
  refused(
      Refusal::shared_pin,
      [&](auto&, auto& image) {
        add_chips(image, 1);
        --image.sensors.back().first_input;
      },
      1);
}

TEST_CASE("a channel of a servo chip has one owner, and what a chip moves is safe in one way") {
  const auto with_servos = [](auto change) {
    ImageBuilder image = with_chip();
    for (unsigned a = 0; a < 2; ++a) {
      image.actuators[a].driver = DriverId::pca9685_servo;
      image.actuators[a].bus = static_cast<std::uint8_t>(image.sensors.size() - 1);
      image.actuators[a].pin = static_cast<std::uint16_t>(a);
      image.actuators[a].on_release = Release::hold;
      image.actuators[a].safe = Release::hold;
    }
    change(image.actuators[1], image.actuators[0]);
    return image;
  };
  check_accepted(with_servos([](auto&...) {}));
  check_refused(with_servos([](auto& servo, auto&) { servo.pin = 0; }),
                {Refusal::shared_pin, Section::actuators, 1});
  check_refused(with_servos([](auto& servo, auto&) { servo.safe = Release::coast; }),
                {Refusal::needs_the_bus, Section::actuators, 1});
  check_refused(
      with_servos([](auto& servo, auto& other) { servo.safe = other.safe = Release::rest; }),
      {Refusal::needs_the_bus, Section::actuators, 0});
  check_accepted(with_servos([](auto& servo, auto&) { servo.pin = kChipChannels - 1; }));
  const auto nowhere = [&](auto wrong) {
    check_refused(with_servos(wrong), {Refusal::bad_index, Section::actuators, 1});
  };
  nowhere([](auto& servo, auto&) { servo.pin = kChipChannels; });
  nowhere([](auto& servo, auto&) { servo.bus = 0; });  // a sensor that is no chip
  nowhere([](auto& servo, auto&) { servo.bus = 100; });
}

TEST_CASE("a face is on a display, which is alone at its place on the bus") {
  const auto with_face = [](auto change) {
    ImageBuilder image = with_device(DriverId::ssd1306, kFirstDisplayAddress, kDisplayFrameMs);
    Actuator& face = image.actuators[0];
    face.driver = DriverId::ssd1306_face;
    face.bus = static_cast<std::uint8_t>(image.sensors.size() - 1);
    change(image.sensors.back(), face, image);
    return image;
  };
  const auto index = static_cast<std::uint16_t>(robot::make().sensors.size());
  const auto refused = [&](Refusal refusal, auto change) {
    check_refused(with_face(change), {refusal, Section::sensors, index});
  };
  check_accepted(with_face([](auto&...) {}));
  check_accepted(with_face([](auto& display, auto&...) { display.address = kLastDisplayAddress; }));
  refused(Refusal::bad_value, [](auto& display, auto&...) { --display.address; });
  refused(Refusal::bad_value, [](auto& display, auto&...) { display.address = 0x3E; });
  refused(Refusal::bad_value, [](auto& display, auto&...) { ++display.period_ms; });
  refused(Refusal::bad_value, [](auto& display, auto&...) { display.first_input = 1; });
  refused(Refusal::bad_value, [](auto& display, auto&, auto& image) {
    --image.sensors[1].channel_count;
    --display.first_channel;
    display.channel_count = 1;
  });
  check_refused(with_face([&](auto& display, auto&, auto& image) {
                  image.sensors[0].address = display.address;
                }),
                {Refusal::bad_value, Section::sensors, index});
  check_refused(with_face([&](auto& display, auto&, auto& image) {
                  const Sensor another = display;
                  for (unsigned i = 0; i < kMaxDisplays; ++i)
                    image.sensors.push_back(another);
                  ++image.sensors[index].bus;
                  image.sensors[index + 1].address = kLastDisplayAddress;
                }),
                {Refusal::too_many, Section::sensors, static_cast<std::uint16_t>(index + 2)});
  for (const unsigned nowhere : {0U, index + 1U, 255U})
    check_refused(
        with_face([&](auto&, auto& face, auto&) { face.bus = static_cast<std::uint8_t>(nowhere); }),
        {Refusal::bad_index, Section::actuators, 0});
}
