// Trees of programs: every form of the grammar, and the programs of the language's design.
#include <catch2/catch.hpp>

#include "compiler/syntax/keyword_roles.hpp"
#include "tests/compiler/parsed.hpp"
#include "tests/compiler/syntax/sexpr.hpp"

using namespace robosync::compiler;
using namespace robosync::compiler::testing;

namespace {

std::string tree(const std::string& text) {
  const Parsed parsed = parse_text(text);
  INFO(text);
  CHECK(messages(parsed) == "");
  return to_sexpr(parsed.program);
}

std::string condition(const std::string& text) {
  const std::string whole = tree("WHEN " + text + "\nDO x\nEND\n");
  return whole.substr(6, whole.size() - std::string("(when  (do (x)))\n").size());
}

std::string statement(const std::string& text) {
  const std::string whole = tree("DEFINE d\n" + text + "\nEND\n");
  const std::string head = "(define d () (do ";
  return whole.substr(head.size(), whole.size() - head.size() - 3);
}

}  // namespace

TEST_CASE("the programs of the design are read without a message", "[tree]") {
  const auto programs = files_in("programs", ".rsl");
  CHECK(programs.size() == 7);
  for (auto path : programs) {
    const Parsed parsed = parse_text(robosync::testing::read_file(path));
    CHECK(messages(parsed) == "");
    robosync::testing::expect_golden(path.replace_extension(".tree"), to_sexpr(parsed.program));
  }
}

TEST_CASE("the paper's program", "[tree]") {
  const auto path = syntax_folder() / "programs/paper.rsl";
  CHECK(tree(robosync::testing::read_file(path)) ==
        "(when (< touch.LEVEL 3) (do (gentle_response)) (else (aggressive_response)))\n"
        "(define gentle_response () (do (MOVE arms SLOWLY) (PLAY sound \"greeting.wav\")))\n"
        "(define aggressive_response () (do (MOVE arms QUICKLY) (PLAY sound \"warning.wav\")))\n");
}

TEST_CASE("how tightly operators bind", "[tree]") {
  CHECK(condition("a + 2 * b - 1 > c / 2 MOD 3") == "(> (- (+ a (* 2 b)) 1) (mod (/ c 2) 3))");
  CHECK(condition("a OR b AND NOT c < 1") == "(or a (and b (not (< c 1))))");
  CHECK(condition("(a OR b) AND c") == "(and (or a b) c)");
  CHECK(condition("-a * -3mm <> --b") == "(<> (* (neg a) (neg 3mm)) (neg (neg b)))");
  CHECK(condition("a IS BETWEEN 1 AND 2 AND b") == "(and (between a 1 2) b)");
  CHECK(condition("a IS NOT BETWEEN 1 AND 2 OR b") == "(or (not (between a 1 2)) b)");
  CHECK(condition("RANDOM(1, 6) >= 5") == "(>= (random 1 6) 5)");
  CHECK(condition("ABS(a - 1) > Min(min, 2cm) * abs") ==
        "(> (function ABS (- a 1)) (* (function Min min 2cm) abs))");
  CHECK(condition("a == 1 OR b != 2 OR c = 3") == "(or (or (= a 1) (<> b 2)) (= c 3))");
}

TEST_CASE("rows of a MOTION: a minus that touches what follows is its sign", "[tree]") {
  CHECK(tree("MOTION m OF a, b, c\nAT 0s -10deg - -up\nAT 1s - (2 * x) -\nAT 2s 3 - -\nEND\n") ==
        "(motion m (a b c) (0s (neg 10deg) - (neg up)) (1s - (* 2 x) -) (2s 3 - -))\n");
}

