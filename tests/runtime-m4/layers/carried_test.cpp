// What an upload carries over: which variables of the new program begin with the values of the old one's.
#include "runtime-m4/layers/carried.hpp"

#include <catch2/catch.hpp>

#include "tests/runtime-m4/rig.hpp"
#include "tests/runtime-m4/robot.hpp"

using namespace robosync;
using test::compile;
using test::kPlainRobot;
using test::Rig;

namespace {

// Runs `before` for 3 s with near X at 20, then `after`; returns what `after` begins with.
std::string beginnings(const std::string& before, const std::string& after, bool carries = true) {
  Rig rig;
  REQUIRE(rig.activate(compile(before, kPlainRobot)).ok());
  rig.feed(0, 20);
  rig.run(3000);
  const std::size_t earlier = rig.only("set").size();
  rig.runtime.begin_with({}, carries);
  REQUIRE(rig.activate(compile(after, kPlainRobot)).ok());
  return rig.only("set").substr(earlier);
}

// A program with these declarations, which SETs what they declare.
std::string with(const std::string& declarations, const std::string& body) {
  return declarations + "\nWHEN near X > 10\nDO\n" + body + "\nEND\n";
}

}  // namespace

TEST_CASE("a REMEMBER goes on with its value, found by name and dimension, inside of its range") {
  const std::string before =
      with("REMEMBER visits = 0\nREMEMBER way = 5cm", "SET visits TO 7\nSET way TO 40cm");
  const auto after = [&before](const std::string& declarations, const std::string& body) {
    return beginnings(before, with(declarations, body));
  };
  CHECK(after("REMEMBER way = 5cm\nREMEMBER Visits = 0", "SET Visits TO 1\nSET way TO 1cm") ==
        "0 #0 set way 400\n0 #0 set Visits 7\n");
  CHECK(after("REMEMBER visits = 0 KEPT", "SET visits TO 1") == "0 #0 set visits 7\n");
  CHECK(after("REMEMBER visits = 0s", "SET visits TO 1s").empty());
  CHECK(after("REMEMBER others = 0", "SET others TO 1").empty());
  CHECK(after("STATE visits: few, many", "SET visits TO many").empty());
}

TEST_CASE("a STATE keeps its label, wherever that is in its list now") {
  const std::string before = with("STATE mood: calm, glad, cross", "SET mood TO cross");
  CHECK(beginnings(before, with("STATE mood: calm, cross", "SET mood TO calm")) ==
        "0 #0 set mood 1\n");
  CHECK(beginnings(before, with("STATE mood: calm, glad", "SET mood TO glad")).empty());
}

TEST_CASE("what has the same name, but is of another kind, is not carried over") {
  const std::string state = with("STATE mood: calm, glad", "SET mood TO glad");
  const std::string feeling = with("FEELING mood FROM 0 TO 10 START 0", "SET mood TO 8");
  const std::string number = with("REMEMBER mood = 0", "SET mood TO 3");
  for (const std::string& before : {state, feeling, number})
    for (const std::string& after : {state, feeling, number})
      CHECK(beginnings(before, after).empty() == (before != after));
}

TEST_CASE("a FEELING goes on fading from where it was") {
  const std::string before = with("FEELING joy FROM 0 TO 10 START 0", "SET joy TO 8");
  CHECK(beginnings(before, with("FEELING joy FROM 0 TO 5 START 0", "SET joy TO 1")) ==
        "0 #0 set joy 5\n");
}

TEST_CASE("a name that several behaviours use for variables of their own is not carried over") {
  const auto counting = [](const std::string& name, int priority) {
    return "BEHAVIOR " + name + " PRIORITY " + std::to_string(priority) +
           "\nREMEMBER count = 0\nWHEN near X > 10\nDO SET count TO 3\nEND\nEND\n";
  };
  const std::string one = counting("one", 10), two = one + counting("two", 20);
  CHECK(beginnings(one, one) == "0 #0 set count 3\n");
  CHECK(beginnings(one, two).empty());
  CHECK(beginnings(two, one).empty());
}

TEST_CASE("TIMERs, SIGNALs and the bands of CHECKs begin anew") {
  const std::string text =
      with("TIMER pause\nCHECK nearness OF near X\nclose ABOVE 10\nfar OTHERWISE\nEND",
           "RESTART pause\nSIGNAL seen") +
      "WHEN seen DO LOG \"seen\" END\nWHEN nearness IS far DO LOG \"far\" END\n"
      "WHEN pause > 1s DO LOG \"pause\" END\n";
  CHECK(beginnings(text, text).empty());
}

TEST_CASE("nothing is carried over when it is not wanted, nor from a program that has ended") {
  const std::string text = with("REMEMBER visits = 0", "SET visits TO 7");
  CHECK(beginnings(text, text, false).empty());
  Rig rig;
  rig.runtime.begin_with({}, true);
  REQUIRE(rig.activate(compile(text, kPlainRobot)).ok());
  rig.feed(0, 20);
  rig.run(100);
  CHECK(rig.only("set") == "1 #2 set visits 7\n");
  rig.runtime.clear();
  REQUIRE(rig.activate(compile(text, kPlainRobot)).ok());
  CHECK(rig.only("set") == "1 #2 set visits 7\n");
}
