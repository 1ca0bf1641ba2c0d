// The two ends of the link, each against forged frames: their checksum is right, and what is in them is not. An input drives the
// real host code against the real board code on the host port, and says which frames of one direction are forged, and how.
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "compiler/compiler.hpp"
#include "link/events.hpp"
#include "link/frame.hpp"
#include "rsc/device/devices.hpp"
#include "rsc/device/keeping.hpp"
#include "rsc/device/past.hpp"
#include "rsc/device/threads.hpp"
#include "rsc/device/uploader.hpp"
#include "rsc/failure.hpp"
#include "rsc/program.hpp"
#include "rsc/trace/trace_format.hpp"
#include "tests/fuzz/texts/require.hpp"
#include "tests/fuzz/texts/targets.hpp"
#include "tests/runtime-m4/update/memory_store.hpp"
#include "tests/runtime-m4/update/robot.hpp"
#include "vm/identity.hpp"
#include "vm/verifier.hpp"

namespace robosync::fuzz {
namespace {

using std::chrono::milliseconds;
using test::Bytes;
using test::MemoryStore;
using test::Robot;

constexpr std::uint32_t kStoreBytes = 8192;
constexpr std::size_t kPrograms = 2;
constexpr milliseconds kPatience(200);

// The input, read from its beginning; zeros follow it.
class Script {
public:
  explicit Script(std::string_view input) : rest_(input) {}
  [[nodiscard]] bool has_ended() const { return rest_.empty(); }
  std::uint8_t byte() {
    const std::string_view one = take(1);
    return one.empty() ? 0 : static_cast<std::uint8_t>(one.front());
  }
  Bytes bytes(std::size_t most) {
    const auto* const begin = reinterpret_cast<const std::byte*>(rest_.data());
    return {begin, begin + take(most).size()};
  }

private:
  std::string_view take(std::size_t most) {
    const std::string_view taken = rest_.substr(0, most);
    rest_.remove_prefix(taken.size());
    return taken;
  }
  std::string_view rest_;
};

Bytes encoded(link::MessageType type, std::uint8_t sequence, std::span<const std::byte> payload) {
  std::array<std::byte, link::kMaxEncodedFrame> frame;
  const std::size_t length = link::encode_frame(
      type, sequence, payload.first(std::min(payload.size(), link::kMaxPayload)), frame);
  return {frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(length)};
}

// What goes over the line instead of a frame.
class Forger {
public:
  explicit Forger(Script& script) : script_(script) {}

  Bytes operator()(const Bytes& frame, std::size_t /*number*/) {
    if (script_.has_ended()) return frame;
    link::FrameDecoder decoder;
    for (const std::byte byte : frame)
      if (decoder.push(byte)) return forged(decoder.frame(), frame);
    return frame;
  }

private:
  enum Way : std::uint8_t {
    whole,
    changed,
    resized,
    retyped,
    replaced,
    doubled,
    lost,
    behind_noise,
    kWays
  };

  Bytes forged(const link::Frame& frame, const Bytes& as_sent) {
    Bytes payload(frame.payload.begin(), frame.payload.end());
    link::MessageType type = frame.type;
    switch (script_.byte() % kWays) {
      case changed:
        for (unsigned count = 1 + script_.byte() % 4; count > 0 && !payload.empty(); --count) {
          const std::size_t at = script_.byte() % payload.size();
          payload[at] = std::byte{script_.byte()};
        }
        break;
      case resized: {
        const std::size_t length = script_.byte();
        payload.resize(length, std::byte{script_.byte()});
        break;
      }
      case retyped:
        type = static_cast<link::MessageType>(script_.byte());
        break;
      case replaced:
        type = static_cast<link::MessageType>(script_.byte());
        payload = script_.bytes(script_.byte());
        break;
      case doubled:
        payload = as_sent;
        payload.insert(payload.end(), as_sent.begin(), as_sent.end());
        return payload;
      case lost:
        return {};
      case behind_noise:
        payload = script_.bytes(script_.byte());
        payload.insert(payload.end(), as_sent.begin(), as_sent.end());
        return payload;
      default:
        return as_sent;
    }
    return encoded(type, frame.sequence, payload);
  }