TEST_CASE("labels and texts", "[tree]") {
  CHECK(condition("space IS very close") == "(is space [very close])");
  CHECK(condition("space IS  very \t close  now") == "(is space [very close now])");
  CHECK(condition("space IS NOT very close") == "(is-not space [very close])");
  CHECK(condition("voice WORD IS \"stop\"") == "(is voice.WORD \"stop\")");
  CHECK(condition("button IS TRUE OR button IS FALSE") == "(or (true button) (false button))");
  CHECK(condition("mood BECOMES calm") == "(becomes mood calm)");
  CHECK(condition("jerk LEVEL CHANGES BY 2 OR x CHANGES") ==
        "(or (changes jerk.LEVEL 2) (changes x))");
}

TEST_CASE("time words", "[tree]") {
  CHECK(condition("a > 1 FOR 2s") == "(for (> a 1) 2s)");
  CHECK(condition("a > 1 THEN a < 1 WITHIN 2s") == "(then (> a 1) (< a 1) 2s)");
  CHECK(condition("a > 0 3 TIMES WITHIN 2s") == "(times (> a 0) 3 2s)");
}

TEST_CASE("statements", "[tree]") {
  CHECK(statement("MOVE arms TO -20deg OVER 400ms AT calm BY (a + 1) FOR 'x'") ==
        "(MOVE arms to:(neg 20deg) over:400ms at:calm by:(+ a 1) for:\"x\")");
  CHECK(statement("SPIN base 1 TIMES") == "(SPIN base (times 1))");
  CHECK(statement("step WITH 25deg, touch LEVEL, 'x'") == "(call step 25deg touch.LEVEL \"x\")");
  CHECK(statement("SET a TO a + 1\nRAISE b BY 3%\nLOWER b BY 3%") ==
        "(set a (+ a 1)) (raise b 3%) (lower b 3%)");
  CHECK(statement("WAIT 2s\nTHEN\nWAIT UNTIL a\nWAIT UNTIL a WITHIN 2s\nWAIT UNTIL a FOR 1s") ==
        "(wait 2s) (then) (wait-until a) (wait-until a (within 2s)) (wait-until (for a 1s))");
  CHECK(statement("IF a DO b ELSE c END") == "(if a (do (b)) (else (c)))");
  CHECK(statement("IF a DO b ELSE IF c DO d ELSE IF e DO f ELSE g END\nh") ==
        "(if a (do (b)) (else (if c (do (d)) (else (if e (do (f)) (else (g))))))) (h)");
  CHECK(statement("IF a DO b\nELSE\nIF c DO d END\ne\nEND") ==
        "(if a (do (b)) (else (if c (do (d))) (e)))");
  CHECK(statement("IF\na\nDO b END") == "(if a (do (b)))");
  CHECK(statement("REPEAT 3 TIMES\na\nEND\nREPEAT WHILE b\na\nEND\nREPEAT FOREVER\na\nEND") ==
        "(repeat (times 3) (do (a))) (repeat (while b) (do (a))) (repeat forever (do (a)))");
  CHECK(statement("PICK ONE\nOPTION 60%\na\nOPTION b\nEND") ==
        "(pick-one (option 60% (do (a))) (option (do (b))))");
  CHECK(statement("STOP ALL\nSTOP arms\nSIGNAL go\nLOG 'a', b + 1\nALERT 'careful'") ==
        "(stop all) (stop arms) (signal go) (log \"a\" (+ b 1)) (alert \"careful\")");
}

TEST_CASE("rules", "[tree]") {
  CHECK(tree("WHEN a PRIORITY 3 COOLDOWN 2s MARGIN 1 RESTARTING WAITING 2s DO b DO c END") ==
        "(when a (priority 3) (cooldown 2s) (margin 1) (waiting 2s) (restarting) (do (b) (c)))\n");
  CHECK(tree("WHILE a DO b END\nEVERY 3s TO 7s DO b END\nEVERY 1s DO b END\nAT START DO b END") ==
        "(while a (do (b)))\n(every 3s (to 7s) (do (b)))\n(every 1s (do (b)))\n"
        "(at-start (do (b)))\n");
  CHECK(tree("BEHAVIOUR x\nREMEMBER n = 0\nAT START DO b END\nEND") ==
        "(behavior x - (remember n 0) (at-start (do (b))))\n");
}

