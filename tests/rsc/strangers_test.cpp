// What is at the other end of a line, but is no board with this release's firmware: something that sends other bytes, older
// firmware, or something that takes nothing.
#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include <catch2/catch.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/rsc/device.hpp"

using namespace robosync;
using Catch::Contains;
using test::listen_at;
using test::Outcome;
using test::RobotFolder;

namespace {

// At the other end of a socket: sends `answer` again and again once it has heard something.
class Talker {
public:
  Talker(int listener, std::vector<std::byte> answer)
      : listener_(listener), answer_(std::move(answer)), thread_([this] { run(); }) {}
  ~Talker() {
    stop_ = true;
    thread_.join();
    close(listener_);
  }
  Talker(const Talker&) = delete;
  Talker& operator=(const Talker&) = delete;

private:
  void run() {
    int line = -1;
    while (!stop_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (line < 0) line = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK);
      std::array<std::byte, 512> bytes{};
      if (line < 0) continue;
      const ssize_t count = ::read(line, bytes.data(), bytes.size());
      if (count == 0) close(std::exchange(line, -1));
      if (count > 0) has_heard_ = true;
      if (line >= 0 && has_heard_) (void)send(line, answer_.data(), answer_.size(), MSG_NOSIGNAL);
    }
    if (line >= 0) close(line);
  }

  int listener_;
  std::vector<std::byte> answer_;
  std::atomic<bool> stop_ = false;
  bool has_heard_ = false;
  std::thread thread_;
};

// A hello_reply of another protocol version with each sequence number, so that one of them fits.
std::vector<std::byte> old_firmware() {
  std::vector<std::byte> all;
  for (unsigned sequence = 0; sequence < 16; ++sequence) {
    std::array<std::byte, link::kMaxEncodedFrame> frame{};
    const std::size_t length =
        link::encode_frame(link::MessageType::hello_reply, static_cast<std::uint8_t>(sequence),
                           std::array{std::byte{link::kProtocolVersion - 1}}, frame);
    all.insert(all.end(), frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(length));
  }
  return all;
}

}  // namespace

TEST_CASE("something that sends, but is no RoboSync firmware, is named") {
  const RobotFolder robot;
  std::vector<std::byte> noise;
  for (int i = 0; i < 50; ++i)
    noise.push_back(static_cast<std::byte>(i * 37 % 256));
  const Talker talker(listen_at(robot.path("noise")), noise);
  const std::string port = "unix:" + robot.path("noise");
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"info", "--port", port}, {"upload", robot.program, "--port", port}}) {
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = test::rsc(arguments);
    CAPTURE(outcome.err);
    CHECK(outcome.exit == 3);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
    CHECK_THAT(outcome.err,
               Contains("something on " + port + " sends bytes, but not RoboSync's frames (") &&
                   Contains("115,200 baud"));
  }
}

TEST_CASE("a name from the line cannot command a terminal") {
  const link::Name name{'a', '\x1B', '[', '2', 'J', '\0', 'b'};
  CHECK(tool::text_of(name) == "a\xEF\xBF\xBD[2J");
}

TEST_CASE("firmware of another protocol version is named by every verb, also by stop") {
  const RobotFolder robot;
  const Talker talker(listen_at(robot.path("old")), old_firmware());
  const std::string port = "unix:" + robot.path("old");
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"info", "--port", port},
                                             {"upload", robot.program, "--port", port},
                                             {"stop", "--port", port}}) {
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = test::rsc(arguments);
    CAPTURE(arguments.front(), outcome.err);
    CHECK(outcome.exit == 3);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
    CHECK_THAT(outcome.err, Contains("the firmware speaks version ") &&
                                Contains("flash the firmware of this release"));
  }
}

TEST_CASE("a line that takes no bytes is an error that says so, after two seconds") {
  const RobotFolder robot;
  const int listener = listen_at(robot.path("full"));
  const std::unique_ptr<tool::Transport> transport = tool::open_port("unix:" + robot.path("full"));
  const auto start = std::chrono::steady_clock::now();
  CHECK_THROWS_WITH(transport->write(std::vector<std::byte>(std::size_t{16} << 20)),
                    Contains("full: the line takes no bytes"));
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
  close(listener);
}
