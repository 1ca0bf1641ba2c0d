// The queues of commands: what is staged is not seen by its actuator, and is left when what was handed over goes.
#include "runtime-m4/layers/command_pool.hpp"

#include <catch2/catch.hpp>

#include "runtime-m4/sim/arena.hpp"

using namespace robosync;
using layers::Command;
using layers::CommandPool;

namespace {

constexpr unsigned kPlaces = 5;

struct Pool {
  Pool() {
    policy::Needs needs;
    needs.counts[policy::Count::commands] = kPlaces;
    memory.lay_out(needs);
    pool.start(memory);
  }
  // Pushes `count` commands, and returns the last.
  const Command* push(unsigned count) {
    const Command* last = nullptr;
    for (unsigned i = 0; i < count; ++i) {
      last = pool.push(queue);
      REQUIRE(last != nullptr);
    }
    return last;
  }
  void check(unsigned count, unsigned handed) const {
    CHECK(queue.count == count);
    CHECK(queue.handed == handed);
  }
  // All places are free again.
  void check_all_free() {
    CommandPool::Queue all;
    for (unsigned i = 0; i < kPlaces; ++i)
      CHECK(pool.push(all) != nullptr);
    CHECK(pool.push(all) == nullptr);
  }

  sim::Arena arena;
  layers::Memory memory{arena.bytes(), arena.board()};
  CommandPool pool;
  CommandPool::Queue queue;
};

}  // namespace

TEST_CASE("commands leave their queue in order, and only when they were handed over") {
  Pool test;
  const Command* const first = test.push(1);
  test.queue.hand_over();
  const Command* const second = test.push(1);
  test.check(2, 1);
  CHECK(test.queue.has_staged());
  CHECK(&CommandPool::front(test.queue) == first);
  test.pool.pop(test.queue);
  test.check(1, 0);
  test.queue.hand_over();
  CHECK(&CommandPool::front(test.queue) == second);
  test.pool.pop(test.queue);
  test.check(0, 0);
  test.check_all_free();
}

TEST_CASE("what was handed over goes, and what is staged stays") {
  Pool test;
  test.push(2);
  test.queue.hand_over();
  const Command* const staged = test.push(1);
  test.pool.drop_handed(test.queue);
  test.check(1, 0);
  CHECK(&CommandPool::front(test.queue) == staged);
  test.pool.drop_staged(test.queue);
  test.check(0, 0);
  test.check_all_free();
}

TEST_CASE("what waits goes, and its actuator sees no more than is left") {
  Pool test;
  const Command* const first = test.push(1);
  test.push(2);
  test.queue.hand_over();
  test.push(1);
  test.queue.begun = GENERATE(false, true);
  test.pool.drop_waiting(test.queue);
  const unsigned left = test.queue.begun ? 1 : 0;
  test.check(left, left);
  if (left != 0) CHECK(&CommandPool::front(test.queue) == first);
  const Command* const next = test.push(1);
  test.queue.hand_over();
  if (left != 0) test.pool.pop(test.queue);
  CHECK(&CommandPool::front(test.queue) == next);
  test.pool.pop(test.queue);
  test.check_all_free();
}