TEST_CASE("lines wrap where they cannot end", "[tree]") {
  CHECK(condition("a >\n1 AND\nb\nOR c") == "(or (and (> a 1) b) c)");
  CHECK(tree("\n\n  % comment\nWHEN a # another\n\n\nDO\n\nb\n\n\nEND") == "(when a (do (b)))\n");
  CHECK(tree("when a do b else c end") == "(when a (do (b)) (else (c)))\n");
  CHECK(tree("WHEN a\r\nDO b\r\nEND\r\n") == tree("WHEN a\rDO b\rEND\r"));
}

TEST_CASE("spans reach from the first to the last token", "[tree]") {
  const std::string text = "  WHEN touch LEVEL < 3 DO MOVE arms TO 10deg END  ";
  const Parsed parsed = parse_text(text);
  const auto& rule = std::get<ast::Rule>(parsed.program.items.at(0).node);
  const auto& when = std::get<ast::WhenRule>(rule.node);
  const auto text_of = [&parsed](Span span) { return parsed.sources.text(span); };
  CHECK(text_of(rule.span) == "WHEN touch LEVEL < 3 DO MOVE arms TO 10deg END");
  CHECK(text_of(rule.head_span) == "WHEN");
  CHECK(text_of(when.condition->span) == "touch LEVEL < 3");
  const auto& comparison = std::get<ast::Comparison>(when.condition->node);
  CHECK(text_of(comparison.relation_span) == "<");
  const auto& command = std::get<ast::Command>(when.then_block.at(0).node);
  CHECK(text_of(command.arguments.at(1).span) == "TO 10deg");
  const auto& amount = std::get<ast::Amount>(command.arguments.at(1).value);
  CHECK(text_of(std::get<ast::Quantity>(amount.value->node).unit_span) == "deg");
}

TEST_CASE("a wrong item does not take the others with it", "[tree]") {
  const Parsed parsed = parse_text(
      "DEFINE a\nx\nEND\nWHEN b > DO a END\nDEFINE c\ny\nEND\nMOVE arms\nDEFINE d\nz\nEND\n");
  CHECK(parsed.diagnostics.errors() == 2);
  const std::string all = to_sexpr(parsed.program);
  CHECK(all.find("(define a () (do (x)))") != std::string::npos);
  CHECK(all.find("(when (> b") != std::string::npos);
  CHECK(all.find("(define c () (do (y)))") != std::string::npos);
  CHECK(all.find("(define d () (do (z)))") != std::string::npos);
}

// ---- words that are reserved, and words that may be names

namespace {

bool is_read(const std::string& text) {
  return parse_text(text).diagnostics.errors() == 0;
}

// The words in the cell of the table of docs/language.md whose line begins with `head`.
std::vector<std::string> documented(const std::string& head) {
  const auto path = std::filesystem::path(ROBOSYNC_SOURCE_DIR) / "docs/language.md";
  const std::string text = robosync::testing::read_file(path);
  const std::size_t begin = text.find("\n| " + head + " |");
  REQUIRE(begin != std::string::npos);
  const std::string line = text.substr(begin + 1, text.find('\n', begin + 1) - begin - 1);
  std::vector<std::string> words;
  for (std::size_t at = line.find('`'); at != std::string::npos; at = line.find('`', at + 1)) {
    const std::size_t end = line.find('`', at + 1);
    words.push_back(line.substr(at + 1, end - at - 1));
    at = end;
  }
  return words;
}

std::vector<std::string> with(unsigned role, bool wanted) {
  std::vector<std::string> words;
  for (const Keyword& keyword : keywords())
    if (((keyword.roles & role) != 0) == wanted &&
        keyword.spelling.find(' ') == std::string_view::npos)
      words.emplace_back(keyword.spelling);
  std::sort(words.begin(), words.end());
  return words;
}

}  // namespace

