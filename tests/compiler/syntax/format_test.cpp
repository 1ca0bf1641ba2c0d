// rsc fmt's style: what it makes of each kind of line, that it does not depend on how a program was spaced before, and
// that nothing but space changes.
#include <algorithm>
#include <random>

#include <catch2/catch.hpp>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/lexer.hpp"
#include "tests/compiler/syntax/styled.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/share.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

namespace fs = std::filesystem;

// The keywords of some lines in small letters; names that are keywords elsewhere stay.
std::string recased(const std::string& text, std::mt19937& random) {
  SourceMap sources;
  Diagnostics ignored;
  const FileId file = sources.add("robot.rsl", text);
  const ast::Tree tree = parse(sources, file, ignored);
  std::string made = text;
  bool small = false;
  for (const Token& token : lex(sources.file(file), file, ignored)) {
    if (token.kind == Kinds::NEWLINE) small = random() % 2 == 0;
    const bool is_name = std::ranges::any_of(
        tree.keyword_names, [&token](const Span& name) { return name.begin == token.span.begin; });
    if (!small || !is_keyword(token.kind) || is_name) continue;
    for (std::size_t at = token.span.begin; at < token.span.end; ++at)
      made[at] = ascii::lower(made[at]);
  }
  return made;
}

// The same words in the same lines, with other blanks between them, and blank lines where some were.
std::string respaced(const std::string& text, std::mt19937& random) {
  SourceMap sources;
  Diagnostics ignored;
  const FileId file = sources.add("robot.rsl", text);
  const auto blanks = [&](unsigned least) {
    return std::string(least + random() % 4, random() % 4 == 0 ? '\t' : ' ');
  };
  std::string made;
  std::size_t at = 0;
  for (const Token& token : lex(sources.file(file), file, ignored)) {
    const std::string_view gap = std::string_view(text).substr(at, token.span.begin - at);
    const std::size_t comment = gap.find_first_of("#%");
    const bool starts = made.empty() || made.back() == '\n';
    if (comment != std::string_view::npos) {
      made += blanks(2) + std::string(gap.substr(comment));
    } else if (!gap.empty() || starts) {
      made += blanks(starts ? 0 : 1);
    }
    const bool line_ends = token.kind == Kinds::NEWLINE;
    made += line_ends ? "\n" : std::string(sources.text(token.span));
    if (line_ends && made.ends_with("\n\n")) made += random() % 2 == 0 ? "\n" : "";
    at = token.span.end;
  }
  return made;
}

}  // namespace

TEST_CASE("a byte order mark in front of a comment is no part of it") {
  CHECK(styled("\xEF\xBB\xBF# hello\nLET a = 1\n") == "# hello\nLET a = 1\n");
}

TEST_CASE("a comment that may be meant as a percentage stays where rsc check says so") {
  const std::string doubtful = "WHEN touch LEVEL > 3 DO\n  SAY 40 % loud\n  SAY 4   % quiet\nEND\n";
  const std::string styled_once = styled(doubtful);
  CHECK_THAT(styled_once,
             Catch::Contains("  SAY 40 % loud\n") && Catch::Contains("  SAY 4  % quiet\n"));
  CHECK(styled(styled_once) == styled_once);
}

TEST_CASE("each kind of line has its place") {
  const fs::path folder = source_folder() / "tests/compiler/syntax/style";
  const std::string after = styled(read_file(folder / "before.rsl"));
  REQUIRE_FALSE(after.empty());
  robosync::testing::expect_golden(folder / "after.rsl", after);
}

TEST_CASE("a blank line separates the rules of a BEHAVIOR, as it does items") {
  const std::string head = "BEHAVIOR a PRIORITY 5\n";
  const std::string rule = "  WHEN b\n  DO c\n  END\n", line = "  WHEN d DO e END\n";
  const std::string number = "  REMEMBER f = 1\n", comment = "  # g\n", end = "END\n";
  CHECK(styled(head + rule + rule + end) == head + rule + "\n" + rule + end);
  CHECK(styled(head + line + line + end) == head + line + line + end);
  CHECK(styled(head + number + number + line + rule + end) ==
        head + number + number + line + "\n" + rule + end);
  CHECK(styled(head + rule + comment + line + line + end) ==
        head + rule + "\n" + comment + line + line + end);
  CHECK(styled("LET h = 1\n" + head + line + end + head + line + end) ==
        "LET h = 1\n\n" + head + line + end + "\n" + head + line + end);
}

