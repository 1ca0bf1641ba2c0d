// A fix that is certain shall give back what was meant: the examples get each of their words changed in turn, all such
// fixes are made, and what comes out must do what the example does. Numbers are damaged as fingers do it, too. The same for
// their robot.json.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>

#include <catch2/catch.hpp>

#include "compiler/diagnostics/render.hpp"
#include "compiler/syntax/lexer.hpp"
#include "tests/compiler/syntax/examples.hpp"
#include "tests/compiler/syntax/mutations.hpp"
#include "tests/support/share.hpp"
#include "vm/image.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;
using robosync::testing::read_file;

namespace {

namespace fs = std::filesystem;
namespace vm = robosync::vm;

// A robot with other names for its variables and their words does the same.
void leave_out_names(std::vector<std::byte>& image, const vm::Image& view) {
  const auto leave_out = [&](std::uint16_t name) {
    const std::string_view text = view.string(name);
    const auto at = reinterpret_cast<const std::byte*>(text.data()) - image.data();
    std::memset(image.data() + at, 'x', text.size());
  };
  for (const vm::Variable& variable : view.variables)
    leave_out(variable.name);
  for (const std::uint16_t label : view.labels)
    leave_out(label);
}

// What the robot does: the image without the hash of its text, without lines and names.
std::vector<std::byte> meaning(std::vector<std::byte> image) {
  vm::ImageHeader header{};
  REQUIRE(image.size() >= sizeof header);
  vm::Image view;
  REQUIRE(vm::view_image(image, view));
  const auto rules = reinterpret_cast<const std::byte*>(view.rules.data()) - image.data();
  for (std::size_t i = 0; i < view.rules.size(); ++i) {
    const std::size_t at =
        static_cast<std::size_t>(rules) + i * sizeof(vm::Rule) + offsetof(vm::Rule, line);
    std::memset(image.data() + at, 0, sizeof(vm::Rule::line));
  }
  leave_out_names(image, view);
  std::memcpy(&header, image.data(), sizeof header);
  header.program_hash = {};
  header.seed = header.crc32 = 0;
  std::memcpy(image.data(), &header, sizeof header);
  return image;
}

struct Change {
  std::string kind, text;
};

std::string replaced(const std::string& text, Span span, std::string_view by) {
  std::string changed = text;
  return changed.replace(span.begin, span.end - span.begin, by);
}

void change_number(std::vector<Change>& changes, const std::string& program, Span span) {
  const std::string number = program.substr(span.begin, span.end - span.begin);
  const Span front{span.file, span.begin, span.begin};
  changes.push_back({"sign", replaced(program, front, "-")});
  changes.push_back({"point first", replaced(program, front, ".")});
  if (number.find('.') != std::string::npos) {
    std::string comma = number;
    comma[comma.find('.')] = ',';
    changes.push_back({"comma", replaced(program, span, comma)});
  }
  const std::size_t digits = std::min(number.find_first_not_of("0123456789."), number.size());
  for (const char* const inserted : {",", ",5", " ", ".", "..", "x"}) {
    std::string other = number;
    changes.push_back({"in a number", replaced(program, span, other.insert(digits, inserted))});
    other = number;
    changes.push_back({"in a number", replaced(program, span, other.insert(1, inserted))});
  }
}

std::vector<Change> changes_of(const std::string& program) {
  Diagnostics ignored;
  SourceMap sources;
  const FileId file = sources.add("robot.rsl", program);
  const std::vector<Token> tokens = lex(sources.file(file), file, ignored);
  std::vector<Change> changes;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const Token& token = tokens[i];
    const std::string text = program.substr(token.span.begin, token.span.end - token.span.begin);
    const Span front{file, token.span.begin, token.span.begin};
    changes.push_back({"left out", replaced(program, token.span, "")});
    changes.push_back({"twice", replaced(program, front, text + " ")});
    changes.push_back({"NOT before it", replaced(program, front, "NOT ")});
    if (token.kind == Kinds::NEWLINE)
      changes.push_back({"semicolon before it", replaced(program, front, " ;")});
    if (token.kind == Kinds::NEWLINE) continue;
    changes.push_back({"line ended before it", replaced(program, front, "\n")});
    if (token.kind == Kinds::QUANTITY) change_number(changes, program, token.span);
    if (text.size() > 3 && token.kind != Kinds::STRING) {
      std::string slip = text;
      std::swap(slip[1], slip[2]);
      changes.push_back({"misspelt", replaced(program, token.span, slip)});
    }
    if (i + 1 < tokens.size() && tokens[i + 1].kind != Kinds::NEWLINE) {
      const Span& next = tokens[i + 1].span;
      const std::string other = program.substr(next.begin, next.end - next.begin);
      changes.push_back(
          {"exchanged", replaced(program, {file, token.span.begin, next.end}, other + " " + text)});
    }
  }
  return changes;
}