  Script& script_;
};

tool::Program compiled(int threshold) {
  const std::string text =
      "SAFETY guard\n  WHEN touch LEVEL > 9\n  DO STOP ALL\nEND\nREMEMBER visits = 0 KEPT\nWHEN "
      "touch LEVEL < " +
      std::to_string(threshold) + " DO\n  MOVE arm TO 90deg\n  SET visits TO visits + 1\nEND\n";
  compiler::Result result = compiler::compile({"fuzz.rsl", text}, {"robot.json", R"({
    "sensors": [{"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}}],
    "actuators": [{"name": "arm", "type": "PWM", "pin": 10, "device": "servo", "range": ["0deg", "120deg"]}]})"});
  require(!result.image.empty(), "the fuzzer's own program does not compile");
  return {std::move(result.image), "fuzz.rsl"};
}
const tool::Program& program(std::size_t number) {
  static const std::array programs{compiled(3), compiled(5)};
  return programs[number % kPrograms];
}

// One robot that keeps programs, and a host that does what the script says.
class Scene {
public:
  explicit Scene(Script& script)
      : script_(script),
        memory_(kStoreBytes),
        robot_(boards::kMemory, &memory_,
               script.byte() % 2 == 0 ? link::ResetReason::software : link::ResetReason::power) {
    robot_.each_tick = [this] { look(); };
    upload(program(0));
  }

  Robot& robot() { return robot_; }

  void play() {
    for (unsigned count = 0; count < kMaxActions && !script_.has_ended(); ++count) {
      try {
        act();
      } catch (const tool::Failure& failure) {
        require(*failure.what() != '\0', "a failure says nothing");
      }
    }
  }

  // The line is well again: the robot answers, and takes another program.
  void end() {
    robot_.to_board.set({});
    robot_.to_host.set({});
    try {
      tool::Client client(robot_, milliseconds(2000), true);
      (void)client.status();
      if (client.hello().pairing == link::Pairing::paired) return;  // by whom the script let in
      client.resume();
      upload(program(1));
    } catch (const tool::Failure& failure) {
      require(false, failure.what());
    }
    require(robot_.runtime.running(), "no program runs in the end");
  }

private:
  static constexpr unsigned kMaxActions = 24;

  void upload(const tool::Program& which) {
    tool::Client client(robot_, kPatience, true);
    tool::UploadOptions options;
    options.timeout = milliseconds(600);
    options.trial = milliseconds(100);
    options.base = program(script_.byte()).bytes();
    (void)tool::upload(client, client.hello(), which.bytes(), options);
  }

  void act() {
    tool::Client client(robot_, kPatience, script_.byte() % 2 == 0);
    const std::uint8_t argument = script_.byte();
    switch (argument % 8) {
      case 0:
        return upload(program(argument / 8));
      case 1:
        return ask(client);
      case 2:
        return watch(client);
      case 3:
        (void)client.feed({.channel = static_cast<std::uint8_t>(argument / 128),
                           .at_us = 0,
                           .value = argument * 50});
        return;
      case 4:
        (void)tool::roll_back(client);
        return;
      case 5:
        (void)client.clear(client.hello().program_hash);
        return;
      case 6:
        (void)(argument / 8 % 2 == 0 ? client.stop() : client.resume());
        return;
      default:
        robot_.run(argument);
    }
  }

  // What `rsc info` asks, and how it says it.
  static void ask(tool::Client& client) {
    const link::HelloReply board = client.hello();
    std::vector<std::byte> bytes = client.running_image();
    vm::Image image;
    if (vm::verify(bytes, vm::Limits{}, image).ok()) {
      (void)tool::obstacles(board, image);
      for (const tool::OnBus& device : tool::on_buses(image, client.devices()))
        (void)tool::silent_text(device);
    }
    const tool::Past past(client);
    (void)tool::past_text(past.status);
    (void)tool::fault_text(past.fault);
    say(tool::last_fault_json(past));
    const std::vector<link::ThreadInfo> threads = client.threads();
    (void)tool::threads_table(threads, threads);
    say(tool::threads_json(threads, {}));
    const link::Kept kept = client.kept();
    (void)tool::keeping_text(kept);
    say(tool::keeping_json(kept));
    (void)client.authority();
  }
  static void say(const nlohmann::ordered_json& report) {
    (void)report.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  }

  // What `rsc monitor` prints of what comes unasked.
  static void watch(tool::Client& client) {
    const std::vector<std::byte> bytes = client.running_image();
    vm::Image image;
    tool::TraceNames names;
    if (vm::verify(bytes, vm::Limits{}, image).ok()) names.image = &image;
    (void)client.hello();  // which ends the trace, so it comes first
    (void)client.set_trace(true);
    (void)client.feed({.channel = 0, .at_us = 0, .value = 1000});
    for (unsigned count = 0; count < 20; ++count) {
      const auto message = client.next_unasked(milliseconds(20));
      link::Event event;
      link::Fault fault{};
      if (!message) continue;
      if (message->type == link::MessageType::event &&
          link::decode_event(message->payload, event)) {
        (void)tool::trace_json(event, names);
        (void)tool::trace_line(event, names);
      } else if (link::read_payload(message->payload, fault)) {
        (void)tool::fault_text(fault);
      }
    }
  }

  // What runs has the name of its bytes, whatever came over the line.
  void look() {
    if (!robot_.runtime.running()) return;
    const vm::ImageHeader& header = *robot_.runtime.image().header;
    if (seen_ == header.program_hash) return;
    seen_ = header.program_hash;
    const std::span image(reinterpret_cast<const std::byte*>(&header), header.total_length);
    require(vm::is_named(image, {}), "a program runs under a name that is not its own");
  }

  Script& script_;
  MemoryStore memory_;
  Robot robot_;
  link::ProgramHash seen_{};
};

void forge(test::Way Robot::*direction, std::string_view input) {
  Script script(input);
  Scene scene(script);
  (scene.robot().*direction).set(Forger(script));
  scene.play();
  scene.end();
}

}  // namespace

void board(std::string_view input) {
  forge(&Robot::to_board, input);
}
void host(std::string_view input) {
  forge(&Robot::to_host, input);
}

}  // namespace robosync::fuzz
