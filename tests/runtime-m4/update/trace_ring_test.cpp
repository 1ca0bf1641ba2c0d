// The ring of messages to the host: complete, in order, bounded, counted.
#include "runtime-m4/update/trace_ring.hpp"

#include <string>

#include <catch2/catch.hpp>

using namespace robosync;

namespace {

std::string take(update::TraceRing& ring) {
  link::MessageType type{};
  std::array<std::byte, link::kMaxPayload> payload{};
  const std::size_t length = ring.take(type, payload);
  if (length > 0) CHECK(type == link::MessageType::log);
  return {reinterpret_cast<const char*>(payload.data()), length};
}

}  // namespace

TEST_CASE("nothing is kept while nobody listens") {
  kernel::Kernel kernel;
  update::TraceRing ring(kernel);
  ring.log("before");
  ring.emit({});
  ring.listen(true);
  CHECK(take(ring).empty());
  CHECK(ring.lost() == 0);
  ring.log("now");
  CHECK(take(ring) == "now");
  ring.log("left");
  ring.listen(false);
  ring.listen(true);
  CHECK(take(ring).empty());
}

TEST_CASE("who reads is called for the first message, and again when all are taken") {
  kernel::Kernel kernel;
  update::TraceRing ring(kernel);
  struct Reader {
    kernel::Kernel& kernel;
    kernel::Thread thread;
    unsigned calls = 0;
  } reader{kernel, {}};
  constexpr kernel::Events kNews = 4;
  const auto count = [](void* self) {
    auto& mine = *static_cast<Reader*>(self);
    while (mine.kernel.wait(kNews) != 0)
      ++mine.calls;
  };
  kernel::ThreadSpec spec;
  spec.entry = count;
  spec.argument = &reader;
  REQUIRE(kernel.add(reader.thread, spec));
  ring.wake(reader.thread, kNews);
  const auto calls_after = [&](unsigned messages) {
    for (unsigned i = 0; i < messages; ++i)
      ring.log("message");
    kernel.machine().run_until(kernel.now());
    return reader.calls;
  };
  CHECK(calls_after(3) == 0);  // no host listens
  ring.listen(true);
  CHECK(calls_after(3) == 1);
  CHECK(calls_after(100) == 1);  // the reader has not taken them yet; the last ones are lost
  while (!take(ring).empty()) {
  }
  CHECK(calls_after(0) == 1);
  CHECK(calls_after(2) == 2);
  ring.listen(false);
  ring.listen(true);
  CHECK(calls_after(1) == 3);
}

TEST_CASE("listening again keeps what waits") {
  kernel::Kernel kernel;
  update::TraceRing ring(kernel);
  ring.listen(true);
  ring.log("waits");
  ring.listen(true);
  CHECK(take(ring) == "waits");
}

TEST_CASE("messages come out whole and in order, through many turns of the ring") {
  kernel::Kernel kernel;
  update::TraceRing ring(kernel);
  ring.listen(true);
  unsigned put = 0;
  unsigned taken = 0;
  const auto message = [](unsigned number) {
    return std::to_string(number) +
           std::string(number * 7 % 200, static_cast<char>('a' + number % 26));
  };
  while (put < 3000) {
    for (unsigned i = 0; i < 1 + put % 4; ++i)
      ring.log(message(put++));
    while (taken < put - (put % 3 == 0 ? 1 : 0))
      REQUIRE(take(ring) == message(taken++));
  }
  CHECK(ring.lost() == 0);
}

TEST_CASE("a full ring drops what is new, counts it, and goes on afterwards") {
  kernel::Kernel kernel;
  update::TraceRing ring(kernel);
  ring.listen(true);
  const std::string line(100, 'x');
  for (int i = 0; i < 50; ++i)
    ring.log(line + std::to_string(i));
  std::uint32_t kept = 0;
  for (std::string text = take(ring); !text.empty(); text = take(ring))
    CHECK(text == line + std::to_string(kept++));
  CHECK(kept > 5);
  CHECK(kept + ring.lost() == 50);
  ring.log("again");
  CHECK(take(ring) == "again");
}

TEST_CASE("a line that is too long is cut, not lost") {
  kernel::Kernel kernel;
  update::TraceRing ring(kernel);
  ring.listen(true);
  ring.log(std::string(1000, 'y'));
  CHECK(take(ring) == std::string(link::kMaxPayload, 'y'));
}
