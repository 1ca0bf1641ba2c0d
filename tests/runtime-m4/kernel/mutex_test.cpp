// Mutexes on the host: the cases of mutex_cases.hpp, and random use against a naive model.
#include "runtime-m4/kernel/mutex.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include "tests/runtime-m4/kernel/mutex_cases.hpp"
#include "tests/runtime-m4/kernel/rig.hpp"

using namespace robosync::kernel;

namespace {

class HostStage final : public mutex_cases::Stage {
public:
  HostStage() : Stage(own_) {}

  Thread& start(unsigned index, Category category, std::int16_t priority,
                void (*entry)(void*)) override {
    Worker& worker = workers_[index];
    ThreadSpec spec;
    spec.category = category;
    spec.priority = priority;
    spec.entry = entry;
    spec.stack = worker.stack;
    REQUIRE(own_.add(worker.thread, spec));
    return worker.thread;
  }
  void run() override { own_.run(); }

private:
  struct Worker {
    Thread thread;
    std::array<std::byte, 64> stack{};
  };
  Kernel own_;
  std::array<Worker, 4> workers_;
};

// Threads of all categories take mutexes, release them in any order, signal and wait; a list of numbers
// tells the running thread what to do. After each step, checks that the right one runs.
class Play {
public:
  explicit Play(std::vector<std::uint16_t> moves) : moves_(std::move(moves)) {
    for (unsigned i = 0; i < kThreads; ++i) {
      threads_[i] = &rig_.add("t", kKinds[i % kKinds.size()], static_cast<std::int16_t>(i * 5 % 3),
                              [this, i] { run(i); })
                         .thread;
    }
  }
  void run() { rig_.kernel.run(); }
  unsigned steps() const { return steps_; }
  bool right() const { return right_; }

private:
  static constexpr unsigned kThreads = 10;
  static constexpr unsigned kMutexes = 3;
  static constexpr std::array kKinds = {Category::sensor, Category::processing, Category::behavior,
                                        Category::control};

  void run(unsigned self) {
    while (next_ < moves_.size()) {
      const std::uint16_t move = moves_[next_++];
      const unsigned which = move / 4 % kMutexes;
      switch (move % 4) {
        case 0:
          rig_.kernel.signal(*threads_[move / 4 % kThreads], 1);
          break;
        case 1:
          take(self, which);
          break;
        case 2:
          give_back(self, which);
          break;
        default:
          if (std::ranges::count(holders_, threads_[self]) == 0) rig_.kernel.wait(1, wake_up());
      }
      check(self);
    }
    for (unsigned m = 0; m < kMutexes; ++m)
      give_back(self, m);
  }

  Time wake_up() const { return rig_.kernel.now() + kTick * (1 + next_ % 3); }

  void take(unsigned self, unsigned which) {
    if (threads_[self]->rank() < ceiling(which) || holders_[which] == threads_[self]) return;
    expect(holders_[which] == nullptr);
    holders_[which] = threads_[self];  // first, so that it is right when others check
    rig_.kernel.acquire(mutexes_[which]);
  }
  void give_back(unsigned self, unsigned which) {
    if (holders_[which] != threads_[self]) return;
    holders_[which] = nullptr;
    rig_.kernel.release(mutexes_[which]);
  }

  unsigned ceiling(unsigned which) const {
    for (const Thread* thread : rig_.kernel.threads())
      if (thread->category() == kCeilings[which]) return thread->rank();
    return kIdleRank;
  }

  // The policy; see firmware/stress.cpp.
  const Thread* should_run() const {
    const Thread* best = nullptr;
    for (const Thread* thread : rig_.kernel.threads())
      if (best == nullptr && rig_.kernel.state(*thread) == Thread::State::ready) best = thread;
    unsigned rank = best == nullptr ? kIdleRank : best->rank();
    for (unsigned m = 0; m < kMutexes; ++m) {
      if (holders_[m] == nullptr || ceiling(m) > rank) continue;
      rank = ceiling(m);
      best = holders_[m];
    }
    return best;
  }

  void check(unsigned self) {
    ++steps_;
    expect(&rig_.kernel.current() == threads_[self]);
    expect(should_run() == threads_[self]);
  }
  // Threads cannot throw to their caller.
  void expect(bool holds) { right_ = right_ && holds; }

  static constexpr std::array kCeilings = {Category::control, Category::behavior,
                                           Category::processing};
  std::vector<std::uint16_t> moves_;
  std::size_t next_ = 0;
  unsigned steps_ = 0;
  bool right_ = true;
  std::array<Thread*, kThreads> threads_{};
  std::array<const Thread*, kMutexes> holders_{};
  std::array<Mutex, kMutexes> mutexes_ = {Mutex{kCeilings[0]}, Mutex{kCeilings[1]},
                                          Mutex{kCeilings[2]}};
  test::Rig rig_;
};

}  // namespace

TEST_CASE("a mutex with a ceiling: the cases in which inheritance goes wrong") {
  for (const mutex_cases::Case& example : mutex_cases::all()) {
    INFO(example.name);
    HostStage stage;
    CHECK(mutex_cases::passes(example, stage));
    CHECK(std::string(mutex_cases::noted()) == example.expected);
  }
}

TEST_CASE("whoever takes, gives back, signals and waits: the right thread runs") {
  const bool holds = rc::check([](const std::vector<std::uint16_t>& moves) {
    Play play(moves);
    play.run();
    RC_ASSERT(play.right());
    RC_ASSERT(play.steps() == moves.size());
  });
  CHECK(holds);
}
