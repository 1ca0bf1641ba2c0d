// The kernel's order after any changes of priorities, compared with a sorted order.
#include <algorithm>
#include <list>
#include <vector>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "runtime-m4/kernel/kernel.hpp"

using namespace robosync::kernel;

namespace {

struct Member {
  Thread thread;
  Category category{};
  Priority priority;
};

std::string order_of(const Kernel& kernel) {
  std::string order;
  for (const Thread* thread : kernel.threads())
    order += std::string(thread->name()) + " ";
  return order;
}

// Changes all priorities of one window, in the order of the threads' age: the result is the same as if all were removed and
// added again.
void ranks_are_sorted() {
  static constexpr const char* kNames[] = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"};
  Kernel kernel;
  std::list<Member> members;
  const unsigned count = *rc::gen::inRange(1U, 11U);
  for (unsigned i = 0; i < count; ++i) {
    Member& member = members.emplace_back();
    member.category = static_cast<Category>(*rc::gen::inRange(0, 6));
    const auto base = *rc::gen::inRange<std::int8_t>(1, 5);
    member.priority = {base, base};
    RC_ASSERT(kernel.add(member.thread, {.name = kNames[i],
                                         .category = member.category,
                                         .priority = base,
                                         .entry = [](void*) {},
                                         .argument = nullptr,
                                         .stack = {}}));
  }
  const unsigned windows = *rc::gen::inRange(1U, 5U);
  for (unsigned window = 0; window < windows; ++window) {
    for (Member& member : members) {
      member.priority.now = *rc::gen::inRange<std::int8_t>(1, 5);
      kernel.set_priority(member.thread, member.priority);
    }
    std::vector<const Member*> sorted;
    for (const Member& member : members)
      sorted.push_back(&member);
    std::stable_sort(sorted.begin(), sorted.end(), [](const Member* one, const Member* other) {
      return standing(one->category, one->priority) > standing(other->category, other->priority);
    });
    for (std::size_t rank = 0; rank < sorted.size(); ++rank) {
      RC_ASSERT(kernel.threads()[rank] == &sorted[rank]->thread);
      RC_ASSERT(sorted[rank]->thread.rank() == rank);
      RC_ASSERT(kernel.state(sorted[rank]->thread) == Thread::State::ready);
    }
  }
}

}  // namespace

TEST_CASE("after each window the threads stand as if they were sorted anew") {
  CHECK(rc::check(ranks_are_sorted));
}

TEST_CASE("who is overtaken while it runs gives way at once; who blocks stays blocked") {
  Kernel kernel;
  static std::string log;
  log.clear();
  struct Cast {
    Kernel& kernel;
    Thread runs, ready, waits;
  } cast{kernel, {}, {}, {}};
  const auto add = [&](Thread& thread, const char* name, std::int16_t priority,
                       void (*entry)(void*)) {
    REQUIRE(kernel.add(thread, {.name = name,
                                .category = Category::behavior,
                                .priority = priority,
                                .entry = entry,
                                .argument = &cast,
                                .stack = {}}));
  };
  add(cast.waits, "waits", 90, [](void* argument) {
    static_cast<Cast*>(argument)->kernel.wait(1);
    log += "never ";
  });
  add(cast.runs, "runs", 50, [](void* argument) {
    auto& all = *static_cast<Cast*>(argument);
    log += "runs ";
    all.kernel.set_priority(all.waits, {10, 90});
    all.kernel.set_priority(all.waits, {90, 90});
    log += "still ";
    all.kernel.set_priority(all.ready, {60, 40});
    log += "again ";
  });
  add(cast.ready, "ready", 40, [](void*) { log += "ready "; });
  kernel.run();
  CHECK(log == "runs still ready again ");
  CHECK(order_of(kernel) == "waits ready runs ");
  CHECK(kernel.state(cast.waits) == Thread::State::blocked);
}

TEST_CASE("a priority that does not fit is refused") {
  Kernel kernel;
  Thread thread;
  ThreadSpec spec{.name = "too high",
                  .category = Category::behavior,
                  .priority = 128,
                  .entry = [](void*) {},
                  .argument = nullptr,
                  .stack = {}};
  CHECK_FALSE(kernel.add(thread, spec));
  spec.priority = -128;
  CHECK(kernel.add(thread, spec));
}
