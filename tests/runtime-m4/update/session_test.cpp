// Which host owns the line: two hosts on one line, each with its own client, whose frames are mixed as a serial port server would
// mix them; and hosts that go away, come back, or find the board restarted.
#include "runtime-m4/update/session.hpp"

#include <array>
#include <cstring>
#include <string>

#include <catch2/catch.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "rsc/device/client.hpp"
#include "rsc/device/host_name.hpp"
#include "rsc/device/uploader.hpp"
#include "rsc/failure.hpp"
#include "tests/runtime-m4/update/programs.hpp"
#include "tests/runtime-m4/update/robot.hpp"

using namespace robosync;
using link::MessageType;
using std::chrono::milliseconds;
using test::Robot;

namespace {

constexpr unsigned kSilenceMs = 3000;

constexpr link::SessionId kDesk = 0x00770077;

// Another host is in the middle of a transfer: it has sent hello and begin.
void host_begins(Robot& robot, const tool::Program& program, const link::Name& host) {
  tool::Client client(robot);
  client.send(MessageType::hello, link::wire_bytes(link::Hello{kDesk, 0, {}, host}));
  REQUIRE(client.next_reply(milliseconds(100)));
  const auto size = static_cast<std::uint32_t>(program.bytes().size());
  const link::Begin begin{kDesk, size, test::name_of(program), {}};
  client.send(MessageType::begin, link::wire_bytes(begin));
  const auto reply = client.next_reply(milliseconds(100));
  REQUIRE(reply);
  REQUIRE(reply->type == MessageType::transfer_status);
}

// The number of a process that does not exist any more.
pid_t ended_process() {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  REQUIRE(waitpid(child, nullptr, 0) == child);
  return child;
}

void desk_begins(Robot& robot, const tool::Program& program) {
  host_begins(robot, program, {"desk"});
}

// This computer's name, as another computer with the same name would give it.
link::Name namesake() {
  link::Name name = tool::host_name(ended_process());
  name.back() = static_cast<char>(~name.back());  // another process …
  name[link::kNameLength - 5] = static_cast<char>(~name[link::kNameLength - 5]);  // … elsewhere
  return name;
}

bool uploads(tool::Client& client, const tool::Program& program) {
  return tool::upload(client, client.hello(), program.bytes(), {}).activation.running == 1;
}

}  // namespace

TEST_CASE("while one host uploads, another one is told who has the line, and changes nothing") {
  Robot robot;
  const tool::Program mine = test::program(3), other = test::program(5);
  desk_begins(robot, mine);
  robot.run(1200);
  tool::Client second(robot);
  try {
    (void)uploads(second, other);
    FAIL("the line was the other host's");
  } catch (const tool::Failure& failure) {
    CHECK(failure.exit() == tool::Exit::outside);
    CHECK_THAT(failure.what(),
               Catch::Contains("busy: desk is uploading a program, and has had the line") &&
                   Catch::Contains("for 1 s") && Catch::Contains("--take"));
  }
  CHECK_THROWS_AS(second.resume(), tool::Failure);
  CHECK_THROWS_AS(second.feed({.channel = 0, .at_us = 0, .value = 1}), tool::Failure);
  CHECK(second.status().activations == 0);
  CHECK(second.hello().running == 0);  // everybody gets an answer to hello
  CHECK(second.stop().activations == 0);
  CHECK(robot.runtime.stopped());  // and stop works for everybody
}

TEST_CASE("a host that has gone away keeps the line for three seconds, and not from who takes it") {
  const tool::Program mine = test::program(3), other = test::program(5);
  SECTION("gone for long") {
    Robot robot;
    desk_begins(robot, mine);
    robot.run(kSilenceMs + 100);
    tool::Client second(robot);
    CHECK(uploads(second, other));
  }
  SECTION("taken") {
    Robot robot;
    desk_begins(robot, mine);
    tool::Client second(robot, milliseconds(2000), true);
    CHECK(uploads(second, other));
    CHECK(second.hello().program_hash == other.image().header->program_hash);
  }
}

