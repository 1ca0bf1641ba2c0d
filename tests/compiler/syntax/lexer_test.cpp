// Tokens: kinds and texts, and which ends of lines count.
#include "compiler/syntax/lexer.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

#include "compiler/syntax/keywords.hpp"
#include "compiler/syntax/layout.hpp"
#include "tests/compiler/parsed.hpp"

using namespace robosync::compiler;

namespace {

// "KIND:text KIND:text"; names, numbers and texts are N, Q and S, keywords stand for themselves.
std::string show(const SourceFile& source, const Token& token) {
  const std::string text(source.text(token.span));
  if (token.kind == Kinds::NEWLINE) return "NL";
  if (token.kind == Kinds::NAME) return "N:" + text;
  if (token.kind == Kinds::QUANTITY) return "Q:" + text;
  if (token.kind == Kinds::STRING) return "S:" + text;
  std::string kind = describe(token.kind);
  kind.erase(std::remove(kind.begin(), kind.end(), '`'), kind.end());
  return kind;
}

struct Lexed {
  std::string tokens;
  std::vector<std::string> codes;
};

Lexed lexed(const std::string& text) {
  const SourceFile source("robot.rsl", text);
  Diagnostics diagnostics;
  Lexed result;
  for (const Token& token : lex(source, 0, diagnostics)) {
    result.tokens += (result.tokens.empty() ? "" : " ") + show(source, token);
  }
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    result.codes.emplace_back(code_name(diagnostic.code));
  }
  return result;
}

std::string tokens(const std::string& text) {
  const Lexed result = lexed(text);
  CHECK(result.codes.empty());
  return result.tokens;
}

std::string filtered(const std::string& text) {
  const SourceFile source("robot.rsl", text);
  Diagnostics diagnostics;
  std::vector<Token> all = lex(source, 0, diagnostics);
  std::vector<std::uint32_t> order;
  significant(all, order);
  std::string result;
  for (const std::uint32_t place : order) {
    result += (result.empty() ? "" : " ") + show(source, all[place]);
  }
  return result;
}

}  // namespace

TEST_CASE("keywords in any case, names as they are", "[lexer]") {
  CHECK(tokens("WHEN when WhEn whence BEHAVIOUR behavior") ==
        "WHEN WHEN WHEN N:whence BEHAVIOR BEHAVIOR");
  CHECK(tokens("touch_level _x x2 été 触摸") == "N:touch_level N:_x N:x2 N:été N:触摸");
  CHECK(tokens("ELSE IF a else  if b ELSE\nIF c IF d") ==
        "ELSE IF N:a ELSE IF N:b ELSE NL IF N:c IF N:d");
  CHECK(is_keyword("otherwise"));
  CHECK(is_keyword("Behaviour"));
  CHECK_FALSE(is_keyword("MOVE"));
  CHECK_FALSE(is_keyword(""));
  CHECK(may_name_a_part("motion"));
  CHECK_FALSE(may_name_a_part("test"));
  CHECK(may_name_a_part("touch"));
  CHECK_FALSE(is_keyword(std::string(1000, 'A')));
}

TEST_CASE("numbers carry their units", "[lexer]") {
  CHECK(tokens("3 0.5 80cm 40% 20deg/s 10cm/x 10cm/2 1.5mA 20°C 5µs 9deg/s2") ==
        "Q:3 Q:0.5 Q:80cm Q:40% Q:20deg/s Q:10cm / N:x Q:10cm / Q:2 Q:1.5mA Q:20°C Q:5µs Q:9deg / "
        "N:s2");
  CHECK(tokens("20° 2h 3degrees 20°/s 4deg/SEC 5cm/second 6cm/seconds") ==
        "Q:20° Q:2h Q:3degrees Q:20°/s Q:4deg/SEC Q:5cm/second Q:6cm / N:seconds");
  CHECK(tokens(std::string(5000, '9')) == "Q:" + std::string(5000, '9'));
  CHECK(tokens("10-3") == "Q:10 - Q:3");
}

