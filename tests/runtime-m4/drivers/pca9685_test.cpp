// Servos on a PCA9685, with a model of its registers: the chip's outputs in each millisecond, whatever the bus, the chip
// and the program do.
#include <cmath>
#include <map>
#include <memory>
#include <random>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "tests/runtime-m4/drivers/pca9685_model.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "tests/vm/image_builder.hpp"

using namespace robosync;

namespace {

constexpr std::uint16_t kEnable = 36;

std::string servo(const char* name, unsigned channel, const std::string& more = "",
                  const char* place = R"("address": "0x40", "enable": 36)") {
  return fmt::format(
      R"({{"name": "{}", "type": "I2C", "device": "pca9685_servo", {}, "channel": {}{}}})", name,
      place, channel, more);
}

std::string robot_of(const std::string& actuators) {
  return R"({"sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100]}}},
                         {"name": "wall", "type": "VIRTUAL", "channels": {"Y": {"range": [0, 100]}}}],
             "actuators": [)" +
         actuators + "]}";
}

const std::string kTwoArms = robot_of(servo("left", 3) + "," + servo("right", 12));
const char* const kProgram = R"(
SAFETY near_wall
  WHEN wall Y > 50
  DO STOP left
END
WHEN near X > 10 AND near X < 20 DO MOVE left TO 90deg AT 180deg/s END
WHEN near X > 20 AND near X < 30 DO MOVE right TO 180deg AT 180deg/s END
WHEN near X > 30 DO MOVE left TO 45deg AT 180deg/s END
)";

// A rig with chips on its bus 0. The chips' outputs are checked in each millisecond.
struct ChipRig {
  explicit ChipRig(bool works_by_itself = false) {
    add(0x40, kEnable);
    rig.board.asks_ahead = works_by_itself ? 1 : 0;
    rig.board.on_bus = [this](std::uint8_t, std::uint8_t address, std::span<const std::byte> out,
                              std::span<std::byte> in) {
      return rig.board.asks_ahead != 0 ? later(address, out, in) : now(address, out, in);
    };
  }
  test::Pca9685& add(std::uint8_t address, std::uint16_t enable) {
    chips.push_back(std::make_unique<test::Pca9685>(
        address, [this, enable] { return !is_on(enable); }, [this] { return rig.kernel.now(); }));
    return *chips.back();
  }
  bool is_on(std::uint16_t pin = kEnable) const {
    const auto found = rig.board.enabled.find(pin);
    return found != rig.board.enabled.end() && found->second;
  }
  test::Pca9685& chip() { return *chips.front(); }
  double pulse(unsigned channel) { return chip().pulse_us(channel); }

  bool now(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in) {
    bool answered = false;
    for (const auto& chip : chips)
      answered = chip->transfer(address, out, in) || answered;
    return answered;
  }
  // Behaves like a bus that works in the background (boards::Board).
  bool later(std::uint8_t address, std::span<const std::byte> out, std::span<std::byte> in) {
    const std::pair key(address, std::vector<std::byte>(out.begin(), out.end()));
    if (rig.board.asked_ahead) {
      Answer answer{.taken = false, .in = std::vector<std::byte>(in.size())};
      answer.taken = now(address, out, answer.in);
      answers[key] = answer;
      return in.empty();
    }
    const auto found = answers.find(key);
    REQUIRE(found != answers.end());
    const Answer answer = found->second;
    answers.erase(found);
    std::ranges::copy(answer.in, in.begin());
    return answer.taken;
  }

  void begin(const std::string& rsl = kProgram, const std::string& json = kTwoArms) {
    REQUIRE(rig.activate(test::compile(rsl, json)).ok());
    rig.feed(1, 0);  // no wall, for those that have SAFETY
  }
  // No output may ever give a pulse that a servo cannot take.
  void run(std::uint64_t ms) {
    const std::uint64_t end = rig.kernel.now() / 1000 + ms;
    for (std::uint64_t at = rig.kernel.now() / 1000; at <= end; ++at) {
      rig.run(at);
      for (const auto& chip : chips)
        for (unsigned n = 0; n < test::Pca9685::kOutputs; ++n) {
          const double pulse = chip->pulse_us(n);
          if (pulse != 0 && (pulse < 497 || pulse > 2503)) FAIL("a pulse of " << pulse << " us");
        }
    }
  }
  void order(int near) {
    rig.feed(0, 0);
    run(5);
    rig.feed(0, near);
  }
  bool said(const std::string& text) const {
    return std::ranges::any_of(
        rig.lines, [&](const std::string& line) { return line.find(text) != std::string::npos; });
  }

