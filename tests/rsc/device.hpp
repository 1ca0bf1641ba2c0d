// A robot that runs in this process (the real kernel, runtime and server) at the other end of a line that the built rsc opens.
#pragma once

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"
#include "tests/runtime-m4/update/robot.hpp"

namespace robosync::test {

// Carries bytes between a file descriptor and the robot, whose time follows the clock.
class Bridge {
public:
  static constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

  // `accepting`: `file` is a listening socket; else the line itself.
  Bridge(int file, bool accepting, const policy::BoardMemory& memory = boards::kMemory)
      : file_(file), accepting_(accepting), memory_(memory) {
    thread_ = std::thread([this] { run(); });
  }
  ~Bridge() {
    stop_ = true;
    thread_.join();
    close(file_);
  }
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;

  void wait_until_heard() const { heard_.wait(0); }
  std::size_t bytes_heard() const { return heard_; }
  // Closes the line, as a plug does that is pulled; then takes the next who comes.
  void hang_up() { hangs_up_ = true; }
  // Another robot without a program is at the line from now on, as after a reset without a store.
  void reset() { resets_ = true; }
  // From now on the robot's answers are lost after this many bytes, or from the moment that a program runs.
  void fall_silent_after(std::size_t bytes) { bytes_said_ = 0, says_at_most_ = bytes; }
  void fall_silent_with_program() { silent_with_program_ = true; }
  // Closes the line when the robot has answered this many bytes.
  void hang_up_after(std::size_t bytes) { bytes_said_ = 0, hangs_up_at_ = bytes; }

private:
  void run() {
    int line = accepting_ ? -1 : file_;
    while (!stop_) {
      resets_ = false;
      live(line);
    }
    if (accepting_ && line >= 0) close(line);
  }

  // From a start of the robot to its reset.
  void live(int& line) {
    Robot robot(memory_);
    const auto start = std::chrono::steady_clock::now();
    while (!stop_ && !resets_) {
      if (line < 0) line = accept4(file_, nullptr, nullptr, SOCK_NONBLOCK);
      if (line >= 0 && (hangs_up_.exchange(false) || !carry(robot, line))) {
        if (accepting_) close(std::exchange(line, -1));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      // Bounded, so that a busy machine does not make it run away from its line.
      for (int i = 0;
           i < 20 && robot.now().time_since_epoch() < std::chrono::steady_clock::now() - start;
           ++i) {
        robot.run_tick();
      }
    }
  }

  bool carry(test::Robot& robot, int line) {
    std::array<std::byte, 512> bytes{};
    const ssize_t count = ::read(line, bytes.data(), bytes.size());
    if (count > 0) {
      robot.write(std::span(bytes).first(static_cast<std::size_t>(count)));
      heard_ += static_cast<std::size_t>(count);
      heard_.notify_all();
    }
    if (count == 0 || (count < 0 && errno != EAGAIN)) return false;
    const std::size_t ready = robot.read(bytes, std::chrono::milliseconds(0));
    if (bytes_said_ + ready > hangs_up_at_) {
      hangs_up_at_ = kNever;
      return false;
    }
    return ready == 0 || is_silent(robot, ready) || write(line, std::span(bytes).first(ready)) >= 0;
  }

  bool is_silent(const test::Robot& robot, std::size_t ready) {
    bytes_said_ += ready;
    return bytes_said_ > says_at_most_ || (silent_with_program_ && robot.runtime.running());
  }

  // Whoever listened may have hung up since it was read: an error, and no signal that ends this process.
  [[nodiscard]] ssize_t write(int line, std::span<const std::byte> bytes) const {
    return accepting_ ? send(line, bytes.data(), bytes.size(), MSG_NOSIGNAL)
                      : ::write(line, bytes.data(), bytes.size());
  }

  int file_;
  bool accepting_;
  policy::BoardMemory memory_;
  std::atomic<bool> stop_ = false;
  std::atomic<bool> hangs_up_ = false, resets_ = false;
  std::atomic<bool> silent_with_program_ = false;
  std::atomic<std::size_t> bytes_said_ = 0;
  std::atomic<std::size_t> says_at_most_ = kNever, hangs_up_at_ = kNever;
  std::atomic<std::size_t> heard_ = 0;
  std::thread thread_;
};

inline int open_pty_master() {
  const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  REQUIRE(master >= 0);
  REQUIRE(grantpt(master) == 0);
  REQUIRE(unlockpt(master) == 0);
  return master;
}

inline int listen_at(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, path.size());
  const int file = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0);
  REQUIRE(bind(file, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  REQUIRE(listen(file, 1) == 0);
  return file;
}

struct Device : RobotFolder {
  explicit Device(std::uint32_t arena_bytes = boards::kMemory.arena_bytes)
      : bridge(listen_at(path("line")), true,
               {boards::kMemory.arena_begin, arena_bytes, boards::kMemory.step_budget}) {}

  std::string port = "unix:" + path("line");
  Bridge bridge;

  Outcome run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--port", port});
    return rsc(std::move(arguments));
  }
};

}  // namespace robosync::test
