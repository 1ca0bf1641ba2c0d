// What survives a power cut at every written byte: the store alone, and in the whole robot.
#include "runtime-m4/update/program_store.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "rsc/device/keeping.hpp"
#include "rsc/device/session.hpp"
#include "tests/runtime-m4/update/kept.hpp"
#include "vm/identity.hpp"

using namespace robosync;
using link::Keeping;
using link::ResetReason;
using test::Bytes;
using test::finish;
using test::keep;
using test::kStartMs;
using test::kStoreBytes;
using test::kTrialMs;
using test::MemoryStore;
using test::name_of;
using test::Robot;
using test::run_on;
using test::started;
using update::ProgramStore;
using update::Work;

namespace {

Bytes some_image(unsigned seed, std::size_t size) {
  Bytes image(size);
  std::mt19937 random(seed);
  std::generate(image.begin(), image.end(), [&] { return static_cast<std::byte>(random()); });
  return image;
}

ProgramStore::Program named(const Bytes& image) {
  return {static_cast<std::uint32_t>(image.size()), vm::name_of(vm::Identity().finish(image))};
}

void keep(ProgramStore& store, const Bytes& image) {
  store.write(image, named(image));
  finish(store);
  if (store.written() != named(image)) return;
  store.keep_written();
  finish(store);
}

Bytes read_kept(ProgramStore& store) {
  Bytes room(kStoreBytes);
  store.read_kept(room);
  finish(store);
  return {store.image().begin(), store.image().end()};
}

Bytes bytes_of(const tool::Program& program) {
  return {program.bytes().begin(), program.bytes().end()};
}

}  // namespace

TEST_CASE("a new store has no program, and one without answers none to keep any") {
  MemoryStore memory(kStoreBytes);
  ProgramStore store = test::opened<ProgramStore>(memory);
  CHECK(store.there());
  CHECK(store.kept().bytes == 0);
  CHECK(store.most_bytes() == 2432);

  memory.dead = true;
  ProgramStore dead(&memory);
  dead.open();
  finish(dead);
  CHECK_FALSE(dead.there());
  CHECK(dead.most_bytes() == 0);
  ProgramStore none(nullptr);
  none.open();
  CHECK(none.work() == Work::none);
  CHECK_FALSE(none.there());
}

TEST_CASE("a cut of the power at every byte leaves the program of before, or the new one") {
  const Bytes first = some_image(1, 600), second = some_image(2, 777), third = some_image(3, 401);
  MemoryStore before(kStoreBytes);
  {
    ProgramStore store = test::opened<ProgramStore>(before);
    keep(store, first);
    keep(store, second);
  }
  MemoryStore after = before;
  after.written = 0;
  {
    ProgramStore store = test::opened<ProgramStore>(after);
    keep(store, third);
  }
  REQUIRE(after.written > third.size());
  for (std::size_t cut = 0; cut <= after.written; ++cut) {
    CAPTURE(cut);
    MemoryStore memory = before;
    ProgramStore store = test::opened<ProgramStore>(memory);
    memory.power_for = cut;
    keep(store, third);
    ProgramStore again = test::opened<ProgramStore>(memory);
    const bool whole = cut == after.written;
    REQUIRE(again.kept() == named(whole ? third : second));
    REQUIRE(read_kept(again) == (whole ? third : second));
    keep(again, first);  // and it works again
    ProgramStore last = test::opened<ProgramStore>(memory);
    REQUIRE(read_kept(last) == first);
  }
}

// A request may come between any two pieces: what it finds must be what the robot would find after a reset.
TEST_CASE("between two pieces the store knows which program a reset would start") {
  const Bytes first = some_image(1, 600), second = some_image(2, 777);
  MemoryStore memory(kStoreBytes);
  ProgramStore store = test::opened<ProgramStore>(memory);
  keep(store, first);
  store.write(second, named(second));
  finish(store);
  store.keep_written();
  for (Work work = Work::some; work != Work::ended;) {
    work = store.work();
    MemoryStore after = memory;
    REQUIRE(test::opened<ProgramStore>(after).kept() == store.kept());
  }
  CHECK(store.kept() == named(second));
}