  struct Answer {
    bool taken = false;
    std::vector<std::byte> in{};
  };
  test::Rig rig;
  std::vector<std::unique_ptr<test::Pca9685>> chips;
  std::map<std::pair<std::uint8_t, std::vector<std::byte>>, Answer> answers;
};

bool about(double us, double wanted) {
  return std::abs(us - wanted) < 3.5;  // half a count, and the microsecond that is cut off
}

}  // namespace

TEST_CASE("pca9685: it is set up before it is let on, and moves at the speed that is said") {
  for (const bool works_by_itself : {false, true}) {
    ChipRig robot(works_by_itself);
    robot.begin();
    robot.run(100);
    CHECK_FALSE(robot.chip().sleeps());
    CHECK_FALSE(robot.is_on());  // there has been no command yet
    robot.order(11);
    robot.run(250);
    CHECK(robot.is_on());
    CHECK(robot.pulse(3) > 900);  // half the way from 500 to 1500
    CHECK(robot.pulse(3) < 1100);
    robot.run(400);
    CHECK(about(robot.pulse(3), 1500));
    CHECK(robot.chip().frame_us() == Approx(20'000).epsilon(0.001));
    CHECK(robot.chip().at(0x00) == 0x20);  // no sleep, no common address
    CHECK(robot.chip().at(0x01) == 0x04);
    for (unsigned n = 0; n < 16; ++n)
      if (n != 3) CHECK(robot.pulse(n) == 0);
  }
}

TEST_CASE("pca9685: a servo that stands costs one question in a frame, and no more") {
  ChipRig robot;
  robot.begin();
  robot.order(11);
  robot.run(1000);
  robot.rig.board.transfers.clear();
  robot.run(200);
  CHECK(robot.rig.board.transfers.size() <= 11);
  for (const auto& transfer : robot.rig.board.transfers)
    CHECK(transfer.out.size() == 1);
}

TEST_CASE("pca9685: all sixteen channels have their own pulse, on two chips") {
  std::string actuators;
  std::string rsl = "WHEN near X > 10 DO\n";
  for (unsigned i = 0; i < 32; ++i) {
    const char* const place =
        i < 16 ? R"("address": "0x40", "enable": 36)" : R"("address": "0x41", "enable": 37)";
    actuators += (i == 0 ? "" : ",") + servo(fmt::format("s{}", i).c_str(), i % 16, "", place);
    rsl += fmt::format("MOVE s{} TO {}deg AT 1000deg/s\n{}", i, i * 5 + 3,
                       i % 8 == 7 && i != 31 ? "THEN\n" : "");
  }
  ChipRig robot;
  test::Pca9685& second = robot.add(0x41, 37);
  robot.begin(rsl + "END\n", robot_of(actuators));
  robot.order(11);
  robot.run(2000);
  CHECK(robot.is_on(36));
  CHECK(robot.is_on(37));
  for (unsigned i = 0; i < 32; ++i) {
    const double wanted = 500 + (i * 5 + 3) * 2000.0 / 180;
    CHECK(about((i < 16 ? robot.chip() : second).pulse_us(i % 16), wanted));
  }
}

TEST_CASE(
    "pca9685: a stop takes its outputs away at once and without the bus, and gives them to "
    "nobody") {
  ChipRig robot;
  robot.begin();
  robot.order(11);
  robot.run(1000);
  robot.order(21);
  robot.run(300);
  REQUIRE(robot.pulse(3) > 0);
  robot.rig.board.transfers.clear();
  robot.rig.runtime.stop();
  robot.rig.run(robot.rig.kernel.now() / 1000);
  CHECK_FALSE(robot.is_on());
  CHECK(robot.rig.board.transfers.empty());
  robot.run(100);
  CHECK(robot.chip().is_off(3));  // not only by the enable pin
  CHECK(robot.chip().is_off(12));
  robot.order(31);
  robot.run(200);
  CHECK_FALSE(robot.is_on());
  robot.rig.runtime.resume();
  robot.run(200);
  CHECK_FALSE(robot.is_on());  // that moves nothing
  robot.order(31);
  robot.run(1000);
  CHECK(robot.is_on());
  CHECK(about(robot.pulse(3), 1000));
  CHECK(robot.pulse(12) == 0);  // it waits for its own order
}

TEST_CASE("pca9685: a SAFETY rule that stops one of its servos makes all of them limp") {
  ChipRig robot;
  robot.begin();
  robot.order(21);
  robot.run(1500);
  REQUIRE(robot.pulse(12) > 0);
  robot.rig.feed(1, 60);
  robot.rig.run(robot.rig.kernel.now() / 1000);
  CHECK_FALSE(robot.is_on());
  robot.order(21);  // the other actuator is not halted, but its chip is
  robot.run(300);
  CHECK_FALSE(robot.is_on());
  CHECK(robot.pulse(12) == 0);
}

namespace {

// The guard of one servo on a chip that has been set up, without a driver: what a halt meets in between is up to the test.
struct GuardedArm {
  explicit GuardedArm(vm::Release safe) {
    chip.driver = vm::DriverId::pca9685;
    chip.first_input = kEnable;
    arm.driver = vm::DriverId::pca9685_servo;
    arm.pin = 3;
    arm.safe = safe;
    image.sensors = std::span(&chip, 1);
    image.actuators = std::span(&arm, 1);
    guard.own(image);
    guard.note_chip_set_up(0);
  }
  // True: then `setpoint` is what the chip must get.
  bool drive(std::uint32_t pulse) {
    guard.begin_order(0);
    guard.drive(0, pulse, 0);
    return has_setpoint();
  }
  bool has_setpoint() { return guard.next_setpoint(0, 0, setpoint); }
  bool is_to_go_off() { return has_setpoint() && setpoint.pulse == 0; }
  bool is_on() { return board.enabled[kEnable]; }

  test::NotingBoard board;
  kernel::Kernel kernel;
  guard::OutputGuard guard{kernel, board};
  vm::Sensor chip{};
  vm::Actuator arm{};
  vm::Image image;
  guard::OutputGuard::Setpoint setpoint{};
};

}  // namespace

// A halt may come while the driver begins an order.
TEST_CASE("pca9685: an order that begins during a halt does not move the servo after it") {
  GuardedArm arm(vm::Release::coast);
  arm.guard.halt(1);
  arm.guard.begin_order(0);
  arm.guard.let_go(1);
  arm.guard.drive(0, 1000, 0);
  CHECK_FALSE(arm.has_setpoint());
  CHECK(arm.drive(1000));
}

TEST_CASE("pca9685: what holds in its safe state holds, and takes no order") {
  const std::string hold = R"(, "safe": "hold")";
  ChipRig robot;
  robot.begin(kProgram, robot_of(servo("left", 3, hold) + "," + servo("right", 12, hold)));
  robot.order(11);
  robot.run(1000);
  robot.rig.runtime.stop();
  robot.order(31);
  robot.run(500);
  CHECK(robot.is_on());
  CHECK(about(robot.pulse(3), 1500));
  robot.rig.runtime.clear();
  CHECK_FALSE(robot.is_on());
}

// The chip does what a servo was told up to a frame later: that must not be in the halt.
TEST_CASE("pca9685: a servo that would hold does not begin to move in a halt, nor after it") {
  const std::string hold = R"(, "safe": "hold")";
  const std::string arms = robot_of(servo("left", 3, hold) + "," + servo("right", 12, hold));
  for (const bool is_on : {false, true})
    for (unsigned wait = 0; wait < 25; ++wait) {
      ChipRig robot;
      robot.begin(kProgram, arms);
      robot.run(100);
      if (is_on) {
        robot.order(21);  // the other servo of the chip
        robot.run(1500);
      }
      robot.order(11);
      robot.run(wait);
      const double before = robot.pulse(3);
      robot.rig.runtime.stop();
      robot.run(100);
      INFO(is_on << " " << wait);
      CHECK(robot.pulse(3) == before);
      if (before == 0) CHECK(robot.is_on() == is_on);
      robot.rig.runtime.resume();
      robot.run(100);
      CHECK(robot.pulse(3) == before);
      robot.order(31);
      robot.run(1000);
      CHECK(about(robot.pulse(3), 1000));
    }
}

TEST_CASE("pca9685: a servo that holds stays where the chip has it, whatever is on the bus") {
  GuardedArm arm(vm::Release::hold);
  REQUIRE(arm.drive(1000));
  arm.guard.halt(1);
  arm.guard.note_setpoint(arm.setpoint);  // it was on the bus
  CHECK(arm.is_to_go_off());
  arm.guard.note_setpoint(arm.setpoint);
  arm.guard.let_go(1);
  REQUIRE(arm.drive(1000));
  arm.guard.note_setpoint(arm.setpoint);
  arm.guard.halt(1);  // the chip has the pulse, and gives none yet
  arm.guard.let_chip_on(0);
  CHECK_FALSE(arm.is_on());
  arm.guard.let_go(1);
  arm.guard.drive(0, 1000, 0);  // no new order
  CHECK(arm.is_to_go_off());
  static_cast<void>(arm.drive(1000));
  arm.guard.let_chip_on(0);
  REQUIRE(arm.is_on());
  REQUIRE(arm.drive(1100));
  arm.guard.halt(1);
  CHECK_FALSE(arm.has_setpoint());  // the chip has 1000
  arm.guard.let_go(1);
  REQUIRE(arm.drive(1200));
  arm.guard.halt(1);
  arm.guard.note_setpoint(arm.setpoint);  // it was on the bus
  CHECK_FALSE(arm.has_setpoint());
  CHECK(arm.is_on());
}

TEST_CASE("pca9685: without a program that has it, it is off") {
  ChipRig robot;
  robot.begin();
  robot.order(11);
  robot.run(1000);
  REQUIRE(robot.is_on());
  robot.begin("WHEN near X > 50 DO MOVE right TO 10deg END\n");
  CHECK_FALSE(robot.is_on());
  robot.run(200);
  CHECK_FALSE(robot.is_on());
  CHECK(robot.chip().is_off(3));  // set up for the new program, which does not have that one
  robot.order(60);
  robot.run(200);
  CHECK(robot.is_on());
  CHECK(robot.pulse(3) == 0);
  robot.rig.runtime.clear();
  CHECK_FALSE(robot.is_on());
  robot.begin("WHEN near X > 50 DO LOG \"no arms\" END\n");
  robot.rig.board.transfers.clear();
  robot.run(100);
  CHECK_FALSE(robot.is_on());
  CHECK(robot.rig.board.transfers.empty());
}

TEST_CASE("pca9685: one that does not answer is told of, is off, and the program goes on") {
  for (const bool works_by_itself : {false, true}) {
    ChipRig robot(works_by_itself);
    robot.chip().absent = true;
    robot.begin();
    robot.order(11);
    robot.run(1000);
    CHECK(robot.said("silent"));
    CHECK(robot.said("done left"));
    CHECK_FALSE(robot.is_on());
    robot.chip().absent = false;
    robot.run(500);
    CHECK(robot.said("answers"));
    CHECK_FALSE(robot.chip().sleeps());
    CHECK_FALSE(robot.is_on());  // an old order moves nothing
    robot.order(31);
    robot.run(500);
    CHECK(robot.is_on());
  }
}

TEST_CASE(
    "pca9685: a wire that comes off in the midst of a way: off, told, and limp until the next "
    "order") {
  ChipRig robot;
  robot.begin();
  robot.order(11);
  robot.run(200);
  REQUIRE(robot.is_on());
  robot.chip().absent = true;
  robot.run(100);
  CHECK_FALSE(robot.is_on());
  CHECK(robot.said("silent"));
  robot.run(1000);
  robot.chip().absent = false;
  robot.run(500);
  CHECK_FALSE(robot.is_on());
  robot.order(31);
  robot.run(1000);
  CHECK(about(robot.pulse(3), 1000));
}

// The bytes written so far may take effect: half of a pulse's count.
TEST_CASE("pca9685: a pulse that was not taken whole is said again at once, and not for ever") {
  for (std::size_t byte = 1; byte <= 3; ++byte) {
    ChipRig robot;
    robot.begin();
    robot.order(11);
    robot.run(100);
    REQUIRE(robot.is_on());
    unsigned disturbances = 2;
    const auto bus = robot.rig.board.on_bus;
    robot.rig.board.on_bus = [&](std::uint8_t b, std::uint8_t address,
                                 std::span<const std::byte> out, std::span<std::byte> in) {
      const bool pulse = out.size() == 3 && disturbances != 0;
      robot.chip().disturbed_bytes = pulse ? byte : 0;
      if (pulse) --disturbances;
      return bus(b, address, out, in);
    };
    robot.run(100);
    CHECK(disturbances == 0);
    CHECK(robot.is_on());
    disturbances = 3;
    robot.run(40);
    CHECK(disturbances == 0);
    CHECK_FALSE(robot.is_on());
    robot.run(600);  // the way under way has ended with that
    CHECK_FALSE(robot.is_on());
    robot.order(11);
    robot.run(1000);
    CHECK(robot.is_on());
    CHECK(about(robot.pulse(3), 1500));
  }
}

TEST_CASE("pca9685: a chip that has lost its power meanwhile is set up again, and gives nothing") {
  ChipRig robot;
  robot.begin();
  robot.order(11);
  robot.run(1000);
  REQUIRE(robot.is_on());
  robot.chip().lose_power();
  robot.run(100);
  CHECK_FALSE(robot.chip().sleeps());
  CHECK(robot.chip().frame_us() == Approx(20'000).epsilon(0.001));
  CHECK_FALSE(robot.is_on());
  robot.order(31);
  robot.run(1000);
  CHECK(about(robot.pulse(3), 1000));
}

TEST_CASE("pca9685: what is under way when the chip is lost does not go on when it is back") {
  ChipRig robot;
  robot.begin();
  robot.order(21);
  robot.run(200);
  REQUIRE(robot.is_on());
  robot.chip().lose_power();
  robot.run(200);
  CHECK_FALSE(robot.is_on());
  robot.rig.runtime.stop();
  robot.run(20);
  robot.rig.runtime.resume();
  robot.order(11);
  robot.run(1000);
  CHECK(robot.is_on());
}

TEST_CASE("pca9685: a chip whose thread was stopped is off, and one whose program hangs, too") {
  ChipRig robot;
  robot.begin();
  robot.order(11);
  robot.run(1000);
  REQUIRE(robot.is_on());
  robot.rig.kernel.stop(robot.rig.thread("pca9685"));
  robot.run(20);
  CHECK_FALSE(robot.is_on());
  ChipRig other;
  other.begin();
  other.order(11);
  other.run(1000);
  REQUIRE(other.is_on());
  other.rig.kernel.stop(other.rig.thread("step"));
  other.rig.feed(0, 0);
  other.run(100);
  CHECK_FALSE(other.is_on());
}

// Whatever happens, in any order: the enable pin is low only while outputs may be driven, and all pulses are valid for a servo.
TEST_CASE("pca9685: drawn lives") {
  std::mt19937 random(9685);
  for (unsigned life = 0; life < 60; ++life) {
    ChipRig robot(life % 3 == 0);
    robot.begin();
    bool stopped = false;
    for (unsigned turn = 0; turn < 40; ++turn) {
      const auto what = random() % 8;
      if (what < 3) robot.order(static_cast<int>(what) * 10 + 11);
      if (what == 3) robot.chip().absent = !robot.chip().absent;
      if (what == 4) robot.chip().lose_power();
      if (what == 5) robot.chip().disturbed_bytes = random() % 5;
      if (what == 6) {
        stopped = !stopped;
        stopped ? robot.rig.runtime.stop() : robot.rig.runtime.resume();
      }
      if (what == 7) robot.begin();
      robot.run(1 + random() % 60);
      if (stopped) CHECK_FALSE(robot.is_on());
    }
    if (stopped) robot.rig.runtime.resume();
    robot.chip().absent = false;
    robot.chip().disturbed_bytes = 0;
    robot.begin();
    robot.order(11);
    robot.run(1500);
    CHECK(about(robot.pulse(3), 1500));
  }
}

// ---- what no image can do

namespace {

using Change = std::function<void(vm::Sensor& chip, vm::Sensor& other, vm::Actuator& left,
                                  vm::Actuator& right)>;

vm::Refusal refused(const Change& change) {
  const std::string json = robot_of(servo("left", 3) + "," +
                                    servo("right", 12, "", R"("address": "0x41", "enable": 37)"));
  std::vector<std::byte> bytes = test::compile(kProgram, json);
  vm::Image image;
  REQUIRE(vm::view_image(bytes, image));
  REQUIRE(image.sensors.size() == 4);
  const auto at = [](const auto& record) -> auto& {
    return const_cast<std::remove_cvref_t<decltype(record)>&>(record);
  };
  change(at(image.sensors[2]), at(image.sensors[3]), at(image.actuators[0]),
         at(image.actuators[1]));
  vm::test::repair_crc(bytes);
  test::Rig rig;
  return rig.activate(bytes).refusal;
}

}  // namespace

TEST_CASE(
    "pca9685: an image in which chips, channels or pins are shared, or are none, is refused") {
  using vm::Refusal;
  CHECK(refused([](auto&...) {}) == Refusal::none);
  CHECK(refused([](auto& chip, auto&...) { chip.address = 0x3F; }) == Refusal::bad_value);
  CHECK(refused([](auto& chip, auto&...) { chip.address = 0x70; }) == Refusal::bad_value);
  CHECK(refused([](auto& chip, auto&...) { chip.address = 0x78; }) == Refusal::bad_value);
  CHECK(refused([](auto& chip, auto& other, auto&...) { chip.address = other.address; }) ==
        Refusal::bad_value);
  CHECK(refused([](auto& chip, auto&...) { chip.period_ms = 10; }) == Refusal::bad_value);
  CHECK(refused([](auto& chip, auto&...) { chip.period_ms = 0; }) == Refusal::bad_value);
  CHECK(refused([](auto& chip, auto&...) { chip.bus = 3; }) == Refusal::no_bus);
  CHECK(refused([](auto& chip, auto&...) { chip.address = 0x50; }) == Refusal::reserved_address);
  CHECK(refused([](auto& chip, auto&...) { chip.address = 0x51; }) == Refusal::none);
  CHECK(refused([](auto& chip, auto& other, auto&...) { chip.first_input = other.first_input; }) ==
        Refusal::shared_pin);
  for (const int pin : {0, 3, 35, 38, 40, 44, 255})
    CHECK(refused([&](auto& chip, auto&...) {
            chip.first_input = static_cast<std::uint8_t>(pin);
          }) == Refusal::no_pin);
  CHECK(refused([](auto&, auto&, auto& left, auto&) { left.pin = 16; }) == Refusal::bad_index);
  CHECK(refused([](auto&, auto&, auto& left, auto&) { left.bus = 0; }) == Refusal::bad_index);
  CHECK(refused([](auto&, auto&, auto& left, auto&) { left.bus = 200; }) == Refusal::bad_index);
  CHECK(refused([](auto&, auto&, auto& left, auto&) { left.safe = vm::Release::rest; }) ==
        Refusal::needs_the_bus);
  CHECK(refused([](auto&, auto&, auto& left, auto& right) {
          right.bus = left.bus;
          right.safe = vm::Release::hold;
        }) == Refusal::needs_the_bus);
  CHECK(refused([](auto&, auto&, auto& left, auto& right) {
          right.bus = left.bus;
          right.pin = left.pin;
        }) == Refusal::shared_pin);
  // A pin at a chip's enable input has no other use.
  CHECK(refused([](auto&, auto&, auto& left, auto&) {
          left.driver = vm::DriverId::servo;
          left.pin = 36;
        }) == Refusal::shared_pin);
}
