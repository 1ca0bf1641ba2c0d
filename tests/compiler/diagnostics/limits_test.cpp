// What is refused for its size says how large it is, or that it is larger than the limit, and what the limit is. The limits
// that a short program reaches are in golden/, those of codegen by itself in ../codegen/records_test.cpp.
#include <functional>
#include <tuple>

#include <catch2/catch.hpp>

#include "rsc/algorithm_modules.hpp"
#include "tests/compiler/compiled.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

using Piece = std::function<std::string(int)>;

std::string repeated(int count, const Piece& piece) {
  std::string text;
  for (int i = 0; i < count; ++i)
    text += piece(i);
  return text;
}

std::string number(int i) {
  return std::to_string(i);
}

std::string response(const std::string& statements) {
  return "AT START DO\n" + statements + "END\n";
}

// The robot of the documentation has a device that says any text.
std::string talking_robot() {
  return read_file(source_folder() / "docs/robot.json");
}

std::string said_of(const std::string& program, const std::string& robot) {
  const Options options{.source_lines = false,
                        .read_module = [](const std::string&, const std::string& name) {
                          return std::optional(Input{name, ""});
                        }};
  return messages(compile({"robot.rsl", program}, {"robot.json", robot}, options));
}

void says(const std::string& words, const std::string& program,
          const std::string& robot = common_robot()) {
  const std::string said = said_of(program, robot);
  INFO(words << "\n" << said.substr(0, 2000));
  CHECK(said.find(words) != std::string::npos);
}

// One sensor with this in its only channel.
std::string sensor_with(const std::string& channel) {
  return R"({"sensors": [{"name": "s", "type": "I2C", "address": "0x70", "channels": {"C": {)" +
         channel + "}}}]}";
}

}  // namespace

TEST_CASE("what the parser does not read") {
  says("this file has 16777217 bytes, and rsc reads at most 16777216",
       std::string((16U << 20U) + 1, '\n'));
  says("more than 30 mistakes, the most that rsc looks for in a file",
       repeated(31, [](int) { return "WHEN touch LEVEL > 3 = DO\n  LOG \"x\"\nEND\n"; }));
  says("nested deeper than 100 levels, the most that rsc reads",
       "LET x = 1" + repeated(101, [](int) { return " + 1"; }) + "\n");
}

TEST_CASE("statements that are too many") {
  const std::string log = "  LOG \"x\"\n";
  says("this response has more than 4096 statements, the most that rsc allows",
       response(repeated(4097, [&](int) { return log; })));
  says("this program has more than 65536 statements, the most that rsc allows",
       "DEFINE much\n" + repeated(4000, [&](int) { return log; }) + "END\n" +
           repeated(17, [](int) { return response("  much\n"); }));
  says("more than 16 levels deep, including those of DEFINEs",
       response(repeated(17, [](int) { return "IF touch LEVEL > 3 DO\n"; }) + log +
                repeated(17, [](int) { return "END\n"; })));
  says("add up to 4000000; the limit is 2147483",
       response("PICK ONE\nOPTION 2000000\n" + log + "OPTION 2000000\n" + log + "END\n"));
  says("`b` has 256 rules; the limit is 255", "BEHAVIOR b PRIORITY 5\n" + repeated(256, [&](int i) {
                                                return "EVERY " + number(i + 1) + "s DO\n" + log +
                                                       "END\n";
                                              }) + "END\n");
  says("`words` has 65 texts; a rule can choose from at most 64",
       "LIST words: \"x\"" + repeated(64, [](int i) { return ", \"" + number(i) + "\""; }) + "\n" +
           response("  LOG ANY words\n"));
  says("this text has 4 values; `SAY` takes at most 3", response("  SAY \"x\", 1, 2, 3, 4\n"),
       talking_robot());
  says("the program uses more than 64 modules, the most that rsc reads",
       repeated(65, [](int i) { return "USE \"m" + number(i) + ".rsl\"\n"; }));
}