TEST_CASE("a cut while programs change places leaves them as they were, or changed") {
  const Bytes first = some_image(1, 300), second = some_image(2, 500);
  MemoryStore before(kStoreBytes);
  {
    ProgramStore store = test::opened<ProgramStore>(before);
    keep(store, first);
    keep(store, second);
    CHECK(store.previous() == named(first));
  }
  for (std::size_t cut = 0; cut <= 48; ++cut) {
    CAPTURE(cut);
    MemoryStore memory = before;
    ProgramStore store = test::opened<ProgramStore>(memory);
    memory.power_for = cut;
    store.swap();
    finish(store);
    ProgramStore again = test::opened<ProgramStore>(memory);
    REQUIRE(read_kept(again) == (cut == 48 ? first : second));
    REQUIRE(again.previous() == named(cut == 48 ? second : first));
  }
}

TEST_CASE(
    "a store that is busy after each write, and whose bus is taken away, ends up with the same") {
  const Bytes image = some_image(1, 1000);
  MemoryStore memory(kStoreBytes);
  memory.writes_take = 6;
  memory.one_in_is_taken = 3;
  ProgramStore store = test::opened<ProgramStore>(memory);
  keep(store, image);
  CHECK(store.kept() == named(image));
  ProgramStore again = test::opened<ProgramStore>(memory);
  CHECK(read_kept(again) == image);
}

TEST_CASE("whatever stands in a store, no more is read than there is room") {
  MemoryStore memory(kStoreBytes);
  std::mt19937 random(1);
  for (unsigned i = 0; i < 2000; ++i) {
    if (i % 2 == 0) {  // a valid record with random numbers in it
      std::array<std::uint32_t, 12> record{0x3250'5352,
                                           static_cast<std::uint32_t>(random()) % 3 + 1};
      for (std::size_t word = 2; word < record.size() - 1; ++word)
        record[word] = static_cast<std::uint32_t>(random()) >> (random() % 32);
      record.back() = vm::crc32(std::as_bytes(std::span(record)).first(44));
      std::ranges::copy(std::as_bytes(std::span(record)), memory.bytes.begin());
    } else {
      std::generate_n(memory.bytes.begin(), 2 * MemoryStore::kPage,
                      [&] { return static_cast<std::byte>(random()); });
    }
    ProgramStore store = test::opened<ProgramStore>(memory);
    REQUIRE(store.kept().bytes <= store.most_bytes());
    Bytes room(300);
    store.read_kept(room);
    finish(store);
    REQUIRE(store.image().size() <= room.size());
    store.read_previous(room);
    finish(store);
    REQUIRE(store.image().size() <= room.size());
  }
}

TEST_CASE(
    "a program that has stood its trial runs soon after a reset; before, the one that was kept") {
  MemoryStore memory(kStoreBytes);
  const tool::Program first = test::program(3), second = test::program(5);
  CHECK(started(memory) == link::ProgramHash{});
  keep(memory, first);
  CHECK(started(memory) == name_of(first));
  {
    Robot robot(boards::kMemory, &memory);
    robot.run(kStartMs);
    run_on(robot, second);
    robot.run(kTrialMs - 1000);
    tool::Client client(robot);
    CHECK(client.kept().state == Keeping::on_trial);
    CHECK(client.kept().trial_ms <= 1000);
  }
  CHECK(started(memory) == name_of(first));
  keep(memory, second);
  CHECK(started(memory) == name_of(second));
}

TEST_CASE("a fault in its trial brings the kept program back, and it is said") {
  MemoryStore memory(kStoreBytes);
  const tool::Program good = test::program(3), bad = test::program(5);
  keep(memory, good);
  for (const unsigned after_ms : {0U, 30U, 2000U}) {
    CAPTURE(after_ms);
    Robot robot(boards::kMemory, &memory);
    robot.run(kStartMs);
    run_on(robot, bad);
    robot.run(after_ms);
    robot.server.report({});
    robot.run(kStartMs);
    tool::Client client(robot);
    CHECK(client.hello().program_hash == name_of(good));
    CHECK(client.kept().state == Keeping::kept);
    CHECK(client.kept().given_up_hash == name_of(bad));
    robot.run(kTrialMs + 1000);
    CHECK(client.kept().kept_hash == name_of(good));
  }
  CHECK(started(memory) == name_of(good));
}

