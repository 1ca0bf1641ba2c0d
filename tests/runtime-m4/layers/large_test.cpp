// A large program: 64 behaviours and 1,000 rules, on a board that has the memory.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/layers/spread.hpp"
#include "tests/runtime-m4/peer.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;

TEST_CASE("64 behaviours, 1,000 rules, 64 KB: one reading evaluates and fires the one rule") {
  const test::Spread spread{
      .rules = 1000, .behaviors = 64, .channels = 32, .text = " is what fired"};
  const auto bytes = test::compile(spread.rsl(), spread.json());
  INFO(bytes.size() << " bytes");
  CHECK(bytes.size() > 60'000);
  CHECK(bytes.size() <= 65'536);
  policy::BoardMemory memory = boards::kMemory;
  memory.arena_bytes = 256 * 1024;
  test::Rig rig(memory);
  REQUIRE(rig.activate(bytes).ok());
  for (std::uint8_t c = 0; c < spread.channels; ++c)
    REQUIRE(rig.feed(c, 0) == link::FeedError::none);
  rig.run(10);
  std::uint64_t now = 10;
  for (const unsigned rule : {0U, 1U, 255U, 256U, 517U, 999U}) {
    const auto channel = static_cast<std::uint8_t>(spread.channel_of(rule));
    rig.lines.clear();
    const std::uint32_t before = test::evaluations();
    REQUIRE(rig.feed(channel, spread.value_of(rule)) == link::FeedError::none);
    rig.run(++now);
    CHECK(test::select(rig.lines, "fire").find(" fire r" + std::to_string(rule) + " DO\n") !=
          std::string::npos);
    CHECK(test::select(rig.lines, "fire log finished").size() < 120);
    // All rules of the channel compare with it; no other rule is evaluated.
    const unsigned readers = (spread.rules + spread.channels - 1 - channel) / spread.channels;
    CHECK(test::evaluations() - before == readers);
  }
}
