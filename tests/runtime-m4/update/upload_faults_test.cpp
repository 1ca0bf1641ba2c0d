// Uploads over a line that damages one frame, loses many, or breaks off; and damaged images.
// In every millisecond the robot runs either the old program or the new one, and in the end an
// upload succeeds.
#include <algorithm>
#include <array>
#include <cstring>
#include <random>

#include <catch2/catch.hpp>

#include "link/frame.hpp"
#include "rsc/device/client.hpp"
#include "rsc/device/uploader.hpp"
#include "rsc/failure.hpp"
#include "tests/runtime-m4/update/programs.hpp"
#include "tests/runtime-m4/update/robot.hpp"
#include "tests/runtime-m4/update/transfer.hpp"
#include "vm/identity.hpp"

using namespace robosync;
using test::Bytes;
using test::Robot;

namespace {

// A robot that runs `old_program`; checks continuously that it runs only the old program or the new one.
class Scene {
public:
  Scene(const tool::Program& old_program, const tool::Program& new_program)
      : old_(old_program.image().header->program_hash), new_(new_program) {
    const auto first = tool::upload(client, client.hello(), old_program.bytes(), {});
    REQUIRE(first.activation.running == 1);
    robot.each_tick = [this] { watch(); };
  }

  tool::UploadResult upload() { return tool::upload(client, client.hello(), new_.bytes(), {}); }
  bool runs_new() const { return running() == new_.image().header->program_hash; }
  bool runs_old() const { return running() == old_; }

  Robot robot;
  tool::Client client{robot};

private:
  const vm::ProgramHash& running() const { return robot.runtime.image().header->program_hash; }
  void watch() const {
    if (!robot.runtime.running() || (!runs_old() && !runs_new())) {
      FAIL("neither the old program nor the new one runs");
    }
  }

  vm::ProgramHash old_;
  const tool::Program& new_;
};

// Applies `change` to frame `number` only.
test::Damage at_frame(std::size_t number, const std::function<Bytes(Bytes)>& change) {
  return [=](const Bytes& frame, std::size_t at) { return at == number ? change(frame) : frame; };
}

const std::vector<std::pair<const char*, std::function<Bytes(Bytes)>>> kChanges = {
    {"dropped", [](const Bytes&) { return Bytes(); }},
    {"doubled",
     [](Bytes frame) {
       const Bytes once = frame;
       frame.insert(frame.end(), once.begin(), once.end());
       return frame;
     }},
    {"first byte flipped",
     [](Bytes frame) {
       frame.front() ^= std::byte{0x40};
       return frame;
     }},
    {"a bit in the middle flipped",
     [](Bytes frame) {
       frame[frame.size() / 2] ^= std::byte{1};
       return frame;
     }},
    {"delimiter lost",
     [](Bytes frame) {
       frame.pop_back();
       return frame;
     }},
    {"zero inserted",
     [](Bytes frame) {
       frame.insert(frame.begin() + static_cast<std::ptrdiff_t>(frame.size() / 2), std::byte{0});
       return frame;
     }},
    {"noise before", [](Bytes frame) {
       frame.insert(frame.begin(), 40, std::byte{0x33});
       return frame;
     }}};

}  // namespace

TEST_CASE("a clean upload keeps the line busy: no frame is sent twice, no byte is overrun") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::program(4);
  Scene scene(old_program, new_program);
  const tool::UploadResult result = scene.upload();
  CHECK(result.activation.running == 1);
  CHECK(scene.runs_new());
  const std::size_t frames = (new_program.bytes().size() + link::kMaxData - 1) / link::kMaxData;
  CHECK(result.frames_sent == frames);
  CHECK(scene.robot.overruns == 0);
  const auto wire_us = new_program.bytes().size() * 1'000'000 / Robot::kBytesPerSecond;
  CHECK(static_cast<std::size_t>(result.time.count()) < 2 * wire_us);
}