// `program`, which is the text of `file`, with all fixes of the errors that are certain, from the last to the first; none that
// overlaps another.
std::string fixed(const std::string& program, const Result& result, FileId file = kProgramFile) {
  std::vector<Fix> fixes;
  for (const Diagnostic& diagnostic : result.diagnostics.all())
    for (const Fix& fix : diagnostic.fixes)
      if (diagnostic.level == Level::error && fix.span.file == file &&
          fix.applicability == Applicability::certain)
        fixes.push_back(fix);
  std::ranges::sort(fixes, std::ranges::greater{}, [](const Fix& fix) { return fix.span.begin; });
  std::string text = program;
  std::size_t free = text.size();
  for (const Fix& fix : fixes) {
    if (fix.span.end > free) continue;
    text = replaced(text, fix.span, fix.replacement);
    free = fix.span.begin;
  }
  return text;
}

struct FixTally {
  std::size_t programs = 0, wrong = 0, with_fix = 0, same = 0, still_wrong = 0, other = 0;

  FixTally& operator+=(const FixTally& more) {
    programs += more.programs;
    wrong += more.wrong;
    with_fix += more.with_fix;
    same += more.same;
    still_wrong += more.still_wrong;
    other += more.other;
    return *this;
  }
};

FixTally try_fix(const Example& example, const Change& change,
                 const std::vector<std::byte>& meant) {
  FixTally tally{.programs = 1};
  const Result result = compiled(change.text, example.robot);
  if (result.diagnostics.errors() == 0) return tally;
  tally.wrong = 1;
  const std::string mended = fixed(change.text, result);
  if (mended == change.text) return tally;
  tally.with_fix = 1;
  Result again = compiled(mended, example.robot);
  const bool wrong = again.image.empty();
  if (!wrong && meaning(std::move(again.image)) == meant) {
    tally.same = 1;
    return tally;
  }
  (wrong ? tally.still_wrong : tally.other) = 1;
  WARN(example.name << ", " << change.kind << ":\n"
                    << render_human(result.diagnostics, result.sources, false));
  return tally;
}

void warn_of(const std::map<std::string, FixTally>& tallies) {
  for (const auto& [kind, tally] : tallies)
    WARN(kind << ": " << tally.programs << " changed programs, " << tally.wrong << " wrong, "
              << tally.with_fix << " with a fix, which gives the example in " << tally.same
              << ", a program that is wrong in " << tally.still_wrong << ", another one in "
              << tally.other);
}

}  // namespace

TEST_CASE("what a fix gives means what was meant", "[mutation]") {
  constexpr std::size_t every = 7;  // change that is tried
  const bool all = std::getenv("ROBOSYNC_ALL_FIXES") != nullptr;
  std::map<std::string, FixTally> tallies;
  FixTally total;
  std::size_t number = 0;
  for (const Example& example : examples()) {
    const std::vector<std::byte> meant = meaning(compiled(example.program, example.robot).image);
    for (const Change& change : changes_of(example.program)) {
      ++number;
      if (!all && (number % every != 0 || !robosync::test::in_share(number / every))) continue;
      const FixTally tried = try_fix(example, change, meant);
      tallies[change.kind] += tried;
      total += tried;
    }
  }
  tallies["all"] = total;
  warn_of(tallies);
  CHECK(total.with_fix >= robosync::test::share_of(300U));
  CHECK(total.same == total.with_fix);
}

namespace {

FixTally try_fix_of_robot(const Example& example, const std::string& robot,
                          const std::vector<std::byte>& meant) {
  FixTally tally{.programs = 1};
  const Result result = compiled(example.program, robot);
  if (result.diagnostics.errors() == 0) return tally;
  tally.wrong = 1;
  const std::string program = fixed(example.program, result);
  const std::string mended = fixed(robot, result, kConfigurationFile);
  // A fix of the program alone takes a name from robot.json, whose names count as right: the robot does the same by that name.
  if (mended == robot) return tally;
  tally.with_fix = 1;
  Result again = compiled(program, mended);
  const bool wrong = again.image.empty();
  if (!wrong && meaning(std::move(again.image)) == meant) {
    tally.same = 1;
    return tally;
  }
  (wrong ? tally.still_wrong : tally.other) = 1;
  WARN(example.name << ":\n" << render_human(result.diagnostics, result.sources, false));
  return tally;
}

}  // namespace

