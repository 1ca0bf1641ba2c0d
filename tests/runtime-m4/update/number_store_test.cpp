// KEPT numbers over power cuts at every written byte, and from one program to the next.
#include "runtime-m4/update/number_store.hpp"

#include <map>

#include <catch2/catch.hpp>

#include "tests/runtime-m4/update/kept.hpp"

using namespace robosync;
using layers::KeptNumber;
using test::finish;
using test::kLookMs;
using test::kStoreBytes;
using test::kTrialMs;
using test::MemoryStore;
using test::Robot;
using test::run_on;
using update::NumberStore;
using update::Work;

namespace {

using Numbers = std::vector<KeptNumber>;

Numbers read(MemoryStore& memory) {
  const auto store = test::opened<NumberStore>(memory);
  return {store.numbers().begin(), store.numbers().end()};
}

Numbers some_numbers(unsigned seed, std::size_t count) {
  std::mt19937 random(seed);
  Numbers numbers(count);
  for (KeptNumber& number : numbers)
    number = {static_cast<std::uint32_t>(random()), static_cast<vm::Value>(random() % 100'000)};
  return numbers;
}

void write(NumberStore& store, const Numbers& numbers) {
  store.write(numbers);
  finish(store);
}

// A store with so many numbers that its ring has wrapped.
MemoryStore used() {
  MemoryStore memory(kStoreBytes);
  auto store = test::opened<NumberStore>(memory);
  for (unsigned i = 0; i < 21; ++i)
    write(store, some_numbers(i, i % 17));
  return memory;
}

// Counts touches; `more` comes before its rules.
tool::Program counting(const std::string& more = "REMEMBER visits = 0 KEPT\n") {
  return test::compile(more +
                       "BEHAVIOR count PRIORITY 50\n"
                       "WHEN touch LEVEL > 5 DO RAISE visits BY 1 END\n"
                       "END\n");
}

void touch(Robot& robot, unsigned times) {
  tool::Client client(robot);
  for (unsigned i = 0; i < 2 * times; ++i) {
    client.feed({.channel = 0, .at_us = 0, .value = i % 2 == 0 ? 9000 : 0});
    robot.run(30);
  }
}

// The running program's KEPT numbers, as integers.
std::vector<int> kept(const Robot& robot) {
  std::array<KeptNumber, vm::kMaxKept> numbers{};
  std::vector<int> values;
  for (const KeptNumber& number : std::span(numbers).first(robot.runtime.fill_kept(numbers)))
    values.push_back(number.value / 1000);
  return values;
}

using Values = std::vector<int>;

}  // namespace

TEST_CASE("a cut of the power at every byte leaves the numbers of before, or the new ones") {
  const MemoryStore before = used();
  const Numbers old = some_numbers(20, 20 % 17), next = some_numbers(77, 16);
  for (std::size_t cut = 0; cut <= sizeof(NumberStore::Record); ++cut) {
    CAPTURE(cut);
    MemoryStore memory = before;
    auto store = test::opened<NumberStore>(memory);
    memory.power_for = cut;
    write(store, next);
    REQUIRE(read(memory) == (cut == sizeof(NumberStore::Record) ? next : old));
    auto again = test::opened<NumberStore>(memory);
    write(again, some_numbers(5, 5));
    REQUIRE(read(memory) == some_numbers(5, 5));
  }
}

TEST_CASE("numbers that are written again and again go round the ring") {
  MemoryStore memory(kStoreBytes);
  std::map<std::uint32_t, unsigned> writes;
  auto store = test::opened<NumberStore>(memory);
  constexpr unsigned kWrites = 160;
  for (unsigned i = 0; i < kWrites; ++i) {
    const std::vector<std::byte> was = memory.bytes;
    write(store, some_numbers(i, 3));
    const auto at = std::ranges::mismatch(was, memory.bytes).in1 - was.begin();
    ++writes[static_cast<std::uint32_t>(at) / (3 * MemoryStore::kPage)];
  }
  CHECK(writes.size() == update::StoreLayout::kRing);
  for (const auto& [place, count] : writes)
    CHECK(count == kWrites / update::StoreLayout::kRing);
}

TEST_CASE("whatever stands in the ring, no more numbers come out than there may be") {
  MemoryStore memory = used();
  std::mt19937 random(3);
  for (unsigned i = 0; i < 1000; ++i) {
    memory.bytes[random() % memory.bytes.size()] = static_cast<std::byte>(random());
    REQUIRE(read(memory).size() <= vm::kMaxKept);
  }
  MemoryStore none(kStoreBytes);
  none.dead = true;
  NumberStore store(&none);
  store.open();
  finish(store);
  CHECK(store.numbers().empty());
}

TEST_CASE("a kept program goes on counting after the power was gone") {
  MemoryStore memory(kStoreBytes);
  {
    Robot robot(boards::kMemory, &memory);
    robot.run(50);
    run_on(robot, counting());
    touch(robot, 3);
    robot.run(kTrialMs + kLookMs);
    CHECK(kept(robot) == Values{3});
  }
  for (int start = 1; start < 4; ++start) {
    Robot robot(boards::kMemory, &memory);
    robot.run(100);
    CHECK(kept(robot) == Values{start + 2});
    touch(robot, 1);
    robot.run(kLookMs + 100);
  }
}

TEST_CASE("numbers go from one program to the next by name and dimension, inside of its range") {
  Robot robot;  // also without a store
  run_on(robot, counting("REMEMBER visits = 0 KEPT\nREMEMBER other = 7 KEPT\n"));
  touch(robot, 4);
  run_on(robot, counting("REMEMBER first = 1 KEPT\nREMEMBER Visits = 0 KEPT\n"));
  CHECK(kept(robot) == Values{1, 4});
  run_on(robot, counting("REMEMBER visits = 0\nREMEMBER other = 1 KEPT\n"));
  CHECK(kept(robot) == Values{7});
  run_on(robot, counting("REMEMBER visits = 0 KEPT\nREMEMBER other = 5cm KEPT\n"));
  CHECK(kept(robot) == Values{4, 50});
}

TEST_CASE("a number that is outside of the range now begins at its end") {
  const tool::Program program = counting();
  vm::Variable visits = program.image().variables.front();
  visits.min = 2000;
  visits.max = 5000;
  const std::uint32_t key = layers::kept_key(program.image(), visits);
  for (const auto& [value, begun] : {std::pair{1000, 2000}, {3000, 3000}, {9000, 5000}}) {
    const std::array numbers{KeptNumber{key + 1, 4000}, KeptNumber{key, value}};
    CHECK(layers::initial_of(program.image(), visits, numbers) == begun);
  }
  visits.kind = vm::VariableKind::plain;
  CHECK(layers::initial_of(program.image(), visits, std::array{KeptNumber{key, 3000}}) ==
        visits.initial);
}

TEST_CASE("numbers are forgotten when somebody says so, once") {
  Robot robot;
  run_on(robot, counting());
  touch(robot, 4);
  run_on(robot, counting(), true);
  CHECK(kept(robot) == Values{0});
  touch(robot, 2);
  run_on(robot, counting());
  CHECK(kept(robot) == Values{2});
}

TEST_CASE(
    "a number that was not KEPT goes from one program to the next, too, unless somebody says "
    "fresh") {
  for (const bool fresh : {false, true}) {
    Robot robot;
    run_on(robot, counting("REMEMBER visits = 0\n"));
    touch(robot, 4);
    run_on(robot, counting(), fresh);
    CHECK(kept(robot) == Values{fresh ? 0 : 4});
  }
}

TEST_CASE("numbers of the last instant outlast a program that is ended before the next one comes") {
  Robot robot;
  tool::Client client(robot);
  run_on(robot, counting());
  touch(robot, 4);
  client.clear(client.hello().program_hash);
  REQUIRE(kept(robot).empty());
  run_on(robot, counting());
  CHECK(kept(robot) == Values{4});
}

TEST_CASE("an upload that is there before the numbers are read waits for them") {
  MemoryStore memory(kStoreBytes);
  {
    Robot robot(boards::kMemory, &memory);
    run_on(robot, counting());
    touch(robot, 4);
    robot.run(2 * kLookMs);
  }
  memory.reads_take = 15;
  Robot robot(boards::kMemory, &memory);
  run_on(robot, counting());
  CHECK(kept(robot) == Values{4});
}

TEST_CASE("power that goes at any time costs a second of counting at most") {
  MemoryStore memory(kStoreBytes);
  std::mt19937 random(1);
  {
    Robot robot(boards::kMemory, &memory);
    run_on(robot, counting());
    robot.run(kTrialMs + 2 * kLookMs);
  }
  int known = 0;
  for (unsigned round = 0; round < 60; ++round) {
    CAPTURE(round);
    memory.switch_on();
    Robot robot(boards::kMemory, &memory);
    robot.run(100);
    REQUIRE(kept(robot).size() == 1);
    const int begun = kept(robot).front();
    REQUIRE(begun >= known);
    for (unsigned i = 0; i < 2; ++i) {
      touch(robot, static_cast<unsigned>(random() % 5));
      robot.run(kLookMs + 200);  // by then the write is guaranteed
    }
    known = kept(robot).front();
    REQUIRE(known >= begun);
    memory.power_for = random() % 400;
    touch(robot, static_cast<unsigned>(random() % 40));
  }
  CHECK(known > 60);
}