TEST_CASE(
    "what was kept before a program that fails its trial is gone, and nobody says otherwise") {
  MemoryStore memory(kStoreBytes);
  const tool::Program first = test::program(3), second = test::program(5), bad = test::program(7);
  keep(memory, first);
  keep(memory, second);
  {
    Robot robot(boards::kMemory, &memory);
    robot.run(kStartMs);
    tool::Client client(robot);
    CHECK_THAT(tool::rollback_text(client.kept()),
               Catch::StartsWith("to program " + tool::text_of(name_of(first))));
    run_on(robot, bad);
    robot.run(1000);
    CHECK_THAT(tool::rollback_text(client.kept()),
               Catch::StartsWith("to program " + tool::text_of(name_of(second))));
    robot.server.report({});
    robot.run(kStartMs);
    const link::Kept kept = client.kept();
    CHECK(kept.kept_hash == name_of(second));
    CHECK(kept.previous_bytes == 0);
    CHECK_THAT(tool::rollback_text(kept),
               Catch::StartsWith("to none: ") && Catch::Contains(tool::text_of(name_of(bad))));
    CHECK(tool::keeping_json(kept).at("rollback").is_null());
    CHECK_THROWS_WITH(tool::roll_back(client), Catch::Contains("went back on its own") &&
                                                   Catch::Contains("upload the one you want"));
    client.roll_back(name_of(first));
    client.roll_back(name_of(bad));
    robot.run(kStartMs);
    CHECK(client.hello().program_hash == name_of(second));
  }
  CHECK(started(memory) == name_of(second));
  Robot again(boards::kMemory, &memory);
  again.run(kStartMs);
  CHECK(tool::Client(again).kept().previous_bytes == 0);
}

TEST_CASE("a cut of the power before its trial is over leaves no program that did not stand it") {
  const Bytes first = some_image(1, 300), second = some_image(2, 500), third = some_image(3, 401);
  MemoryStore before(kStoreBytes);
  {
    ProgramStore store = test::opened<ProgramStore>(before);
    keep(store, first);
    keep(store, second);
  }
  for (std::size_t cut = 0; cut <= 448; ++cut) {
    CAPTURE(cut);
    MemoryStore memory = before;
    ProgramStore store = test::opened<ProgramStore>(memory);
    memory.power_for = cut;
    store.write(third, named(third));
    finish(store);
    ProgramStore again = test::opened<ProgramStore>(memory);
    REQUIRE(again.kept() == named(second));
    REQUIRE(again.previous() == (cut < 48 ? named(first) : ProgramStore::Program{}));
  }
}

TEST_CASE("the host says how long a trial is, and may only try a program") {
  const tool::Program kept = test::program(3), next = test::program(5);
  const auto upload = [](Robot& robot, const tool::Program& program, unsigned trial_ms,
                         bool confirm) {
    tool::Client client(robot);
    tool::UploadOptions options;
    options.trial = std::chrono::milliseconds(trial_ms);
    options.confirm = confirm;
    REQUIRE(tool::upload(client, client.hello(), program.bytes(), options).activation.running == 1);
  };
  MemoryStore memory(kStoreBytes);
  keep(memory, kept);
  {
    Robot robot(boards::kMemory, &memory);
    robot.run(kStartMs);
    const std::size_t before = memory.written;
    upload(robot, next, 2000, false);
    tool::Client client(robot);
    robot.run(1800);
    CHECK(client.hello().program_hash == name_of(next));
    robot.run(400);
    CHECK(client.hello().program_hash == name_of(kept));
    CHECK(client.kept().given_up_hash == link::ProgramHash{});
    CHECK(memory.written == before);
    upload(robot, next, 300, true);
    robot.run(1000);
    CHECK(client.kept().kept_hash == name_of(next));
    upload(robot, kept, 9000, true);
    robot.run(8500);
    CHECK(client.kept().state == Keeping::on_trial);
  }
  CHECK(started(memory) == name_of(next));
}