TEST_CASE("what a fix of a robot.json gives means what was meant", "[mutation]") {
  const int rounds = robosync::test::share_of(20);  // of each mutation, for each example
  std::mt19937 random(20230602);
  std::map<std::string, FixTally> tallies;
  FixTally total;
  for (const Example& example : examples()) {
    const std::vector<std::byte> meant = meaning(compiled(example.program, example.robot).image);
    for (const Mutation mutation : every_mutation)
      for (int round = 0; round < rounds; ++round) {
        const FixTally tried =
            try_fix_of_robot(example, mutate_json(example.robot, mutation, random), meant);
        tallies[name_of(mutation)] += tried;
        total += tried;
      }
  }
  tallies["all"] = total;
  warn_of(tallies);
  CHECK(total.with_fix >= robosync::test::share_of(300U));
  CHECK(total.same == total.with_fix);
}

TEST_CASE("a fix never changes what a number or a condition says") {
  const std::string robot = read_file(fs::path(ROBOSYNC_SOURCE_DIR) / "docs/robot.json");
  for (const char* const program : {
           "SAFETY\n  WHEN touch IS\n LEVEL > 3 DO\n    STOP left_arm\n  END\nEND\n",
           "WHEN touch LEVEL > 3 DO\n  MOVE left_arm TO 3,5deg\nEND\n",
           "WHEN touch LEVEL > 3,5 DO\n  LOG \"x\"\nEND\n",
           "WHEN touch LEVEL > 3 5 DO\n  LOG \"x\"\nEND\n",
           "WHEN touch LEVEL > 5. DO\n  LOG \"x\"\nEND\n",
           "WHEN touch LEVEL > .5 DO\n  LOG \"x\"\nEND\n",
           "BEHAVIOR b PRIORITY -5\n  WHEN touch LEVEL > 3 DO\n    LOG \"x\"\n  END\nEND\n",
           "BEHAVIOR b PRIORITY 5 5\n  WHEN touch LEVEL > 3 DO\n    LOG \"x\"\n  END\nEND\n",
       }) {
    const Result result = compiled(program, robot);
    CAPTURE(program, render_human(result.diagnostics, result.sources, false));
    CHECK(result.diagnostics.errors() > 0);
    CHECK(fixed(program, result) == program);
  }
}

TEST_CASE("a fix is certain only where nothing else can be meant") {
  const std::string robot = read_file(fs::path(ROBOSYNC_SOURCE_DIR) / "docs/robot.json");
  const std::string rest = " DO\n  LOG \"x\"\nEND\n";
  for (const std::string& program :
       {"touch LEVEL > 3" + rest,                         // WHEN or WHILE
        " greetings\nWHEN touch LEVEL > 3" + rest,        // USE
        std::string("LIST words: \"one\", , \"two\"\n"),  // a text is missing
        std::string("REMEMBER joy = 0\nAT START DO\n  RAISE my joy BY 1\nEND\n"),
        std::string("REMEMBER n = 0\nAT START DO\n  SET n TO n // 2\nEND\n"),
        std::string("AT START DO\n  SHOW face tick\nEND\n"),  // PICK
        std::string("AT START DO\n  MOVE the head TO 30deg\nEND\n"),
        std::string("REMEMBER n = 0\nAT START DO\n  ADD 1 TO n\nEND\n"),
        std::string("AT START DO\n  SAY 'It's nice'\nEND\n"),
        "WHEN wave_detect SEEN IS NOT FALSE" + rest,  // NOT is too much
        "WHEN touch LEVEL > 3 AND (touch LEVEL < 5 OR wave_detect))" +
            rest,  // or a bracket is missing
        std::string("WHEN hand hand LEVEL > 3 DO\n  LOG \"x\"\nEND\n")}) {  // AND

    const Result result = compiled(program, robot);
    CAPTURE(program, render_human(result.diagnostics, result.sources, false));
    CHECK(result.diagnostics.errors() == 1);
    CHECK(fixed(program, result) == program);
  }
  for (
      const char* const from_json : {
          R"({"actuators": [{"name": "left_arm", "type": "VIRTUAL", "device": "joint", "range": ["0deg",]}]})",
          R"({"actuators": [{"name": "left_arm", "type" "device": "joint"}]})",
          R"({"sensors": [{"name""touch" :, "type": "VIRTUAL"}]})",
      }) {
    const Result result = compiled("AT START DO\n  LOG \"x\"\nEND\n", from_json);
    CAPTURE(from_json, render_human(result.diagnostics, result.sources, false));
    CHECK(result.diagnostics.errors() == 1);
    CHECK(fixed(from_json, result, kConfigurationFile) == from_json);
  }
  for (const std::string& wrong :
       {"WHEN WHEN touch LEVEL > 3" + rest,
        std::string("REMEMBER my_joy = 0\nAT START DO\n  RAISE my joy BY 1\nEND\n"),
        std::string("FEELING my_joy FROM 0 TO 9 START 5\nAT START DO\n  LOWER My Joy BY 1\nEND\n"),
        std::string("STATE my_mood: calm, sad\nAT START DO\n  SET my mood TO sad\nEND\n")}) {
    CAPTURE(wrong);
    const Result result = compiled(wrong, robot);
    CHECK(result.diagnostics.errors() == 1);
    CHECK(compiled(fixed(wrong, result), robot).diagnostics.errors() == 0);
  }
}