TEST_CASE("one damaged frame, at every place and in both directions") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::program(4);
  std::size_t to_board = 0;
  std::size_t to_host = 0;
  {
    Scene clean(old_program, new_program);
    clean.robot.to_board.set({});
    clean.robot.to_host.set({});
    clean.upload();
    to_board = clean.robot.to_board.frames();
    to_host = clean.robot.to_host.frames();
  }
  REQUIRE(to_board >= 5);  // hello, begin, two or more data, activate
  for (const auto& [name, change] : kChanges) {
    for (std::size_t number = 0; number < to_board; ++number) {
      INFO("frame " << number << " to the board " << name);
      Scene scene(old_program, new_program);
      scene.robot.to_board.set(at_frame(number, change));
      REQUIRE(scene.upload().activation.running == 1);
      REQUIRE(scene.runs_new());
      REQUIRE(scene.client.status().activations == 2);
    }
    for (std::size_t number = 0; number < to_host; ++number) {
      INFO("frame " << number << " to the host " << name);
      Scene scene(old_program, new_program);
      scene.robot.to_host.set(at_frame(number, change));
      REQUIRE(scene.upload().activation.running == 1);
      REQUIRE(scene.runs_new());
      REQUIRE(scene.client.status().activations == 2);
    }
  }
}

TEST_CASE("a lost data frame is sent again when the next reply shows it, not after a timeout") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::long_program();
  Scene clean(old_program, new_program);
  const tool::UploadResult without = clean.upload();
  REQUIRE(without.activation.running == 1);
  REQUIRE(without.frames_sent >= 5);

  Scene scene(old_program, new_program);
  scene.robot.to_board.set(at_frame(3, kChanges.front().second));  // hello, begin, data, this one
  const tool::UploadResult result = scene.upload();
  REQUIRE(result.activation.running == 1);
  CHECK(result.frames_sent > without.frames_sent);
  CHECK(result.frames_sent <= without.frames_sent + 3);
  CHECK(result.time < without.time + std::chrono::milliseconds(120));
}

TEST_CASE("one frame in five damaged at random, both ways") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::program(4);
  for (unsigned seed = 0; seed < 30; ++seed) {
    INFO("seed " << seed);
    std::mt19937 random(seed);
    const test::Damage damage = [&random](const Bytes& frame, std::size_t) {
      if (random() % 5 != 0) return frame;
      return kChanges[random() % kChanges.size()].second(frame);
    };
    Scene scene(old_program, new_program);
    scene.robot.to_board.set(damage);
    scene.robot.to_host.set(damage);
    REQUIRE(scene.upload().activation.running == 1);
    REQUIRE(scene.runs_new());
  }
}

namespace {

std::chrono::milliseconds since(std::uint64_t us, const Robot& robot) {
  return std::chrono::milliseconds((robot.kernel.now() - us) / 1000);
}

// All frames are lost from the first one of this type.
test::Damage lost_from(link::MessageType type, std::uint64_t& since, const Robot& robot) {
  return [&since, &robot, type](const Bytes& frame, std::size_t) {
    // COBS does not move the type: it is the second byte.
    const bool it = frame.size() > 1 && std::to_integer<int>(frame[1]) == static_cast<int>(type);
    if (it && since == 0) since = robot.kernel.now();
    return since == 0 ? frame : Bytes();
  };
}

}  // namespace

TEST_CASE("a board that falls silent in an upload: exit 3 within three seconds, and what runs") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::long_program();
  const auto fails = [&](link::MessageType from, const std::string& what_runs) {
    Scene scene(old_program, new_program);
    std::uint64_t silent = 0;
    scene.robot.to_host.set(lost_from(from, silent, scene.robot));
    try {
      (void)scene.upload();
      FAIL("nothing came any more");
    } catch (const tool::Failure& failure) {
      CHECK(failure.exit() == tool::Exit::outside);
      CHECK_THAT(failure.what(), Catch::Contains("memory: the board has fallen silent") &&
                                     Catch::Contains(what_runs));
    }
    CHECK(since(silent, scene.robot) < std::chrono::milliseconds(2800));
  };
  fails(link::MessageType::transfer_status, "the old program keeps running");
  fails(link::MessageType::activate_result, "may run");
}

