// A whole robot for tests of the link: the real kernel, runtime and server on the host port, and a
// serial line in memory at 115,200 baud that can damage frames. Time is virtual: it
// advances only while the host waits for the line.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rsc/device/transport.hpp"
#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/boards/pins.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/runtime.hpp"
#include "runtime-m4/sim/arena.hpp"
#include "runtime-m4/update/server.hpp"
#include "runtime-m4/update/trace_ring.hpp"

namespace robosync::test {

using Bytes = std::vector<std::byte>;

// Called with each frame in one direction (with its delimiter) and its number from 0. The returned bytes
// go over the line instead.
using Damage = std::function<Bytes(const Bytes& frame, std::size_t number)>;

// A board with only a line: rings of the UART driver's size on both sides.
class LineBoard final : public boards::Board {
public:
  static constexpr std::size_t kRing = 512;

  LineBoard(boards::Store* store, link::ResetReason reset_reason)
      : store_(store), reset_reason_(reset_reason) {}

  const char* name() const override { return "mps2-an386"; }
  link::ResetReason reset_reason() const override { return reset_reason_; }
  const policy::BoardPins& pins() const override { return boards::kPins; }
  bool i2c_transfer(std::uint8_t, std::uint8_t, std::span<const std::byte>,
                    std::span<std::byte>) override {
    return false;
  }
  bool i2c_select(std::uint8_t, std::uint8_t, std::span<const std::byte>) override { return false; }
  // No device on its bus answers, because a line is held low.
  boards::BusState buses() const override { return {.clears = 2, .held = 1}; }
  bool input(std::uint16_t) const override { return true; }
  void pwm_write(std::uint16_t, std::uint32_t) override {}
  std::uint32_t pwm_read(std::uint16_t) const override { return 0; }
  boards::Store* store() override { return store_; }
  void watchdog_start() override {}
  void watchdog_kick() override {}
  std::uint32_t watchdog_ms() const override { return 50; }

  std::size_t link_write(std::span<const std::byte> bytes) override {
    const std::size_t count = std::min(bytes.size(), kRing - to_host.size());
    to_host.insert(to_host.end(), bytes.begin(),
                   bytes.begin() + static_cast<std::ptrdiff_t>(count));
    if (count < bytes.size()) wants_room_ = true;
    return count;
  }
  std::size_t link_read(std::span<std::byte> bytes) override {
    const std::size_t count = std::min(bytes.size(), from_host.size());
    std::copy_n(from_host.begin(), count, bytes.begin());
    from_host.erase(from_host.begin(), from_host.begin() + static_cast<std::ptrdiff_t>(count));
    watched_ -= std::min(watched_, count);
    return count;
  }

  void link_start(const boards::LineEvents& events) override { events_ = events; }
  // Does what the UART's interrupts would do after a millisecond.
  void interrupt() {
    const bool room = std::exchange(wants_room_, wants_room_ && to_host.size() > kRing / 2);
    for (; watched_ < from_host.size(); ++watched_)
      if (stops_.push(from_host[watched_])) events_.stop(events_.argument);
    if (!from_host.empty() || (room && !wants_room_)) events_.ready(events_.argument);
  }

  std::deque<std::byte> from_host, to_host;

private:
  boards::Store* store_;
  link::ResetReason reset_reason_;
  bool wants_room_ = false;
  std::size_t watched_ = 0;  // bytes of from_host that the interrupt has seen
  link::StopDetector stops_;
  boards::LineEvents events_;
};

// One direction of the line: splits the stream into frames and passes each through the damage.
class Way {
public:
  void set(Damage damage) {
    damage_ = std::move(damage);
    frames_ = 0;
  }
  std::size_t frames() const { return frames_; }

  void put(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) {
      frame_.push_back(byte);
      if (byte != std::byte{0}) continue;
      const Bytes passed = damage_ ? damage_(frame_, frames_) : frame_;
      line_.insert(line_.end(), passed.begin(), passed.end());
      ++frames_;
      frame_.clear();
    }
  }
  std::deque<std::byte>& line() { return line_; }

private:
  Damage damage_;
  Bytes frame_;
  std::size_t frames_ = 0;
  std::deque<std::byte> line_;
};

class Robot final : public tool::Transport {
public:
  static constexpr unsigned kBytesPerSecond = 11520;  // 115,200 baud, 8N1

  explicit Robot(const policy::BoardMemory& memory = boards::kMemory,
                 boards::Store* store = nullptr,
                 link::ResetReason reset_reason = link::ResetReason::software)
      : board(store, reset_reason),
        ring(kernel),
        arena(memory),
        runtime(kernel, board, ring, arena.bytes(), arena.board()),
        server(kernel, board, runtime, ring) {
    started = runtime.start() && server.start();
  }

  // The host's end of the line.
  std::size_t read(std::span<std::byte> bytes, std::chrono::milliseconds timeout) override {
    for (auto left = timeout.count(); left > 0 && received_.empty(); --left)
      run_tick();
    const std::size_t count = std::min(bytes.size(), received_.size());
    std::copy_n(received_.begin(), count, bytes.begin());
    received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  void write(std::span<const std::byte> bytes) override { to_board.put(bytes); }
  std::string name() const override { return "memory"; }
  Clock::time_point now() const override {
    return Clock::time_point(std::chrono::microseconds(kernel.now()));
  }

  void run(std::uint64_t milliseconds) {
    for (; milliseconds > 0; --milliseconds)
      run_tick();
  }
  // One millisecond of the robot and the line.
  void run_tick() {
    const std::size_t budget = kBytesPerSecond * (kernel.now() / 1000 + 1) / 1000 -
                               kBytesPerSecond * (kernel.now() / 1000) / 1000;
    for (std::size_t i = 0; i < budget && !to_board.line().empty(); ++i) {
      if (board.from_host.size() < LineBoard::kRing) {
        board.from_host.push_back(to_board.line().front());
      } else {
        ++overruns;
      }
      to_board.line().pop_front();
    }
    board.interrupt();
    kernel.machine().run_until(kernel.now() + kernel::kTick);
    for (std::size_t i = 0; host_reads && i < budget && !board.to_host.empty(); ++i) {
      to_host.put(std::array{board.to_host.front()});
      board.to_host.pop_front();
    }
    received_.insert(received_.end(), to_host.line().begin(), to_host.line().end());
    to_host.line().clear();
    if (each_tick) each_tick();
  }

  kernel::Kernel kernel;
  LineBoard board;
  update::TraceRing ring;
  sim::Arena arena;
  Runtime runtime;
  update::Server server;
  bool started = false;

  Way to_board, to_host;
  bool host_reads = true;
  std::size_t overruns = 0;         // bytes lost because the board's receive ring was full
  std::function<void()> each_tick;  // called after each millisecond

private:
  std::deque<std::byte> received_;
};

}  // namespace robosync::test
