// The board's server and the host's client over a line in memory: every message, and what happens
// when the host does not read, asks twice, or sends invalid data.
#include "runtime-m4/update/server.hpp"

#include <random>

#include <catch2/catch.hpp>

#include "link/events.hpp"
#include "rsc/device/client.hpp"
#include "rsc/device/session.hpp"
#include "rsc/device/uploader.hpp"
#include "rsc/failure.hpp"
#include "tests/runtime-m4/update/programs.hpp"
#include "tests/runtime-m4/update/robot.hpp"
#include "tests/runtime-m4/update/transfer.hpp"
#include "vm/opcode.hpp"

using namespace robosync;
using link::EventKind;
using link::MessageType;
using std::chrono::milliseconds;
using test::Robot;
using test::transfer;

namespace {

link::ActivateResult upload(tool::Client& client, std::span<const std::byte> image) {
  return tool::upload(client, client.hello(), image, {}).activation;
}

// The board's events during `time`.
std::vector<link::Event> events(tool::Client& client, milliseconds time) {
  std::vector<link::Event> list;
  const auto until = client.now() + time;
  while (client.now() < until) {
    const auto left = std::chrono::ceil<milliseconds>(until - client.now());
    const auto message = client.next_unasked(left);
    link::Event event;
    if (message && message->type == MessageType::event) {
      REQUIRE(link::decode_event(message->payload, event));
      list.push_back(event);
    }
  }
  return list;
}

std::size_t count(const std::vector<link::Event>& list, EventKind kind) {
  return static_cast<std::size_t>(std::ranges::count(list, kind, &link::Event::kind));
}

}  // namespace

TEST_CASE("hello introduces the board, without a program and with one") {
  Robot robot;
  REQUIRE(robot.started);
  tool::Client client(robot);
  link::HelloReply board = client.hello();
  CHECK(board.protocol == link::kProtocolVersion);
  CHECK(board.opcode_set == vm::opcode_set_id());
  CHECK(tool::text_of(board.board) == "mps2-an386");
  CHECK(board.arena_bytes == boards::kMemory.arena_bytes);
  CHECK(board.arena_begin == boards::kMemory.arena_begin);
  const std::uint32_t without = board.arena_used;
  CHECK(without > 0);
  CHECK(board.receive_window <= test::LineBoard::kRing);
  CHECK(board.running == 0);
  CHECK(client.running_image().empty());

  const tool::Program program = test::program(3);
  REQUIRE(upload(client, program.bytes()).running == 1);
  board = client.hello();
  CHECK(board.running == 1);
  CHECK(board.program_hash == program.image().header->program_hash);
  CHECK(board.image_bytes == program.bytes().size());
  CHECK(board.arena_used == policy::needs_of(program.image(), boards::kMemory).total);
  link::ProgramHash other = board.program_hash;
  ++other[0];
  client.clear(other);
  CHECK(client.hello().running == 1);
  client.clear(board.program_hash);
  board = client.hello();
  CHECK(board.running == 0);
  CHECK(board.arena_used == without);
  REQUIRE(upload(client, program.bytes()).running == 1);
  board = client.hello();
  CHECK(board.program_hash == program.image().header->program_hash);
}

TEST_CASE("the running image is read back as it was sent") {
  Robot robot;
  tool::Client client(robot);
  const tool::Program program = test::program(3);
  REQUIRE(upload(client, program.bytes()).running == 1);
  CHECK(std::ranges::equal(client.running_image(), program.bytes()));
}

TEST_CASE("status counts, and the thread list has everyone by rank") {
  Robot robot;
  tool::Client client(robot);
  REQUIRE(upload(client, test::program(3).bytes()).running == 1);
  robot.run(1000);
  const link::Status status = client.status();
  CHECK(status.uptime_us >= 1'000'000);
  CHECK(status.program_us < status.uptime_us);
  CHECK(status.activations == 1);
  CHECK(status.safety_checks > 50);
  CHECK(status.reset_reason == link::ResetReason::software);

  const std::vector<link::ThreadInfo> threads = client.threads();
  REQUIRE(threads.size() == robot.kernel.threads().size());
  CHECK(tool::text_of(threads.back().name) == "link");
  CHECK(threads.back().category == static_cast<std::uint8_t>(kernel::Category::system));
  CHECK(threads.front().category == static_cast<std::uint8_t>(kernel::Category::safety));
  for (std::size_t i = 0; i < threads.size(); ++i)
    CHECK(threads[i].rank == i);
}