TEST_CASE(
    "a program that has failed a trial may stand the next one, and is not blamed for the first") {
  MemoryStore memory(kStoreBytes);
  const tool::Program good = test::program(3), bad = test::program(5);
  keep(memory, good);
  Robot robot(boards::kMemory, &memory);
  robot.run(kStartMs);
  run_on(robot, bad);
  robot.server.report({});
  robot.run(kStartMs);
  tool::Client client(robot);
  CHECK(tool::has_failed_trial(client.kept(), name_of(bad)));
  CHECK(tool::keeping_text(client.kept(), name_of(bad)) ==
        "not kept: it failed its trial; the program kept before runs again");
  run_on(robot, bad);
  CHECK(client.kept().given_up_hash == link::ProgramHash{});
  CHECK_FALSE(tool::has_failed_trial(client.kept(), name_of(bad)));
  robot.run(kTrialMs + 1000);
  CHECK_FALSE(tool::has_failed_trial(client.kept(), name_of(bad)));
  CHECK(tool::keeping_text(client.kept(), name_of(bad)) ==
        "kept: the robot starts with it after a reset");
}

// Older firmware remembers the failure until its next start.
TEST_CASE("a program that runs has not failed, whatever the board remembers of it") {
  const link::ProgramHash it{1}, other{2};
  const auto fails = [&](Keeping state, const link::ProgramHash& kept) {
    link::Kept answer{};
    answer.kept_hash = kept;
    answer.given_up_hash = it;
    answer.state = state;
    return tool::has_failed_trial(answer, it);
  };
  CHECK_FALSE(fails(Keeping::kept, it));
  CHECK_FALSE(fails(Keeping::on_trial, other));
  CHECK(fails(Keeping::kept, other));
  CHECK(fails(Keeping::failed, {}));
  CHECK(fails(Keeping::no_store, {}));
}

TEST_CASE("of a program that is only tried nobody says that it is kept") {
  const tool::Program kept = test::program(3), next = test::program(5);
  MemoryStore memory(kStoreBytes);
  keep(memory, kept);
  Robot robot(boards::kMemory, &memory);
  robot.run(kStartMs);
  tool::Client client(robot);
  tool::UploadOptions options;
  options.trial = std::chrono::milliseconds(2000);
  options.confirm = false;
  REQUIRE(tool::upload(client, client.hello(), next.bytes(), options).activation.running == 1);
  const std::string meanwhile = tool::keeping_text(client.kept(), name_of(next));
  CHECK(meanwhile.starts_with("only on trial: the kept program comes back in "));
  CHECK(meanwhile.ends_with(" s"));
  CHECK(tool::keeping_text(client.kept()) == meanwhile);
  robot.run(2500);
  CHECK(tool::keeping_text(client.kept(), name_of(next)) ==
        "not kept: its trial is over; the program kept before runs again");
  CHECK(tool::keeping_text(client.kept()) == "kept: the robot starts with it after a reset");
}

TEST_CASE("a fault after its trial, or without a program to go back to, changes no program") {
  MemoryStore memory(kStoreBytes);
  Robot robot(boards::kMemory, &memory);
  const tool::Program program = test::program(3);
  run_on(robot, program);
  robot.server.report({});
  robot.run(kTrialMs + 2000);
  tool::Client client(robot);
  CHECK(client.hello().program_hash == name_of(program));
  CHECK(client.kept().state == Keeping::failed);
  CHECK(client.kept().kept_bytes == 0);
  run_on(robot, program);
  robot.run(kTrialMs + 2000);
  CHECK(client.kept().state == Keeping::kept);
  robot.server.report({});
  robot.run(kStartMs);
  CHECK(client.hello().program_hash == name_of(program));
}

TEST_CASE("a person goes back to the program before, and forth again") {
  MemoryStore memory(kStoreBytes);
  const tool::Program first = test::program(3), second = test::long_program(),
                      third = test::program(7);
  keep(memory, first);
  {
    Robot robot(boards::kMemory, &memory);
    robot.run(kStartMs);
    tool::Client client(robot);
    CHECK_THROWS_WITH(tool::roll_back(client), Catch::Contains("has kept no program before"));
    run_on(robot, second);
    robot.run(kTrialMs + 2000);
    REQUIRE(client.kept().state == Keeping::kept);
    CHECK(tool::roll_back(client).program_hash == name_of(first));
    client.roll_back(name_of(first));  // requested twice
    robot.run(kStartMs);
    CHECK(client.hello().program_hash == name_of(first));
    CHECK(tool::roll_back(client).program_hash == name_of(second));
    robot.run(kStartMs);
    run_on(robot, third);
    CHECK(tool::roll_back(client).program_hash == name_of(second));  // in its trial
    robot.run(kTrialMs + 2000);
    CHECK(client.kept().kept_hash == name_of(second));
  }
  CHECK(started(memory) == name_of(second));
}