TEST_CASE("another host begins a transfer before the activation: the upload starts again") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::program(4);
  Scene scene(old_program, new_program);
  const link::Begin other{scene.client.session(), 100, {0xBA, 0xD0}, {}};
  std::array<std::byte, link::kMaxEncodedFrame> wire{};
  const std::size_t length =
      link::encode_frame(link::MessageType::begin, 99, link::wire_bytes(other), wire);
  bool done = false;
  scene.robot.to_board.set([&](const Bytes& frame, std::size_t) {
    // COBS does not move the type: it is the second byte.
    if (done || std::to_integer<int>(frame[1]) != static_cast<int>(link::MessageType::activate)) {
      return frame;
    }
    done = true;
    Bytes both(wire.begin(), wire.begin() + static_cast<std::ptrdiff_t>(length));
    both.insert(both.end(), frame.begin(), frame.end());
    return both;
  });
  CHECK(scene.upload().activation.running == 1);
  CHECK(done);
  CHECK(scene.runs_new());
}

TEST_CASE(
    "a piece that is changed in spite of its checksum costs a second transfer, not the upload") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::program(4);
  Scene scene(old_program, new_program);
  bool done = false;
  scene.robot.to_board.set([&](const Bytes& frame, std::size_t) {
    link::FrameDecoder decoder;
    const bool whole =
        std::ranges::any_of(frame, [&](std::byte byte) { return decoder.push(byte); });
    if (done || !whole || decoder.frame().type != link::MessageType::pieces) return frame;
    done = true;
    Bytes payload(decoder.frame().payload.begin(), decoder.frame().payload.end());
    payload.back() ^= std::byte{1};
    std::array<std::byte, link::kMaxEncodedFrame> wire{};
    const std::size_t length =
        link::encode_frame(decoder.frame().type, decoder.frame().sequence, payload, wire);
    return Bytes(wire.begin(), wire.begin() + static_cast<std::ptrdiff_t>(length));
  });
  CHECK(scene.upload().activation.running == 1);
  CHECK(done);
  CHECK(scene.runs_new());
}

TEST_CASE("the host goes away after any byte: the old program goes on, the next upload works") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::program(4);
  const std::size_t all = new_program.bytes().size() + 80;
  for (std::size_t cut = 0; cut < all; cut += 3) {
    INFO("cut after " << cut << " bytes");
    Scene scene(old_program, new_program);
    const link::HelloReply hello = scene.client.hello();
    std::size_t passed = 0;
    scene.robot.to_board.set([&](const Bytes& frame, std::size_t) {
      Bytes part(frame.begin(),
                 frame.begin() + static_cast<std::ptrdiff_t>(std::min(frame.size(), cut - passed)));
      passed += part.size();
      return part;
    });
    tool::UploadOptions options;
    options.timeout = std::chrono::milliseconds(400);
    bool failed = false;
    try {
      const auto result = tool::upload(scene.client, hello, new_program.bytes(), options);
      REQUIRE(result.activation.running == 1);
    } catch (const tool::Failure& failure) {
      failed = failure.exit() == tool::Exit::outside;
    }
    REQUIRE((failed || scene.runs_new()));

    scene.robot.to_board.set({});
    tool::Client next(scene.robot);
    REQUIRE(tool::upload(next, next.hello(), new_program.bytes(), {}).activation.running == 1);
    REQUIRE(scene.runs_new());
  }
}

TEST_CASE("an image with any byte damaged is refused, and the old program goes on") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::program(4);
  Scene scene(old_program, new_program);
  for (std::size_t at = 0; at < new_program.bytes().size(); ++at) {
    INFO("byte " << at);
    Bytes damaged(new_program.bytes().begin(), new_program.bytes().end());
    damaged[at] ^= std::byte{0x10};
    const auto result = tool::upload(scene.client, scene.client.hello(), damaged, {}).activation;
    REQUIRE(result.running == 0);
    REQUIRE(result.refusal != 0);
    REQUIRE(scene.runs_old());
  }
  CHECK(scene.client.status().activations == 1);
  CHECK(scene.upload().activation.running == 1);
}

