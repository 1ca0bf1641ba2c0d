// The mailboxes' functions for the safety thread. Readings that become stale are tested with the whole runtime.
#include "runtime-m4/layers/mailbox.hpp"

#include <catch2/catch.hpp>

#include "runtime-m4/sim/arena.hpp"

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