TEST_CASE("a word is a name where its row in keywords.def says so, and nowhere else", "[tree]") {
  for (const Keyword& keyword : keywords()) {
    const std::string word(keyword.spelling);
    if (word.find(' ') != std::string::npos) continue;
    CAPTURE(word);
    const bool name = (keyword.roles & role::name) != 0;
    const bool later = (keyword.roles & role::word) != 0;
    CHECK(is_read("REMEMBER " + word + " = 1\n") == name);
    CHECK(is_read("WHEN touch > 1\nDO SET x TO " + word + " + 1\nEND\n") == name);
    CHECK(is_read("STATE s: a, " + word + ", b\n") == name);
    CHECK(is_read("WHEN touch " + word + " > 1\nDO x\nEND\n") == later);
    const auto among = [&](std::initializer_list<std::string_view> words) {
      return std::find(words.begin(), words.end(), word) != words.end();
    };
    const bool given = later || among({"ABOVE", "BELOW", "ONE", "OTHERWISE", "START"});
    CHECK(is_read("WHEN touch > 1\nDO MOVE it " + word + "\nEND\n") == given);
    const bool behind = name && !among({"BY", "OPTION", "OVER", "RANDOM"});
    CHECK(is_read("WHEN touch > 1\nDO MOVE it TO " + word + " OVER 2s\nEND\n") == behind);
    CHECK(is_read("WHEN touch > 1\nDO MOVE it TO (" + word + ") OVER 2s\nEND\n") == name);
  }
}

TEST_CASE("docs/language.md lists the reserved words, and those that may be names", "[tree]") {
  CHECK(documented("reserved") == with(role::name, false));
  CHECK(documented("may be a name") == with(role::name, true));
  CHECK(documented("and behind another word") == with(role::word, true));
}

TEST_CASE("a REMEMBER that is KEPT", "[tree]") {
  CHECK(tree("REMEMBER n = a + 1 KEPT\nREMEMBER kept = kept\n") ==
        "(remember n (+ a 1) kept)\n(remember kept kept)\n");
  CHECK(tree("BEHAVIOR x\nREMEMBER n = 0 kept\nAT START DO b END\nEND") ==
        "(behavior x - (remember n 0 kept) (at-start (do (b))))\n");
}

TEST_CASE("LISTs, and what is taken out of them", "[tree]") {
  CHECK(tree("LIST jokes: \"a\", 'b'\n") == "(list jokes \"a\" \"b\")\n");
  CHECK(statement("SAY NEXT jokes FOR 2s\nSAY ITEM a + 1 OF jokes\nALERT ANY jokes") ==
        "(SAY NEXT jokes for:2s) (SAY (item (+ a 1) jokes)) (alert ANY.jokes)");
  CHECK(statement("LOG COUNT OF jokes, ITEM COUNT OF jokes OF jokes, item, count") ==
        "(log (count jokes) (item (count jokes) jokes) item count)");
  CHECK(statement("ALERT ITEM count OF jokes\nALERT ITEM count + COUNT OF jokes OF jokes") ==
        "(alert (item count jokes)) (alert (item (+ count (count jokes)) jokes))");
  CHECK(tree("TIMER idle\nTIMER timer\n") == "(timer idle)\n(timer timer)\n");
  CHECK(statement("RESTART timer") == "(RESTART timer)");
  CHECK(statement("SET list TO item + count\nlist") == "(set list (+ item count)) (list)");
  CHECK(tree("CHECK item OF a b\nx BELOW 1\nEND\nCHECK count OF c\nx BELOW 1\nEND\n").size() > 10);
}

TEST_CASE("words of RSL as names", "[tree]") {
  CHECK(tree("STATE game: start, waiting, playing, over\n") ==
        "(state game (start waiting playing over))\n");
  CHECK(condition("game IS over OR stop > all") == "(or (is game over) (> stop all))");
  CHECK(condition("game BECOMES over all") == "(becomes game [over all])");
  CHECK(statement("SET game TO waiting\nRAISE by BY over") == "(set game waiting) (raise by over)");
  CHECK(statement("STOP ALL\nMOVE arms OVER 2s") == "(stop all) (MOVE arms over:2s)");
}