TEST_CASE("numbers that are too large") {
  const std::string rest = " DO\n  LOG \"x\"\nEND\n";
  says("cannot store `3000000`: its numbers go from -2147483 to 2147483",
       "WHEN touch LEVEL < 3000000" + rest);
  says("cannot store `300000`: its numbers go from -214748cm to 214748cm",
       "WHEN proximity DISTANCE < 300000" + rest);
  says("cannot store `100000min`: its numbers go from -35791min to 35791min",
       "EVERY 100000min" + rest);
  says("has 20 digits; the limit is 16", "WHEN touch LEVEL < 99999999999999999999" + rest);
  says("has 10 decimal places; the limit is 9", "WHEN touch LEVEL < 0.0000000001" + rest);
  says("the result of this is above 2147483, the largest", "LET x = 2000000 + 2000000\n");
  says("the result of this is below -214748cm, the smallest", "LET x = -200000cm - 200000cm\n");
  says("this TEST would take 7200s; the limit is an hour, 3600s",
       "TEST \"x\"\n  AT 2h touch LEVEL = 3\nEND\n");
  says("this TEST would take 3601s; the limit is an hour, 3600s",
       "TEST \"x\"\n  WAIT 3000s\n  WAIT 601s\nEND\n");
}

TEST_CASE("numbers of robot.json that are too large") {
  const std::vector<std::tuple<std::string, std::string>> cases = {
      {R"("range": [0, 3000000])",
       "cannot store `3000000`: its numbers go from -2147483 to 2147483"},
      {R"("unit": "cm", "range": ["0cm", "300000cm"])",
       "cannot store `300000cm`: its numbers go from -214748cm to 214748cm"},
      {R"("range": [0, 0.12345678901])", "has 11 decimal places; the limit is 9"},
      {R"("range": [0, 123456789012345678])", "has 18 digits; the limit is 16"},
      {R"("range": [0, "1.2.3"])", "this number cannot be read"},
      {R"("range": [0, 1e999])", "cannot store `1e999`: its numbers go from -2147483 to 2147483"},
      {R"("scale": 0)", "a scale cannot be 0"},
      {R"("scale": 3000000)",
       "this scale is 3000000000/1 in thousandths, but a robot stores fractions up to "
       "2147483647/65535"},
      {R"("unit": "cm", "scale": "0.000000007cm")",
       "this scale is 7/100000 in thousandths of `mm`"},
      {R"("rate": "0Hz")", "a rate must be above 0"},
      {R"("stale_after": "70s")", "this is 70000 ms, but must be from 1 ms to 65535 ms"},
  };
  for (const auto& [channel, words] : cases)
    says(words, "", sensor_with(channel));
}

TEST_CASE("an image that is too large") {
  const auto rules = [](int count, const Piece& rule) {
    return repeated(5, [&](int behavior) {
      return "BEHAVIOR b" + number(behavior) + " PRIORITY " + number(behavior + 1) + "\n" +
             repeated(count, [&](int i) { return rule(behavior * count + i); }) + "END\n";
    });
  };
  says(" bytes; the limit is 65536", rules(8, [](int rule) {
         return response(repeated(30, [&](int i) {
           const std::string text = number(1'000'000 + 100 * rule + i);
           return "  LOG \"" + text + std::string(42, '.') + "\"\n";
         }));
       }));
  says(" words of memory for its time words; the limit is 4096", rules(50, [](int rule) {
         return "WHEN touch LEVEL > " + number(rule) +
                " / 100 16 TIMES WITHIN 5s DO\n  LOG \"x\"\nEND\n";
       }));
  says(
      "the program needs 4840 cells for the inputs and values of its behaviours; the limit is "
      "4096",
      repeated(20, [](int) {
        return response(repeated(
            240, [](int) { return "  REPEAT touch LEVEL TIMES\n    WAIT 10ms\n  END\n"; }));
      }));
}
