// Diagnostics for people and for programs.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "compiler/diagnostics/snippet.hpp"
#include "tests/compiler/parsed.hpp"

using namespace robosync::compiler;

TEST_CASE("snippets", "[render]") {
  const auto check = [](std::string_view line, std::size_t begin, std::size_t end,
                        const std::string& source, const std::string& marker) {
    const Snippet snippet = make_snippet(line, begin, end, '^');
    CHECK(snippet.source == source);
    CHECK(snippet.marker == marker);
  };
  check("abc", 1, 2, "abc", " ^");
  check("abc", 3, 3, "abc", "   ^");
  check("abc", 1, 1, "abc", " ^");
  check("a\tb", 2, 3, "a   b", "    ^");
  check("\ta", 1, 2, "    a", "    ^");
  check("é触x", 2, 5, "é触x", " ^^");
  check("é触x", 5, 6, "é触x", "   ^");
  check("a\x1b\xff x", 4, 5, "a�� x", "    ^");
  check("", 0, 0, "", "^");
}

TEST_CASE("long lines are cut around the mark", "[render]") {
  std::string line(500, '.');
  line[250] = 'X';
  const Snippet snippet = make_snippet(line, 250, 251, '^');
  CHECK(snippet.source.size() == 106);
  CHECK(snippet.source.substr(0, 3) == "...");
  CHECK(snippet.source.at(snippet.marker.find('^')) == 'X');
  const Snippet whole = make_snippet(line, 0, 500, '^');
  CHECK(whole.marker == std::string(100, '^'));
}

TEST_CASE("labels in two files", "[render]") {
  SourceMap sources;
  const FileId rsl = sources.add("robot.rsl", "\n\n\n  WHEN proximity DISTANCE < 20N\n");
  const FileId json = sources.add("robot.json", "{\n  \"unit\": \"mm\"\n}\n");
  Diagnostics diagnostics;
  diagnostics.report(Code::E0301, "this compares a distance with a weight")
      .label({json, 12, 16}, "the sensor gives millimetres", false)
      .label({rsl, 31, 34}, "newton (force)")
      .helps("did you mean `20mm`, `20cm`?")
      .fix({rsl, 31, 34}, "20mm")
      .fix({rsl, 31, 34}, "20cm", Applicability::likely)
      .fix({rsl, 31, 34}, "…", Applicability::placeholder);
  CHECK(render_human(diagnostics, sources, false) ==
        "error[E0301]: this compares a distance with a weight\n"
        "  --> robot.rsl:4:29\n"
        " 4 |   WHEN proximity DISTANCE < 20N\n"
        "   |                             ^^^ newton (force)\n"
        "  --> robot.json:2:11\n"
        " 2 |   \"unit\": \"mm\"\n"
        "   |           ---- the sensor gives millimetres\n"
        "   = help: did you mean `20mm`, `20cm`?\n");
  CHECK(render_human(diagnostics, sources, true).find("\x1b[1;31merror") != std::string::npos);

  const auto parsed = nlohmann::json::parse(render_json(diagnostics, sources));
  CHECK(parsed["errors"] == 1);
  CHECK(parsed["warnings"] == 0);
  const auto& entry = parsed["diagnostics"].at(0);
  CHECK(entry["code"] == "E0301");
  CHECK(entry["level"] == "error");
  CHECK(entry["labels"].at(1) == nlohmann::json({{"file", "robot.rsl"},
                                                 {"line", 4},
                                                 {"column", 29},
                                                 {"end_line", 4},
                                                 {"end_column", 32},
                                                 {"text", "newton (force)"},
                                                 {"primary", true}}));
  CHECK(entry["help"].at(0) == "did you mean `20mm`, `20cm`?");
  CHECK(entry["fixes"].at(0)["replacement"] == "20mm");
  CHECK(entry["fixes"].at(0)["applicability"] == "certain");
  CHECK(entry["fixes"].at(1)["replacement"] == "20cm");
  CHECK(entry["fixes"].at(1)["applicability"] == "likely");
  CHECK(entry["fixes"].at(2)["applicability"] == "placeholder");
}

TEST_CASE("JSON of sources that are not UTF-8", "[render]") {
  const auto parsed = robosync::compiler::testing::parse_text("WHEN \"\xff\" \xfe DO\n");
  const std::string text = render_json(parsed.diagnostics, parsed.sources);
  CHECK(nlohmann::json::parse(text)["errors"] == parsed.diagnostics.errors());
}

TEST_CASE("diagnostics are sorted, and said once", "[diagnostics]") {
  Diagnostics diagnostics;
  diagnostics.report(Code::E0002, "b").label({0, 9, 10});
  diagnostics.report(Code::W0103, "a").label({0, 2, 3});
  diagnostics.report(Code::E0002, "b").label({0, 9, 10});
  diagnostics.report(Code::E0002, "c").label({0, 9, 10});
  diagnostics.finish();
  REQUIRE(diagnostics.all().size() == 3);
  CHECK(diagnostics.all()[0].message == "a");
  CHECK(diagnostics.errors() == 2);
  CHECK(diagnostics.warnings() == 1);
}

TEST_CASE("so many names are searched, and no more", "[diagnostics]") {
  Diagnostics diagnostics;
  std::size_t searches = 0;
  while (diagnostics.may_search(1000))
    ++searches;
  CHECK(searches == 200);
  CHECK_FALSE(diagnostics.may_search(1));
  Diagnostics fresh;
  CHECK(fresh.may_search(10'000'000));  // the first is done, whatever it takes
  CHECK_FALSE(fresh.may_search(1));
}
