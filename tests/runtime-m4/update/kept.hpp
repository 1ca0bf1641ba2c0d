// Shared by the tests that switch a robot off and on.
#pragma once

#include <cstdint>

#include <catch2/catch.hpp>

#include "rsc/device/client.hpp"
#include "rsc/device/uploader.hpp"
#include "runtime-m4/update/keeper.hpp"
#include "runtime-m4/update/store_transfer.hpp"
#include "tests/runtime-m4/update/memory_store.hpp"
#include "tests/runtime-m4/update/programs.hpp"
#include "tests/runtime-m4/update/robot.hpp"

namespace robosync::test {

inline constexpr std::uint32_t kStoreBytes = 8192;
inline constexpr unsigned kStartMs = 100;  // from a reset to the kept program
inline constexpr auto kTrialMs = static_cast<unsigned>(update::Keeper::kTrial / 1000);
inline constexpr auto kLookMs = static_cast<unsigned>(update::Keeper::kLook / 1000);

// Completes the request of a ProgramStore or NumberStore. Bounded.
template <typename Store>
void finish(Store& store) {
  for (unsigned i = 0; i < 10'000; ++i) {
    const update::Work work = store.work();
    if (work == update::Work::none || work == update::Work::ended) return;
  }
  FAIL("the store comes to no end");
}

// The store after power-up.
template <typename Store>
Store opened(MemoryStore& memory) {
  memory.switch_on();
  Store store(&memory);
  store.open();
  finish(store);
  return store;
}

inline void run_on(Robot& robot, const tool::Program& program, bool fresh = false) {
  tool::Client client(robot);
  tool::UploadOptions options;
  options.fresh = fresh;
  REQUIRE(tool::upload(client, client.hello(), program.bytes(), options).activation.running == 1);
}

// A robot that keeps `program`.
inline void keep(MemoryStore& memory, const tool::Program& program) {
  Robot robot(boards::kMemory, &memory);
  run_on(robot, program);
  robot.run(kTrialMs + 2000);
}

// The program that the robot runs soon after a reset; zeros: none.
inline link::ProgramHash started(MemoryStore& memory) {
  memory.switch_on();
  Robot robot(boards::kMemory, &memory);
  robot.run(kStartMs);
  tool::Client client(robot);
  const link::HelloReply hello = client.hello();
  return hello.running == 1 ? hello.program_hash : link::ProgramHash{};
}

}  // namespace robosync::test
