// The mailboxes' functions for the safety thread. Readings that become stale are tested with the whole runtime.
#include "runtime-m4/layers/mailbox.hpp"

#include <catch2/catch.hpp>

#include "runtime-m4/sim/arena.hpp"
#include "tests/runtime-m4/peer.hpp"
#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;

TEST_CASE(
    "what never grows old is fresh for 24 days, and not for good: who is not sure looks closely") {
  sim::Arena arena;
  layers::Memory memory(arena.bytes(), arena.board());
  policy::Needs needs = memory.needs();
  needs.counts[policy::Count::channels] = 1;
  memory.lay_out(needs);
  kernel::Kernel kernel;
  layers::Mailboxes mailboxes(kernel);
  mailboxes.start(memory);
  CHECK(mailboxes.are_fresh(kernel.tick() + INT32_MAX - 1));
  CHECK_FALSE(mailboxes.are_fresh(kernel.tick() + INT32_MAX));
  mailboxes.forget(0);
  CHECK_FALSE(mailboxes.are_fresh(kernel.tick()));
}

TEST_CASE("a first reading is fresh for as long as it lasts, to the tick") {
  test::Rig rig;
  REQUIRE(rig.activate(test::compile(test::stops_when_far("MOVE a TO 1%"), R"({
    "sensors": [{"name": "near", "type": "VIRTUAL", "channels": {"X": {"range": [0, 100], "stale_after": "250ms"}}}],
    "actuators": [{"name": "a", "type": "VIRTUAL", "device": "virtual_actuator"}]
  })"))
              .ok());
  rig.run(7);
  REQUIRE(rig.feed(0, 1) == link::FeedError::none);
  const layers::Mailboxes& mailboxes = RuntimePeer::mailboxes(rig.runtime);
  const std::uint32_t last = rig.kernel.tick() + 250;
  rig.run(8);
  CHECK(mailboxes.are_fresh(last));
  CHECK_FALSE(mailboxes.are_fresh(last + 1));
}