TEST_CASE("a kept program that is damaged gives way to the one before, or to none") {
  const tool::Program first = test::program(3), second = test::program(5);
  MemoryStore memory(kStoreBytes);
  keep(memory, first);
  keep(memory, second);
  const auto damage = [&](const tool::Program& program) {
    const Bytes image = bytes_of(program);
    const auto at =
        std::search(memory.bytes.begin(), memory.bytes.end(), image.begin(), image.end());
    REQUIRE(at != memory.bytes.end());
    at[200] ^= std::byte{1};
  };
  damage(second);
  {
    Robot robot(boards::kMemory, &memory);
    robot.run(kStartMs);
    tool::Client client(robot);
    CHECK(client.hello().program_hash == name_of(first));
    CHECK(client.kept().kept_hash == name_of(first));
    CHECK_THROWS_WITH(tool::roll_back(client), Catch::Contains("damaged"));
    CHECK(client.hello().program_hash == name_of(first));
  }
  CHECK(started(memory) == name_of(first));
  damage(first);
  CHECK(started(memory) == link::ProgramHash{});
  keep(memory, second);
  CHECK(started(memory) == name_of(second));
}

TEST_CASE("an upload right after a reset comes before the kept program") {
  MemoryStore memory(kStoreBytes);
  const tool::Program kept = test::long_program(), mine = test::program(5);
  keep(memory, kept);
  Robot robot(boards::kMemory, &memory);
  run_on(robot, mine);
  robot.run(1000);
  tool::Client client(robot);
  CHECK(client.hello().program_hash == name_of(mine));
  CHECK(client.kept().state == Keeping::on_trial);
}

TEST_CASE(
    "an upload that is there before the store is read goes through, with the kept one behind it") {
  MemoryStore memory(kStoreBytes);
  const tool::Program mine = test::program(5), kept = test::long_program();
  keep(memory, kept);
  memory.reads_take = 15;
  Robot robot(boards::kMemory, &memory);
  tool::Client client(robot);
  const link::HelloReply hello = client.hello();
  const tool::UploadResult result = tool::upload(client, hello, mine.bytes(), {});
  CHECK(result.activation.running == 1);
  CHECK(result.frames_sent == (mine.bytes().size() + link::kMaxData - 1) / link::kMaxData);
  const std::size_t reads = memory.reads;
  robot.run(1000);
  CHECK(memory.reads == reads);
  CHECK(client.hello().program_hash == name_of(mine));
  CHECK(client.kept().kept_hash == name_of(kept));
}

TEST_CASE("a program that is ended while it is written is written no further") {
  MemoryStore memory(kStoreBytes);
  memory.writes_take = 10;
  Robot robot(boards::kMemory, &memory);
  run_on(robot, test::long_program());
  tool::Client client(robot);
  robot.run(100);
  client.clear(name_of(test::long_program()));
  const std::size_t written = memory.written;
  REQUIRE(written > 0);
  REQUIRE(written < test::long_program().bytes().size());
  robot.run(1000);
  CHECK(memory.written == written);
}

TEST_CASE("a host that goes away in the midst of an upload leaves no robot without a program") {
  MemoryStore memory(kStoreBytes);
  const tool::Program kept = test::program(3), next = test::long_program();
  keep(memory, kept);
  Robot robot(boards::kMemory, &memory);
  robot.run(kStartMs);
  tool::Client client(robot);
  client.clear(name_of(kept));
  const auto size = static_cast<std::uint32_t>(next.bytes().size());
  for (unsigned i = 0; i < 20; ++i) {  // slowly, but it is still there
    client.send(link::MessageType::begin,
                link::wire_bytes(link::Begin{client.session(), size, name_of(next), {}}));
    robot.run(200);
  }
  CHECK(client.hello().running == 0);
  robot.run(4000);
  CHECK(client.hello().program_hash == name_of(kept));
}