TEST_CASE("a reading that is fed leads to a command, and the trace shows it") {
  Robot robot;
  tool::Client client(robot);
  REQUIRE(upload(client, test::program(3).bytes()).running == 1);
  client.set_trace(true);
  CHECK(client.feed({.channel = 0, .at_us = 0, .value = 2000}).error == link::FeedError::none);
  std::vector<link::Event> list = events(client, milliseconds(200));
  CHECK(count(list, EventKind::input) == 1);
  CHECK(count(list, EventKind::fire) == 1);
  CHECK(count(list, EventKind::command) == 1);

  // A hello ends the trace on the board; the client switches it on again.
  (void)client.hello();
  CHECK(client.feed({.channel = 0, .at_us = 0, .value = 4000}).error == link::FeedError::none);
  CHECK(count(events(client, milliseconds(200)), EventKind::input) == 1);

  client.set_trace(false);
  (void)client.hello();
  CHECK(client.feed({.channel = 0, .at_us = 0, .value = 5000}).error == link::FeedError::none);
  CHECK(events(client, milliseconds(200)).empty());

  CHECK(client.feed({.channel = 9, .at_us = 0, .value = 0}).error == link::FeedError::no_channel);
}

TEST_CASE("the state has the values of all inputs, part by part") {
  Robot robot;
  tool::Client client(robot);
  std::string text;
  constexpr std::size_t kMany = 32;  // with the channel, more than one part holds
  for (std::size_t i = 0; i < kMany; ++i)
    text += "REMEMBER v" + std::to_string(i) + " = " + std::to_string(i) + "\n";
  text += "WHEN touch LEVEL > 5 DO\n  SET v0 TO 7\n  SET v31 TO v30 + 1\nEND\n";
  CHECK(client.state(0).count == 0);
  const tool::Program program = test::compile(text);
  REQUIRE(upload(client, program.bytes()).running == 1);
  REQUIRE(client.feed({.channel = 0, .at_us = 0, .value = 6000}).error == link::FeedError::none);
  robot.run(50);
  const std::size_t inputs = 1 + program.image().variables.size();
  REQUIRE(inputs == 1 + kMany);
  std::vector<std::int32_t> values;
  while (values.size() < inputs) {
    const link::State state = client.state(static_cast<std::uint32_t>(values.size()));
    REQUIRE(state.count > 0);
    values.insert(values.end(), state.values.begin(), state.values.begin() + state.count);
  }
  REQUIRE(values.size() == inputs);
  CHECK(values.front() == 6000);
  for (std::size_t v = 0; v < program.image().variables.size(); ++v) {
    const auto name = program.image().string(program.image().variables[v].name);
    CAPTURE(name);
    const int number = std::stoi(std::string(name.substr(1)));
    CHECK(values[1 + v] == 1000 * (number == 0 ? 7 : number));
  }
  CHECK(client.state(static_cast<std::uint32_t>(inputs)).count == 0);
  CHECK(client.state(0xFFFF'FFFF).count == 0);
}

TEST_CASE("a stop does not wait until somebody reads the line") {
  Robot robot;
  robot.run(10);
  robot.board.from_host.assign(link::kStopFrame.begin(), link::kStopFrame.end());
  robot.board.interrupt();
  CHECK(robot.runtime.stopped());  // no thread has run yet
  robot.runtime.resume();
  robot.board.from_host.clear();
  std::array<std::byte, link::kMaxEncodedFrame> other{};
  const std::size_t length = link::encode_frame(link::MessageType::get_status, 7, {}, other);
  robot.board.from_host.assign(other.data(), other.data() + length);
  robot.board.interrupt();
  CHECK_FALSE(robot.runtime.stopped());
}

TEST_CASE("a resume that is older than a stop does not undo it") {
  Robot robot;
  tool::Client client(robot);
  client.hello();
  std::array<std::byte, link::kMaxEncodedFrame> resume{};
  const link::Resume wish{client.session()};
  const std::size_t length =
      link::encode_frame(link::MessageType::resume, 7, link::wire_bytes(wish), resume);
  std::deque<std::byte>& line = robot.board.from_host;
  line.assign(resume.data(), resume.data() + length);
  line.insert(line.end(), link::kStopFrame.begin(), link::kStopFrame.end());
  robot.run(20);
  CHECK(robot.runtime.stopped());
  const auto answers = [&](std::uint8_t sequence) {
    const auto reply = client.next_reply(std::chrono::milliseconds(50));
    return reply && reply->sequence == sequence;
  };
  line.insert(line.end(), resume.data(), resume.data() + length);
  CHECK(answers(link::kStopSequence));  // the first resume has no reply
  CHECK(answers(7));
  CHECK_FALSE(robot.runtime.stopped());
}

TEST_CASE("a stop that found no room in the line does not keep the robot stopped for ever") {
  Robot robot;
  robot.run(10);
  robot.board.from_host.assign(link::kStopFrame.begin(), link::kStopFrame.end());
  robot.board.interrupt();
  robot.board.from_host.clear();
  robot.run(10);
  tool::Client client(robot);
  client.resume();
  CHECK_FALSE(robot.runtime.stopped());
}

TEST_CASE("hello stops the trace of an earlier host") {
  Robot robot;
  tool::Client client(robot);
  REQUIRE(upload(client, test::program(3).bytes()).running == 1);
  client.set_trace(true);
  tool::Client later(robot);
  later.hello();
  later.feed({.channel = 0, .at_us = 0, .value = 2000});
  CHECK(events(later, milliseconds(200)).empty());
}

TEST_CASE("an activation that is asked for twice is done once") {
  Robot robot;
  tool::Client client(robot);
  const link::ActivateResult first = upload(client, test::program(3).bytes());
  const link::ActivateResult second = client.activate({.session = 0,
                                                       .hash = client.hello().program_hash,
                                                       .trial_ms = 0,
                                                       .goes_back = 0,
                                                       .fresh = 0});
  CHECK(second.running == 1);
  CHECK(second.uptime_us == first.uptime_us);
  CHECK(client.status().activations == 1);
}

TEST_CASE("of two hosts none starts the other one's program, and both are told the truth") {
  Robot robot;
  tool::Client client(robot);
  const tool::Program mine = test::program(3), other = test::program(5);
  const auto activate = [&](const tool::Program& program) {
    return client.activate({.session = 0,
                            .hash = program.image().header->program_hash,
                            .trial_ms = 0,
                            .goes_back = 0,
                            .fresh = 0});
  };
  client.hello();
  transfer(robot, client, mine.bytes(), mine.image().header->program_hash);
  transfer(robot, client, other.bytes(), other.image().header->program_hash);
  CHECK(activate(mine).refusal == link::kNothingToActivate);
  CHECK(client.hello().running == 0);
  CHECK(activate(other).running == 1);
  CHECK(client.hello().program_hash == other.image().header->program_hash);
  CHECK(activate(mine).refusal == link::kNothingToActivate);
  CHECK(activate(other).running == 1);
}

TEST_CASE("the same program may be uploaded again, and starts anew") {
  Robot robot;
  tool::Client client(robot);
  const tool::Program program = test::program(3);
  REQUIRE(upload(client, program.bytes()).running == 1);
  robot.run(500);
  REQUIRE(upload(client, program.bytes()).running == 1);
  const link::Status status = client.status();
  CHECK(status.activations == 2);
  CHECK(status.program_us < 200'000);
}

TEST_CASE("nothing to activate is said so") {
  Robot robot;
  tool::Client client(robot);
  const link::ActivateResult result = client.activate({});
  CHECK(result.running == 0);
  CHECK(result.refusal == 0xFF);
}

TEST_CASE("an image larger than a slot is refused when it is announced") {
  Robot robot;
  tool::Client client(robot);
  const test::Bytes image(vm::Limits{}.image_bytes + 60000);
  CHECK_THROWS_AS(upload(client, image), tool::Failure);
  CHECK_FALSE(robot.runtime.running());
}

TEST_CASE("replies are kept while the host does not read; events are dropped and counted") {
  Robot robot;
  tool::Client client(robot);
  REQUIRE(upload(client, test::program(3).bytes()).running == 1);
  client.set_trace(true);
  robot.host_reads = false;
  constexpr int kFeeds = 100;
  for (int i = 0; i < kFeeds; ++i) {
    robot.runtime.enqueue({.channel = 0, .at_us = 0, .value = i % 2 == 0 ? 2000 : 5000});
    robot.run(3);
  }
  CHECK(robot.ring.lost() > 0);
  std::vector<std::uint8_t> asked;
  for (int i = 0; i < 20; ++i)
    asked.push_back(client.send(MessageType::get_status));
  robot.run(500);  // requests wait in the board's receive ring
  CHECK(robot.runtime.running());
  CHECK(robot.overruns == 0);

  robot.host_reads = true;
  for (const std::uint8_t sequence : asked) {
    const auto reply = client.next_reply(milliseconds(200));
    REQUIRE(reply);
    CHECK(reply->type == MessageType::status);
    CHECK(reply->sequence == sequence);
  }
  // The beginning was stored, complete and in order.
  const std::vector<link::Event> list = events(client, milliseconds(500));
  CHECK(list.size() > 10);
  CHECK(std::ranges::is_sorted(list, {}, &link::Event::step));
  CHECK(client.status().lost_events == robot.ring.lost());
}

TEST_CASE("the link thread runs when there is something to do, and then only") {
  Robot robot;
  tool::Client client(robot);
  const kernel::Thread& link = *robot.kernel.threads().back();
  const auto runs_in = [&](std::uint64_t time_ms) {
    const std::uint32_t before = link.activations();
    robot.run(time_ms);
    return link.activations() - before;
  };
  robot.run(10);
  CHECK(runs_in(10'000) == 0);
  REQUIRE(upload(client, test::program(3).bytes()).running == 1);
  CHECK(runs_in(10'000) == 0);
  robot.runtime.enqueue({.channel = 0, .at_us = 0, .value = 2000});  // while no host listens
  CHECK(runs_in(1000) == 0);

  client.set_trace(true);
  robot.run(10'000);  // until the reading's effects have ended
  CHECK(runs_in(10'000) == 0);
  robot.runtime.enqueue({.channel = 0, .at_us = 0, .value = 5000});
  const std::uint32_t runs = runs_in(1000);
  CHECK(runs > 0);
  CHECK(runs < 10);
}

TEST_CASE("whatever comes over the line, the program goes on and the next upload works") {
  Robot robot;
  tool::Client client(robot);
  REQUIRE(upload(client, test::program(3).bytes()).running == 1);
  std::mt19937 random(3);
  for (int i = 0; i < 50'000; ++i) {
    robot.board.from_host.push_back(static_cast<std::byte>(random()));
    if (i % 100 == 0) robot.run_tick();
    REQUIRE(robot.runtime.running());
  }
  // Good frames with every type and wrong payloads.
  for (unsigned type = 0; type < 256; ++type) {
    for (const std::size_t length : {0u, 1u, 7u, 13u, 240u}) {
      if (type == static_cast<unsigned>(MessageType::activate)) continue;
      client.send(static_cast<MessageType>(type), test::Bytes(length, std::byte{0xA5}));
    }
    robot.run(100);
    REQUIRE(robot.runtime.running());
  }
  CHECK(client.status().bad_frames > 100);
  REQUIRE(upload(client, test::program(4).bytes()).running == 1);
}

TEST_CASE("the first faults are kept until a host listens, and sent once") {
  Robot robot;
  tool::Client client(robot);
  client.hello();
  CHECK(client.last_fault().thread == link::Name{});
  for (std::uint32_t pc = 1; pc <= 3; ++pc) {
    link::Fault fault{};
    fault.pc = pc;
    robot.server.report(fault);
  }
  CHECK_FALSE(client.next_unasked(milliseconds(100)));
  CHECK(client.last_fault().pc == 2);
  client.set_trace(true);
  for (std::uint32_t pc = 1; pc <= 2; ++pc) {
    const auto message = client.next_unasked(milliseconds(100));
    link::Fault fault{};
    REQUIRE(message);
    REQUIRE(message->type == MessageType::fault);
    REQUIRE(link::read_payload(message->payload, fault));
    CHECK(fault.pc == pc);
  }
  client.set_trace(true);
  CHECK_FALSE(client.next_unasked(milliseconds(100)));
  CHECK(client.last_fault().pc == 2);
}

TEST_CASE("a board that never stops talking, and answers nothing, does not keep the host") {
  class Talker final : public tool::Transport {
  public:
    Talker() : length_(link::encode_frame(MessageType::log, 0, {}, log_)) {}
    std::size_t read(std::span<std::byte> bytes, std::chrono::milliseconds) override {
      time_ += std::chrono::milliseconds(1);
      REQUIRE(++reads_ < 100'000);
      std::copy_n(log_.begin(), length_, bytes.begin());
      return length_;
    }
    void write(std::span<const std::byte>) override {}
    std::string name() const override { return "/dev/ttyACM0"; }
    Clock::time_point now() const override { return time_; }

  private:
    std::array<std::byte, link::kMaxEncodedFrame> log_{};
    std::size_t length_;
    Clock::time_point time_{};
    unsigned reads_ = 0;
  };
  Talker talker;
  tool::Client client(talker);
  CHECK_THROWS_WITH(client.hello(), Catch::Contains("the board sends, but does not answer"));
}

TEST_CASE("a board without power is reported with the port's name") {
  Robot robot;
  robot.to_board.set([](const test::Bytes&, std::size_t) { return test::Bytes(); });
  tool::Client client(robot, milliseconds(1000));
  const auto start = robot.now();
  CHECK_THROWS_WITH(client.hello(), Catch::Contains("memory: the board does not answer"));
  CHECK(robot.now() - start < milliseconds(1300));
}
