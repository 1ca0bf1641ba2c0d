// An image that is whole but wrong: every verb that takes one says what is wrong with it, in which
// section, at which word or record, and which line of the source that comes from.
#include <algorithm>
#include <cstring>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "tests/rsc/image.hpp"
#include "tests/rsc/process.hpp"
#include "vm/identity.hpp"
#include "vm/opcode.hpp"

using namespace robosync;
using Catch::Contains;
using test::Outcome;

namespace {

constexpr unsigned kDistanceLine = 5;  // of test::kProgram: the rule that looks at the distance

// A compiled program in a folder, changed, with its checksum made right again.
struct WrongImage : test::Folder {
  WrongImage() {
    write("robot.json", test::kRobot);
    REQUIRE(test::rsc({"compile", write("robot.rsl", test::kProgram)}).exit == 0);
    const std::string text = read("robot.rsb");
    bytes.resize(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    REQUIRE(vm::view_image(bytes, view));
  }
  template <typename Record>
  void change(const Record& record, const Record& wrong) {
    const auto offset = reinterpret_cast<const std::byte*>(&record) - bytes.data();
    std::memcpy(bytes.data() + offset, &wrong, sizeof wrong);
    vm::seal(bytes);
  }
  const vm::Rule& rule() const {
    const auto found = std::ranges::find(view.rules, kDistanceLine, &vm::Rule::line);
    REQUIRE(found != view.rules.end());
    return *found;
  }
  // What dump, run and upload say of it.
  void check(const std::string& said) {
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string file = write("wrong.rsb", text);
    for (const Outcome& outcome : {test::rsc({"dump", file}), test::rsc({"run", file}),
                                   test::rsc({"upload", file, "--port", "nowhere"})}) {
      CHECK(outcome.exit == 1);
      CHECK_THAT(outcome.err, Contains("wrong.rsb: " + said));
    }
  }

  std::vector<std::byte> bytes;
  vm::Image view;
};

}  // namespace

TEST_CASE("a refused word is shown with its place and its source line") {
  WrongImage image;
  const std::size_t word = image.rule().condition_start;
  image.change(image.view.code[word], vm::Word{0xFF});
  image.check(
      fmt::format("there is no such opcode (code, word {}, source line {})", word, kDistanceLine));
}

TEST_CASE("a refused rule is shown with its source line") {
  WrongImage image;
  vm::Rule wrong = image.rule();
  wrong.then_response = 99;
  image.change(image.rule(), wrong);
  image.check(
      fmt::format("a record refers to one that does not exist (rules, record {}, source line {})",
                  &image.rule() - image.view.rules.data(), kDistanceLine));
}

TEST_CASE("a refused record of another section is shown without a line") {
  WrongImage image;
  vm::Channel wrong = image.view.channels[1];
  wrong.scale_den = 0;
  image.change(image.view.channels[1], wrong);
  image.check("a field has a value it must not have (channels, record 1)");
}

// As large as one board takes, and larger than another one takes.
TEST_CASE("an image is run with the memory of the board that it is for") {
  const test::Folder folder;
  std::string actuators, rules;
  for (unsigned a = 0; a < 32; ++a)
    actuators += fmt::format(R"({}{{"name": "a{}", "type": "VIRTUAL", "device": "servo"}})",
                             a == 0 ? "" : ",", a);
  for (unsigned b = 0; b < 60; ++b) {
    rules += fmt::format("BEHAVIOR b{} PRIORITY {}\n", b, b + 1);
    for (unsigned r = 0; r < 16; ++r)
      rules += fmt::format("WHEN touch LEVEL > {}.{} DO MOVE a{} TO {}deg END\n", r % 10, r,
                           (b + r) % 32, r);
    rules += "END\n";
  }
  const std::string program = folder.write("robot.rsl", rules);
  for (const auto& [board, fits] : {std::pair{"mps2-an386", true}, {"b-l475e-iot01a", false}}) {
    folder.write("robot.json",
                 fmt::format(R"({{"board": "{}", "sensors": [{{"name": "touch", "type": "VIRTUAL",
      "channels": {{"LEVEL": {{"range": [0, 10]}}}}}}], "actuators": [{}]}})",
                             board, actuators));
    REQUIRE(test::rsc({"compile", program, "--anyway"}).exit == 0);
    const Outcome outcome = test::rsc({"run", folder.path("robot.rsb"), "--duration", "1ms"});
    CAPTURE(board, outcome.err);
    CHECK(outcome.exit == (fits ? 0 : 1));
    if (!fits) CHECK_THAT(outcome.err, Contains("98304"));
  }
}