TEST_CASE("one space around what calculates, whatever stood there") {
  const auto line = [](const std::string& text) {
    const std::string all = styled("AT START\nDO\n" + text + "\nEND\n");
    const std::size_t begin = all.find("DO\n") + 5;
    return all.substr(begin, all.find('\n', begin) - begin);
  };
  CHECK(line("TURN head TO (voice direction / 2)over 2seconds") ==
        "TURN head TO (voice direction / 2) OVER 2seconds");
  CHECK(line("SET n TO 1-(2-3)") == "SET n TO 1 - (2 - 3)");
  CHECK(line("SET n TO (a -1)*n- 2") == "SET n TO (a - 1) * n - 2");
  CHECK(line("SET n TO (n)MOD(3)") == "SET n TO (n) MOD (3)");
  CHECK(line("SET n TO -3") == "SET n TO -3");
  CHECK(line("SET n TO MAX(-3 ,-(a-b))") == "SET n TO MAX(-3, -(a - b))");
  CHECK(line("MOVE head BY -30deg") == "MOVE head BY -30deg");
  CHECK(line("nod WITH 3,-5") == "nod WITH 3, -5");
  CHECK(line("WAIT UNTIL (a > 1)AND(b > 2)OR NOT(c)") ==
        "WAIT UNTIL (a > 1) AND (b > 2) OR NOT(c)");
}

TEST_CASE("the library and the examples are in the one style") {
  REQUIRE(programs().size() > 20);
  for (const fs::path& path : programs()) {
    INFO(path);
    const std::string folder = path.parent_path().filename().string();
    if (folder == "touch_companion" || folder == "paper")
      continue;  // the listing of the paper, as it was printed
    CHECK(styled(read_file(path)) == read_file(path));
  }
}

TEST_CASE("keywords are in capitals, names as they were written") {
  CHECK(styled("when touch level<3 do move arms slowly else if a then b end") == "");
  CHECK(styled("when touch level<3 do move arms slowly else stop arms end") ==
        "WHEN touch level < 3\nDO move arms slowly\nELSE\n  STOP arms\nEND\n");
  CHECK(styled("define nod\n  if a > 1 do wave else if a < 1 do bow end\nend") ==
        "DEFINE nod\n  IF a > 1\n  DO wave\n  ELSE IF a < 1\n  DO bow\n  END\nEND\n");
  // Keywords where only a name is possible: a variable, a channel, a word of a command, a label.
  CHECK(styled("remember option = 1\nwhen touch motion > option do\n  set option to 4\n  move arms "
               "from\nend") ==
        "REMEMBER option = 1\n\nWHEN touch motion > option\nDO\n  SET option TO 4\n  move arms "
        "from\nEND\n");
  CHECK(styled("state lower: calm, stop") == "STATE lower: calm, stop\n");
}

TEST_CASE("however a program is spaced, it is formatted to the same") {
  std::mt19937 random(1);
  for (const fs::path& path : programs()) {
    const std::string text = read_file(path);
    const std::string wanted = styled(text);
    REQUIRE_FALSE(wanted.empty());
    CHECK(styled(wanted) == wanted);
    for (int i = 0; i < robosync::test::share_of(20); ++i) {
      const std::string other = respaced(recased(text, random), random);
      INFO(path << '\n' << other);
      REQUIRE(styled(other) == wanted);
    }
  }
}

TEST_CASE("programs that lack a word are formatted, if they are programs") {
  int formatted_programs = 0;
  each_without_a_word([&](const std::string& other) {
    const std::string once = styled(other);
    if (once.empty()) return;
    ++formatted_programs;
    INFO(other);
    REQUIRE(once != "changed");
    REQUIRE(styled(once) == once);
  });
  CHECK(formatted_programs > robosync::test::share_of(500));
}

TEST_CASE("odd texts are formatted, or left as they are") {
  CHECK(styled("").empty());
  CHECK(styled("\n\n\n").empty());
  CHECK(styled("# only this") == "# only this\n");
  CHECK(styled("USE quiz\r\nUSE gaze\r") == "USE quiz\nUSE gaze\n");
  CHECK(styled("USE   quiz % why\n\n\n\n") == "USE quiz  % why\n");
  CHECK(styled("WHEN touch LEVEL<3 DO LOG \"a  b\" END") ==
        "WHEN touch LEVEL < 3 DO LOG \"a  b\" END\n");
}