namespace {

// With all fixes of the errors, whatever they are sure of.
std::string fixed_likely(const std::string& program, const Result& result) {
  std::string text = program;
  const auto& all = result.diagnostics.all();
  for (auto diagnostic = all.rbegin(); diagnostic != all.rend(); ++diagnostic)
    if (diagnostic->level == Level::error && !diagnostic->fixes.empty())
      text = replaced(text, diagnostic->fixes.front().span, diagnostic->fixes.front().replacement);
  return text;
}

}  // namespace

TEST_CASE("a fix that is likely does not leave out what says the opposite") {
  const std::string robot = read_file(fs::path(ROBOSYNC_SOURCE_DIR) / "docs/robot.json");
  const std::string words =
      "STATE mood: calm, happy\nWHEN touch LEVEL > 7 DO SET mood TO happy END\n";
  const std::string rest = " DO\n  LOG \"x\"\nEND\n";
  const std::vector<std::pair<std::string, std::string>> meant = {
      {"WHEN touch LEVEL NOT > 4" + rest, "WHEN touch LEVEL <= 4" + rest},
      {"WHEN touch LEVEL NOT = 4" + rest, "WHEN touch LEVEL <> 4" + rest},
      {words + "WHEN mood BECOMES NOT happy" + rest, words + "WHEN mood IS NOT happy" + rest},
      {words + "WHEN mood isn't happy" + rest, words + "WHEN mood IS NOT happy" + rest},
      {"WHEN wave_detect isn't TRUE" + rest, "WHEN wave_detect IS FALSE" + rest},
      {"WHEN proximity DISTANCE < 80,5 cm" + rest, "WHEN proximity DISTANCE < 80.5cm" + rest},
      {"AT START DO\n  WAIT 1,000ms\nEND\n", "AT START DO\n  WAIT 1s\nEND\n"},
      {"AT START DO\n  WAIT 2'500ms\nEND\n", "AT START DO\n  WAIT 2.5s\nEND\n"},
      {"WHEN voice WORD IS (\"stop\" OR \"go\") FOR 2s" + rest,
       "WHEN voice WORD IS \"stop\" OR voice WORD IS \"go\" FOR 2s" + rest},
      {"REMEMBER n = 7\nAT START DO\n  SET n TO n // 2\nEND\n",
       "REMEMBER n = 7\nAT START DO\n  SET n TO (n - n MOD 2) / 2\nEND\n"},
      {"REMEMBER n = 7\nAT START DO\n  SET n TO (n%2)\nEND\n",
       "REMEMBER n = 7\nAT START DO\n  SET n TO n MOD 2\nEND\n"},
      {"TEST \"a\"\n  AT 1s red_button = \"presed\"\nEND\nAT START DO\n  LOG \"x\"\nEND\n",
       "TEST \"a\"\n  AT 1s red_button = \"pressed\"\nEND\nAT START DO\n  LOG \"x\"\nEND\n"},
      {"AT START DO\n  WAIT 1s THEN LOG \"x\"\nEND\n",
       "AT START DO\n  WAIT 1s\n  THEN\n  LOG \"x\"\nEND\n"},
  };
  for (const auto& [program, right] : meant) {
    const Result result = compiled(program, robot);
    CAPTURE(program, render_human(result.diagnostics, result.sources, false));
    CHECK(result.diagnostics.errors() == 1);
    const Result again = compiled(fixed_likely(program, result), robot);
    CHECK(again.diagnostics.errors() == 0);
    CHECK(meaning(again.image) == meaning(compiled(right, robot).image));
  }
  for (const std::string& program :
       {"WHILE touch LEVEL > 3" + rest.substr(0, rest.size() - 4) + "ELSE\n  LOG \"y\"\nEND\n",
        std::string("REMEMBER x = 0\nAT START DO\n  SET x BY 3\nEND\n"),
        std::string("REMEMBER x = 0\nAT START DO\n  RAISE x TO 3\nEND\n"),
        std::string("AT START DO\n  REPEAT\n    LOG \"x\"\n  END\nEND\n"),
        std::string(
            "SAFETY s\n  WHEN arms FORCE > 3N\n  DO STOP arms\n  RESUME AFTER 2s\nEND\n")}) {
    const Result result = compiled(program, robot);
    CAPTURE(program, render_human(result.diagnostics, result.sources, false));
    CHECK(result.diagnostics.errors() == 1);
    CHECK(fixed_likely(program, result) == program);
  }
}