TEST_CASE("wrong numbers are reported and still are numbers", "[lexer]") {
  for (const std::string text : {"1.2.3", "3.", ".5", "12_000", "20m2", "40%x"}) {
    const Lexed result = lexed(text);
    CHECK(result.tokens == "Q:" + text);
    CHECK(result.codes == std::vector<std::string>{"E0004"});
  }
  CHECK(lexed("3TIMES").tokens == "Q:3 TIMES");
  CHECK(lexed("3TIMES").codes == std::vector<std::string>{"E0004"});
}

TEST_CASE("texts in both quotes", "[lexer]") {
  CHECK(tokens("\"it's\" '\"x\"' '' \"%#\"") == "S:\"it's\" S:'\"x\"' S:'' S:\"%#\"");
  CHECK(lexed("\"open\nx").tokens == "S:\"open NL N:x");
  CHECK(lexed("\"open\nx").codes == std::vector<std::string>{"E0003"});
  CHECK(lexed("“curly” x").tokens == "S:“curly” N:x");
  CHECK(lexed("“curly” x").codes == std::vector<std::string>{"E0002"});
}

TEST_CASE("comments, and the percent sign", "[lexer]") {
  CHECK(tokens("a % b\nc # d % e\n") == "N:a NL N:c NL");
  CHECK(tokens("40%% half") == "Q:40%");
  CHECK(tokens("40% % half") == "Q:40%");
  CHECK(tokens("40   % two blanks or more: a comment") == "Q:40");
  CHECK(lexed("40 % loud").tokens == "Q:40");
  CHECK(lexed("40 % loud").codes == std::vector<std::string>{"W0103"});
  CHECK(lexed("40cm % wide").codes.empty());
}

TEST_CASE("signs", "[lexer]") {
  CHECK(tokens("< > <= >= = == <> != + - * / ( ) , :") == "< > <= >= = = <> <> + - * / ( ) , :");
  CHECK(lexed("=> =< && || ! := ≤ ≥ ≠ × −").tokens == ">= <= AND OR NOT = <= >= <> * -");
  CHECK(lexed("=> =< && || ! := ≤ ≥ ≠ × −").codes.size() == 11);
}

TEST_CASE("characters that RSL does not use are left out", "[lexer]") {
  CHECK(lexed("a; {b} @ c").tokens == "N:a N:b N:c");
  CHECK(lexed("a \xff\xfe\xfd b").tokens == "N:a N:b");
  CHECK(lexed("a \xff\xfe\xfd b").codes == std::vector<std::string>{"E0002"});
  CHECK(lexed(std::string("a\0b", 3)).tokens == "N:a N:b");
  CHECK(lexed(std::string("a\0b", 3)).codes == std::vector<std::string>{"E0002"});
  CHECK(tokens("\xEF\xBB\xBFWHEN\xC2\xA0x") == "WHEN N:x");
  CHECK(lexed(std::string(10000, '@')).codes.size() == 1);
  std::string many;
  for (int i = 0; i < 1000; ++i)
    many += "@ ";
  CHECK(lexed(many).codes.size() == 1);  // in one line
  std::replace(many.begin(), many.end(), ' ', '\n');
  CHECK(lexed(many).codes.size() == 50);
}

TEST_CASE("ends of lines count where a statement may end", "[lexer]") {
  CHECK(filtered("a\n\n\nb") == "N:a NL N:b NL");
  CHECK(filtered("a +\nb") == "N:a + N:b NL");
  CHECK(filtered("WHEN\na\nDO b END") == "WHEN N:a DO N:b END NL");
  CHECK(filtered("IF\n\na DO b\nELSE IF\nc DO d END") == "IF N:a DO N:b ELSE IF N:c DO N:d END NL");
  CHECK(filtered("a\nAND b\nDO\nc\nEND\nd") == "N:a AND N:b DO N:c END NL N:d NL");
  CHECK(filtered("\n\na\n") == "N:a NL");
  CHECK(filtered("") == "");
  CHECK(filtered("\n\n") == "");
}