TEST_CASE("after a reset by a failure the kept program stands still until somebody says so") {
  MemoryStore memory(kStoreBytes);
  keep(memory, test::program(3));
  for (const auto reason : {ResetReason::power, ResetReason::watchdog, ResetReason::software}) {
    CAPTURE(reason);
    Robot robot(boards::kMemory, &memory, reason);
    robot.run(kStartMs);
    tool::Client client(robot);
    CHECK(client.hello().running == 1);
    CHECK(client.hello().stopped == (reason == ResetReason::power ? 0 : 1));
    client.resume();
    CHECK(client.hello().stopped == 0);
    run_on(robot, test::program(5));
    CHECK(client.hello().stopped == 0);
  }
  Robot robot;  // with a program from the host, which is then responsible
  run_on(robot, test::program(3));
  tool::Client client(robot);
  CHECK(client.hello().stopped == 0);
}

TEST_CASE("a board without a store says so, and runs what comes") {
  Robot robot;
  run_on(robot, test::program(3));
  robot.run(kTrialMs + 1000);
  tool::Client client(robot);
  CHECK(client.hello().running == 1);
  CHECK(client.kept().state == Keeping::no_store);
  CHECK(client.kept().most_bytes == 0);
}

TEST_CASE("a program that is too large for the store runs, and is not kept") {
  MemoryStore memory(4096);
  Robot robot(boards::kMemory, &memory);
  const tool::Program program = test::long_program();
  run_on(robot, program);
  robot.run(kTrialMs + 2000);
  tool::Client client(robot);
  CHECK(client.hello().running == 1);
  CHECK(client.kept().state == Keeping::too_large);
  CHECK(memory.written == 0);
}

TEST_CASE(
    "uploads, faults, rollbacks and resets with cuts at any byte: a kept program is never lost") {
  const std::array<tool::Program, 3> programs{test::program(3), test::program(5),
                                              test::long_program()};
  std::mt19937 random(1);
  MemoryStore memory(kStoreBytes);
  keep(memory, programs[0]);
  link::ProgramHash kept = name_of(programs[0]);
  unsigned cuts = 0;
  for (unsigned round = 0; round < 120; ++round) {
    CAPTURE(round);
    link::Kept before{}, after{};
    const tool::Program& next = programs[random() % programs.size()];
    {
      Robot robot(boards::kMemory, &memory);
      robot.run(kStartMs);
      tool::Client client(robot);
      REQUIRE(client.hello().program_hash == kept);
      before = client.kept();
      if (random() % 2 == 0) memory.power_for = random() % 2000;
      run_on(robot, next);
      robot.run(random() % (2 * kTrialMs));
      if (random() % 4 == 0) robot.server.report({});
      if (random() % 4 == 0) client.roll_back(client.kept().previous_hash);
      robot.run(random() % 300);
      after = client.kept();
    }
    const bool cut = memory.dead;
    cuts += cut ? 1 : 0;
    kept = started(memory);
    if (cut) {
      REQUIRE((kept == before.kept_hash || kept == before.previous_hash || kept == name_of(next)));
    } else {
      REQUIRE(kept == after.kept_hash);
    }
    REQUIRE(kept != link::ProgramHash{});
  }
  CHECK(cuts > 10);
}

TEST_CASE("what lets the processor stand still is done where no thread is due before it is over") {
  MemoryStore memory(kStoreBytes);
  memory.stalls = 10;
  Robot robot(boards::kMemory, &memory);
  unsigned parts = 0;
  kernel::Time last = 0;
  memory.stall = [&] {
    ++parts;
    CHECK(robot.kernel.ticks_to_next_work() > boards::Store::kStall);
    CHECK(robot.kernel.now() >= last + update::Keeper::kRest);
    last = robot.kernel.now();
  };
  const tool::Program program =
      test::compile("BEHAVIOR tick PRIORITY 50\nEVERY 7ms DO LOG \"tick\" END\nEND\n");
  run_on(robot, program);
  robot.run(kTrialMs + 4000);
  CHECK(parts >= 9 * 4);  // several pages of the image, and the record's
  tool::Client client(robot);
  CHECK(client.kept().state == Keeping::kept);
  robot.run(2 * kLookMs);
  CHECK(client.status().safety_late_us == 0);
}
