// Mutexes on the host: the cases of mutex_cases.hpp, and random use against a naive model.
#include "runtime-m4/kernel/mutex.hpp"

#include <catch2/catch.hpp>

#include "tests/kernel/mutex_cases.hpp"
#include "tests/kernel/rig.hpp"

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

}  // namespace

TEST_CASE("a mutex with a ceiling: the cases in which inheritance goes wrong") {
  for (const mutex_cases::Case& example : mutex_cases::all()) {
    INFO(example.name);
    HostStage stage;
    CHECK(mutex_cases::passes(example, stage));
    CHECK(std::string(mutex_cases::noted()) == example.expected);
  }
}
