// Nothing in a source may crash the front end or keep it busy: random bytes, random words, huge and
// deep programs. The sanitizers of the host-asan preset watch.
#include <chrono>
#include <random>

#include <catch2/catch.hpp>

#include "compiler/syntax/keywords.hpp"
#include "tests/compiler/parsed.hpp"
#include "tests/support/repeated.hpp"
#include "tests/support/share.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;
using robosync::testing::repeated;

namespace {

// Parses and renders both ways; gives the number of errors.
std::size_t survive(std::string text) {
  const Parsed parsed = parse_text(std::move(text));
  const std::string human = messages(parsed);
  const std::string json = render_json(parsed.diagnostics, parsed.sources);
  CHECK(human.empty() == parsed.diagnostics.all().empty());
  CHECK(json.back() == '\n');
  return parsed.diagnostics.errors();
}

std::string random_bytes(std::mt19937& random) {
  std::string text(random() % 24, '\0');
  for (char& c : text)
    c = static_cast<char>(random() % 256);
  return text;
}

std::string random_words(std::mt19937& random) {
  static const std::vector<std::string> others = {"touch", "LEVEL", "3", "40%", "20cm", "\"x\"",
                                                  "\n",    "\n",    "<", "(",   ")",    "=",
                                                  ",",     "-",     ":", "%"};
  std::string text;
  const std::size_t count = random() % 12;
  for (std::size_t i = 0; i < count; ++i) {
    const bool keyword = random() % 2 == 0;
    const auto& words = keyword ? keyword_spellings() : others;
    text += words[random() % words.size()] + " ";
  }
  return text;
}

}  // namespace

TEST_CASE("random bytes", "[fuzz]") {
  std::mt19937 random(1);
  const int rounds = robosync::test::share_of(60000);
  for (int i = 0; i < rounds; ++i)
    survive(random_bytes(random));
}

TEST_CASE("random words", "[fuzz]") {
  std::mt19937 random(2);
  const int rounds = robosync::test::share_of(40000);
  int wrong = 0;
  for (int i = 0; i < rounds; ++i) {
    if (survive(random_words(random)) > 0) ++wrong;
  }
  CHECK(wrong > rounds / 4 * 3);
}

// Eleven words hold no thirty mistakes: who mends one must get on.
TEST_CASE("a few words give few messages", "[fuzz]") {
  std::mt19937 random(3);
  const int rounds = robosync::test::share_of(40000);
  int in_vain = 0;
  for (int i = 0; i < rounds; ++i) {
    const std::string text = random_words(random);
    const Parsed parsed = parse_text(text);
    const bool gave_up = std::ranges::any_of(
        parsed.diagnostics.all(), [](const Diagnostic& one) { return one.code == Code::E0013; });
    if (!gave_up && parsed.diagnostics.errors() <= 14) continue;
    ++in_vain;
    WARN(text << '\n' << messages(parsed));
  }
  CHECK(in_vain == 0);
}

TEST_CASE("huge and deep programs end soon", "[robust]") {
  const auto bytes = static_cast<std::size_t>(robosync::test::share_of(1000000));
  const std::string parts[] = {"x ",
                               "x y\n",
                               "WHEN\n",
                               "END\n",
                               "NOT ",
                               "(",
                               "(\n",
                               "+1",
                               "@ ",
                               "\"\n",
                               "IF a DO\n",
                               "1",
                               "\xff",
                               "a;",
                               "- ",
                               "BEHAVIOR x PRIORITY 1\n",
                               "LET a = 1 +\n",
                               "“"};
  for (const std::string& part : parts) {
    for (const std::string head : {"", "LET x = ", "DEFINE x\n", "WHEN x > "}) {
      INFO("'" << head << "', then '" << part << "' over and over");
      const auto start = std::chrono::steady_clock::now();
      survive(head + repeated(part, bytes / part.size()));
      const auto took = std::chrono::steady_clock::now() - start;
      CHECK(took < std::chrono::seconds(60));
    }
  }
}

TEST_CASE("limits have messages of their own", "[robust]") {
  const auto first_code = [](const std::string& text) {
    const Parsed parsed = parse_text(text);
    REQUIRE(!parsed.diagnostics.all().empty());
    return std::string(code_name(parsed.diagnostics.all().front().code));
  };
  CHECK(first_code(std::string(17 << 20, ' ')) == "E0013");
  CHECK(first_code("LET x = " + repeated("(", 65) + "1" + repeated(")", 65)) == "E0012");
  CHECK(first_code("LET x = " + repeated("- ", 65) + "1") == "E0012");
  CHECK(first_code("LET x = 1" + repeated("+1", 100)) == "E0012");
  CHECK(parse_text("LET x = " + repeated("(", 64) + "1" + repeated(")", 64))
            .diagnostics.all()
            .empty());
  CHECK(parse_text("LET x = 1" + repeated("+1", 99)).diagnostics.all().empty());
  const std::string deep = repeated("IF a DO\n", 33) + "b\n" + repeated("END\n", 33);
  CHECK(first_code("DEFINE d\n" + deep + "END\n") == "E0012");
}

TEST_CASE("thirty mistakes are enough", "[robust]") {
  const Parsed parsed = parse_text(repeated("LET x =\n", 1000));
  CHECK(parsed.diagnostics.errors() == 31);
  CHECK(parsed.diagnostics.all().back().code == Code::E0013);
}

TEST_CASE("a program that is being written gives few messages", "[robust]") {
  constexpr std::size_t few = 6;  // blocks that are open have one each
  std::size_t number = 0;
  for (const auto& path : files_in("programs", ".rsl")) {
    const std::string program = robosync::testing::read_file(path);
    for (std::size_t end = program.find(' '); end < program.size();
         end = program.find_first_of(" \n", end + 1)) {
      if (!robosync::test::in_share(number++)) continue;
      const Parsed parsed = parse_text(program.substr(0, end));
      if (parsed.diagnostics.errors() <= few) continue;
      INFO(program.substr(0, end) << '\n' << messages(parsed));
      CHECK(parsed.diagnostics.errors() <= few);
    }
  }
}