TEST_CASE("an image other than the one announced is refused") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::program(4);
  Scene scene(old_program, new_program);
  scene.client.hello();
  const Bytes image(new_program.bytes().begin(), new_program.bytes().end());
  const link::ProgramHash other{0xBA, 0xD0};
  test::transfer(scene.robot, scene.client, image, other);
  const link::ActivateResult result = scene.client.activate(
      {.session = 0, .hash = other, .trial_ms = 0, .goes_back = 0, .fresh = 0});
  CHECK(result.running == 0);
  CHECK(result.refusal == static_cast<std::uint8_t>(vm::Refusal::wrong_name));
  CHECK(scene.runs_old());
}

TEST_CASE("a refusal names reason, section and place") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::program(4);
  Scene scene(old_program, new_program);
  Bytes image(new_program.bytes().begin(), new_program.bytes().end());
  // The second instruction gets an invalid opcode; the checksum is corrected.
  const auto code = std::as_bytes(new_program.image().code);
  const auto at = static_cast<std::size_t>(code.data() - new_program.bytes().data()) + 4;
  image[at] = std::byte{0xEE};
  vm::seal(image);
  const auto result = tool::upload(scene.client, scene.client.hello(), image, {}).activation;
  CHECK(result.running == 0);
  CHECK(result.refusal == static_cast<std::uint8_t>(vm::Refusal::bad_opcode));
  CHECK(result.section == static_cast<std::uint8_t>(vm::Section::code));
  CHECK(result.index == 1);
  CHECK(scene.runs_old());
}

TEST_CASE("an upload does not change what the running program does, until it is activated") {
  const tool::Program program = test::program(3);
  const auto trace = [&](bool with_upload) {
    Robot robot;
    tool::Client client(robot);
    const auto first = tool::upload(client, client.hello(), program.bytes(), {});
    REQUIRE(first.activation.running == 1);
    client.set_trace(true);
    const std::uint64_t start = robot.kernel.now() - client.status().program_us;
    for (std::uint64_t at = 0; at < 20; ++at)
      client.feed(
          {.channel = 0, .at_us = 1'000'000 + at * 20'000, .value = at % 2 == 0 ? 2000 : 5000});
    while (robot.kernel.now() < start + 990'000)
      robot.run_tick();
    const std::uint32_t checks = client.status().safety_checks;
    const std::uint64_t from = robot.kernel.now();
    if (with_upload) {
      Bytes damaged(program.bytes().begin(), program.bytes().end());
      damaged.back() ^= std::byte{1};
      // Not hello, which would stop the trace.
      link::HelloReply board{};
      board.receive_window = link::kReceiveWindow;
      REQUIRE(tool::upload(client, board, damaged, {}).activation.running == 0);
    }
    while (robot.kernel.now() < start + 1'500'000)
      robot.run_tick();
    const link::Status status = client.status();
    const double expected = static_cast<double>(robot.kernel.now() - from) / 10'000;
    CHECK(static_cast<double>(status.safety_checks - checks) == Approx(expected).margin(1.5));
    CHECK(status.safety_late_us == 0);
    std::vector<Bytes> events;
    while (const auto message = client.next_unasked(std::chrono::milliseconds(50)))
      events.push_back(message->payload);
    return events;
  };
  const std::vector<Bytes> quiet = trace(false);
  CHECK(quiet.size() > 40);
  CHECK(trace(true) == quiet);
}

TEST_CASE("of what the board runs already nothing travels; the host may be wrong about that") {
  const tool::Program old_program = test::program(3);
  const tool::Program new_program = test::program(4);
  const tool::Program other = test::long_program();
  for (const tool::Program* base : {&old_program, &other}) {
    Scene scene(old_program, new_program);
    tool::UploadOptions options;
    options.base = base->bytes();
    const auto hello = scene.client.hello();
    const auto result = tool::upload(scene.client, hello, new_program.bytes(), options);
    CHECK(result.activation.running == 1);
    CHECK(scene.runs_new());
    CHECK((result.bytes_sent < 120) == (base == &old_program));
  }
}