TEST_CASE(
    "between its requests a host has no line: others do what they want, and so does it again") {
  Robot robot;
  const tool::Program mine = test::program(3), other = test::program(5);
  tool::Client first(robot), second(robot);
  CHECK(uploads(first, mine));
  CHECK(uploads(second, other));
  CHECK(first.feed({.channel = 0, .at_us = 0, .value = 1000}).error == link::FeedError::none);
  CHECK(second.feed({.channel = 0, .at_us = 0, .value = 2000}).error == link::FeedError::none);
  CHECK(uploads(first, mine));
}

TEST_CASE("data of another session is not taken, though it is at the wanted offset") {
  Robot robot;
  const tool::Program mine = test::program(3);
  desk_begins(robot, mine);
  tool::Client other(robot);
  std::vector<std::byte> payload(sizeof(link::Data) + 100, std::byte{0x77});
  const link::Data head{static_cast<std::uint16_t>(kDesk + 1), 0};
  std::memcpy(payload.data(), &head, sizeof head);
  for (const MessageType type : {MessageType::data, MessageType::pieces}) {
    other.send(type, payload);
    const auto reply = other.next_reply(milliseconds(100));
    REQUIRE(reply);
    CHECK(reply->type == MessageType::busy);
  }
}

TEST_CASE("what another rsc of this computer has left behind does not keep the line") {
  Robot robot;
  const tool::Program mine = test::program(3), other = test::program(5);
  {
    tool::Client gone(robot);
    gone.hello();
    const auto size = static_cast<std::uint32_t>(other.bytes().size());
    const link::Begin begin{gone.session(), size, test::name_of(other), {}};
    gone.send(MessageType::begin, link::wire_bytes(begin));
    REQUIRE(gone.next_reply(milliseconds(100)));
  }
  tool::Client next(robot);
  CHECK(uploads(next, mine));
}

TEST_CASE("another computer with the same name keeps the line that it has") {
  Robot robot;
  host_begins(robot, test::program(3), namesake());
  tool::Client second(robot);
  CHECK_THROWS_WITH(uploads(second, test::program(5)), Catch::Contains("busy: "));
}

TEST_CASE("what a process of this computer has left behind is taken when the process has ended") {
  const tool::Program mine = test::program(3), other = test::program(5);
  SECTION("it has ended") {
    Robot robot;
    host_begins(robot, mine, tool::host_name(ended_process()));
    tool::Client next(robot);
    CHECK(uploads(next, other));
  }
  SECTION("it still runs") {
    Robot robot;
    host_begins(robot, mine, tool::host_name(getppid()));
    tool::Client next(robot);
    CHECK_THROWS_WITH(uploads(next, other), Catch::Contains("busy: "));
    robot.run(kSilenceMs + 100);
    CHECK(uploads(next, other));
  }
}

TEST_CASE("of a host's name only the name is shown") {
  std::array<char, 256> name{};
  REQUIRE(gethostname(name.data(), name.size() - 1) == 0);
  const std::string whole = name.data();
  CHECK(tool::host_text(tool::host_name(getpid())) == whole.substr(0, 11));
  CHECK(tool::host_text({"raspberrypi1234"}) == "raspberrypi");
  CHECK_FALSE(tool::is_gone({"raspberrypi1234"}));
  CHECK_FALSE(tool::is_gone({"desk"}));
  CHECK_FALSE(tool::is_gone({}));
}

TEST_CASE("a line that was taken is not taken back") {
  Robot robot;
  const tool::Program mine = test::long_program();
  tool::Client first(robot, milliseconds(2000), true);
  REQUIRE(first.hello().running == 0);
  desk_begins(robot,
              test::program(3));  // closes the session of the first, whose upload has not begun
  CHECK_THROWS_WITH(tool::upload(first, {}, mine.bytes(), {}), Catch::Contains("busy: desk"));
}

TEST_CASE("a board that has started again knows no session, and is greeted again") {
  const tool::Program mine = test::long_program();
  Robot robot;
  tool::Client client(robot);  // has sent hello before the board restarted
  CHECK(tool::upload(client, {}, mine.bytes(), {}).activation.running == 1);
  Robot again;
  tool::Client other(again);
  CHECK(other.feed({.channel = 0, .at_us = 0, .value = 1}).error == link::FeedError::no_program);
}
