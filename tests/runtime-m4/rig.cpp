// See rig.hpp.
#include "tests/runtime-m4/rig.hpp"

#include <catch2/catch.hpp>

#include "tests/runtime-m4/peer.hpp"
#include "tests/runtime-m4/robot.hpp"

namespace robosync::test {

Rig::Rig(const policy::BoardMemory& memory)
    : EventSink(true), arena(memory), runtime(kernel, board, *this, arena.bytes(), arena.board()) {
  REQUIRE(runtime.start());
}

vm::Verdict Rig::activate(const std::vector<std::byte>& bytes) {
  return runtime.activate(bytes);
}

// With concerns_all, runs in single milliseconds: between two steps there is always the end of one, or an event.
void Rig::run(std::uint64_t until_ms) {
  for (std::uint64_t now = kernel.now() / 1000; concerns_all && now < until_ms; ++now) {
    RuntimePeer::concern_all(runtime);
    kernel.machine().run_until(now * 1000);
  }
  if (concerns_all) RuntimePeer::concern_all(runtime);
  kernel.machine().run_until(until_ms * 1000);
}

link::FeedError Rig::feed(std::uint8_t channel, int units, std::uint64_t at_ms) {
  return feed_raw(channel, units * vm::kScale, at_ms);
}

link::FeedError Rig::feed_raw(std::uint8_t channel, vm::Value thousandths, std::uint64_t at_ms) {
  return runtime.enqueue({.channel = channel, .at_us = at_ms * 1000, .value = thousandths}).error;
}

kernel::Thread& Rig::thread(std::string_view name) {
  for (kernel::Thread* thread : kernel.threads())
    if (thread->name() == name) return *thread;
  FAIL("no thread " << name);
  return kernel.idle();
}

link::Status Rig::status() const {
  link::Status status{};
  runtime.fill_status(status);
  return status;
}

void Rig::emit(const link::Event& event) {
  if (on_event) on_event();
  lines.push_back(describe(event, runtime.image()));
  if (concerns_all) RuntimePeer::concern_all(runtime);
}

std::string Rig::only(std::string_view events) const {
  return select(lines, events);
}

std::string select(const std::vector<std::string>& lines, std::string_view events) {
  std::string some;
  for (const std::string& line : lines) {
    const std::size_t begin = line.find(' ', line.find('#')) + 1;
    const std::string event = line.substr(begin, line.find(' ', begin) - begin);
    if ((" " + std::string(events) + " ").find(" " + event + " ") != std::string::npos)
      some += line + "\n";
  }
  return some;
}

}  // namespace robosync::test
