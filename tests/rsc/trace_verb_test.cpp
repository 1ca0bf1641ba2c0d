// rsc trace convert: what stands in each format for a run, read again by someone who knows the format only.
#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "rsc/trace/csv.hpp"
#include "tests/rsc/process.hpp"
#include "tests/support/generated.hpp"

using namespace robosync;
using Catch::Contains;
using nlohmann::json;
using test::Folder;
using test::Outcome;

namespace {

constexpr const char* kProgram = R"(STATE mood: calm, cross
SAFETY guard
  WHEN touch LEVEL > 8
  DO STOP arm
  RESUME WHEN touch LEVEL < 1
END
BEHAVIOR strong PRIORITY 80
  WHEN touch LEVEL > 2 DO
    MOVE arm SLOWLY TO 90deg
    LOG "strong, really"
  END
END
BEHAVIOR weak PRIORITY 20
  WHEN near DISTANCE < 50cm DO
    MOVE arm TO 10deg
    SET mood TO cross
  END
END
)";

constexpr const char* kTracedRobot = R"({
  "sensors": [
    {"name": "touch", "type": "VIRTUAL", "channels": {"LEVEL": {"range": [0, 10]}}},
    {"name": "near", "type": "VIRTUAL", "channels": {"DISTANCE": {"unit": "cm", "range": [2, 400]}}}],
  "actuators": [{"name": "arm", "type": "PWM", "pin": 10, "device": "servo",
                 "range": ["0deg", "120deg"], "speeds": {"SLOWLY": "90deg/s"}}]})";

constexpr const char* kVisit = R"({"duration": "10s", "stimuli": [
  {"at": "0s", "sensor": "near", "value": "100cm"}, {"at": "0s", "sensor": "touch", "value": 0},
  {"at": "1s", "sensor": "touch", "value": 3}, {"at": "1.5s", "sensor": "near", "value": "40cm"},
  {"at": "4s", "sensor": "touch", "value": 9}, {"at": "6s", "sensor": "touch", "value": 0},
  {"at": "7s", "sensor": "near", "value": "100cm"}, {"at": "8s", "sensor": "near", "value": "30cm"}]})";

// A run of it, and its trace twice: as a monitor would have seen one program after the other.
class Trace : public Folder {
public:
  Trace() {
    const std::string program = write("robot.rsl", kProgram);
    write("robot.json", kTracedRobot);
    const Outcome outcome = test::rsc(
        {"run", program, "--scenario", write("visit.json", kVisit), "--trace", path("once.jsonl")});
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit == 0);
    file = write("run.jsonl", R"({"event":"board","name":"mps2-an386"})"
                              "\n" +
                                  read("once.jsonl") + read("once.jsonl"));
    std::istringstream text(read("run.jsonl"));
    for (std::string line; std::getline(text, line);)
      lines.push_back(json::parse(line));
  }
  [[nodiscard]] std::string converted(const std::string& format) const {
    const Outcome outcome = test::rsc({"trace", "convert", file, "--to", format});
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit == 0);
    CHECK(outcome.err.empty());
    return outcome.out;
  }
  [[nodiscard]] std::size_t count(const std::string& kind) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(lines, [&](const json& line) { return line.at("event") == kind; }));
  }

  std::string file;
  std::vector<json> lines;
};

// What a reader of IEEE 1364 must find, and GTKWave's words.
class Vcd {
public:
  explicit Vcd(const std::string& text) : text_(text) {
    for (std::string line; std::getline(text_, line);)
      has_declared_ ? change(line) : declare(line);
  }

  std::map<std::string, std::string> type_of, name_of;                                // by code
  std::map<std::string, std::vector<std::pair<std::uint64_t, std::string>>> changes;  // by name
  std::uint64_t now = 0;

private:
  void declare(const std::string& line) {
    std::istringstream words(line);
    std::string what, type, size, code, name, end;
    words >> what >> type >> size >> code >> name >> end;
    has_declared_ = what == "$enddefinitions";
    if (what == "$scope") scope_ = size;
    if (what != "$var") return;
    CHECK(end == "$end");
    CHECK(std::set<std::string>{"string", "real", "event"}.contains(type));
    CHECK(type_of.emplace(code, type).second);
    name_of[code] = scope_ + "." + name;
  }

  void change(const std::string& line) {
    if (line == "$dumpvars" || line == "$end") return;
    if (line.front() == '#') {
      const std::uint64_t next = std::stoull(line.substr(1));
      CHECK(next >= now);
      now = next;
      return;
    }
    const std::size_t space = line.find(' ');
    const bool is_event = space == std::string::npos;
    const std::string code = line.substr(is_event ? 1 : space + 1);
    CAPTURE(line);
    REQUIRE(type_of.contains(code));
    const std::string value = line.substr(1, is_event ? 0 : space - 1);
    CHECK(line.front() == (type_of[code] == "string" ? 's' : type_of[code] == "real" ? 'r' : '1'));
    if (type_of[code] == "real" && value != "nan") CHECK_NOTHROW(std::stod(value));
    changes[name_of[code]].emplace_back(now, value);
  }

  std::istringstream text_;
  std::string scope_;
  bool has_declared_ = false;
};

}  // namespace

TEST_CASE("a trace for Perfetto has each command, refusal, trip, message and reading") {
  const Trace trace;
  const json whole = json::parse(trace.converted("perfetto"));
  std::map<std::size_t, std::string> groups;
  std::map<std::string, std::size_t> seen;  // group and kind
  std::uint64_t last = 0;
  for (const json& event : whole.at("traceEvents")) {
    const auto group = event.at("pid").get<std::size_t>();
    if (event.at("name") == "process_name") groups[group] = event.at("args").at("name");
    if (event.at("ph") == "M") continue;
    ++seen[groups.at(group) + " " + event.at("ph").get<std::string>()];
    last = std::max<std::uint64_t>(last, event.at("ts"));
    if (event.at("ph") == "X") CHECK(event.at("dur").get<std::int64_t>() >= 0);
  }
  CHECK(trace.count("command") >= 4);
  CHECK(seen["actuators X"] == trace.count("command"));
  CHECK(seen["behaviors X"] == trace.count("win"));
  CHECK(trace.count("lose") >= 2);
  CHECK(seen["behaviors i"] == trace.count("lose"));
  CHECK(seen["safety X"] == trace.count("trip") + trace.count("halt"));
  CHECK(seen["robot i"] == trace.count("log"));
  CHECK(seen["robot X"] == 2);  // programs
  CHECK(seen["sensors C"] == trace.count("input"));
  CHECK(last > 10'000'000);  // the second program begins when the first has ended
}

TEST_CASE("a trace as CSV says all that the trace says") {
  const Trace trace;
  const std::string csv = trace.converted("csv");
  const tool::CsvTable table = tool::read_csv(trace.write("run.csv", csv));
  REQUIRE(table.rows.size() == trace.lines.size());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    json left = trace.lines[i];
    CHECK(table.rows[i].cells.back().empty() == left.contains("t_us"));
    for (std::size_t c = 0; c < table.columns.cells.size(); ++c) {
      const std::string& name = table.columns.cells[c];
      const std::string& cell = table.rows[i].cells[c];
      if (name == "more") {
        if (!cell.empty()) CHECK(json::parse(cell) == left);
        if (!cell.empty()) left.clear();
      } else if (name == "program") {
        CHECK(cell == (i <= trace.lines.size() / 2 ? "1" : "2"));
      } else if (left.contains(name)) {
        const json& value = left[name];
        CHECK(cell == (value.is_string() ? value.get<std::string>() : value.dump()));
        left.erase(name);
      } else {
        CHECK(cell.empty());
      }
    }
    CHECK(left.empty());
  }
}

TEST_CASE("a trace as CSV has the same columns for every trace, and one for each key of an event") {
  const Trace trace;
  const auto header_of = [](const std::string& csv) { return csv.substr(0, csv.find("\r\n")); };
  const std::string header = header_of(trace.converted("csv"));
  CHECK_THAT(header, Catch::StartsWith("program,t_us,step,event,") && Catch::EndsWith(",more"));
  const std::string one =
      trace.write("one.jsonl", R"({"t_us":0,"step":0,"event":"activated","seed":1})"
                               "\n");
  CHECK(header_of(test::rsc({"trace", "convert", one, "--to", "csv"}).out) == header);
  const std::string keys = "," + header + ",";
  std::vector<std::string> expected = {"safety", "behavior", "why", "trigger", "echo"};
  for (const json& line : trace.lines)
    for (const auto& [key, value] : line.items())
      if (line.contains("t_us")) expected.push_back(key);
#define PARAM(name, spelling, doc) expected.emplace_back(#name);
#include "vm/params.def"
#undef PARAM
#define EVENT(name, number, subject, object, values, doc) expected.emplace_back(values);
#include "link/events.def"
#undef EVENT
  for (std::string key : expected) {
    if (key.ends_with('_')) key.pop_back();  // FOR
    if (key.empty() || key == "args" || key == "word,params") continue;
    CAPTURE(key);
    CHECK_THAT(keys, Contains("," + key + ","));
  }
  // A key that no column has is not lost.
  const std::string odd = trace.write("odd.jsonl", R"({"event":"board","program":7,"more":1})"
                                                   "\n");
  CHECK_THAT(test::rsc({"trace", "convert", odd, "--to", "csv"}).out,
             Contains(R"(,"{""program"":7,""more"":1}")"));
}

TEST_CASE("docs/scenario.md says what each column of the CSV has") {
  std::string table = "| columns | what |\n|---|---|\n";
  const auto add = [&](std::string names, std::string_view doc) {
    for (std::size_t at = 0; (at = names.find(',', at)) != std::string::npos; at += 4)
      names.replace(at, 1, "`, `");
    table += fmt::format("| `{}` | {} |\n", names, doc);
  };
#define COLUMNS(names, doc) add(names, doc);
#include "rsc/trace/csv_columns.def"
#undef COLUMNS
  testing::expect_generated(std::filesystem::path(ROBOSYNC_SOURCE_DIR) / "docs/scenario.md",
                            "csv columns", table);
}

TEST_CASE("a SAFETY rule that trips or lets go has its name in the trace and in CSV") {
  const Trace trace;
  for (const json& line : trace.lines) {
    const bool is_safety = line.at("event") == "trip" || line.at("event") == "resume";
    CHECK(line.value("safety", "") == (is_safety ? "guard" : ""));
  }
  CHECK_THAT(trace.converted("csv"), Contains(",guard,"));
}

TEST_CASE("a trace as VCD is well formed, and says when what began and ended") {
  const Trace trace;
  Vcd vcd(trace.converted("vcd"));
  const auto& arm = vcd.changes["actuators.arm"];
  std::size_t commands = 0;
  for (const auto& [at, value] : arm)
    if (!value.empty()) ++commands;
  CHECK(commands == trace.count("command"));
  CHECK(arm.front() == std::pair<std::uint64_t, std::string>{0, ""});
  CHECK(std::ranges::find(arm, std::pair<std::uint64_t, std::string>{
                                   1'000'000, "MOVE\\x20SLOWLY\\x20TO\\x2090"}) != arm.end());
  const auto& level = vcd.changes["sensors.touch_LEVEL"];
  CHECK(level.front().second == "nan");
  CHECK(level.size() == trace.count("input") - vcd.changes["sensors.near_DISTANCE_mm"].size() + 2);
  REQUIRE(!vcd.changes["variables.mood"].empty());
  CHECK(vcd.changes["variables.mood"].back().second == "cross");
  CHECK(vcd.changes["robot.log"].size() == trace.count("log"));
  CHECK(vcd.changes["safety.arm"].size() == 1 + trace.count("halt") + trace.count("release"));
}

TEST_CASE("bytes without an end are no trace") {
  const Outcome outcome = test::rsc({"replay", "/dev/zero"});
  CHECK(outcome.exit == 1);
  CHECK_THAT(outcome.err, Contains("/dev/zero:1: this line has more than a million characters"));
}

TEST_CASE("rsc trace: what is no trace, and what is no format, is said") {
  const Folder folder;
  const auto convert = [](const std::string& file, const std::string& format = "csv") {
    return test::rsc({"trace", "convert", file, "--to", format});
  };
  Outcome outcome = convert(folder.path("none.jsonl"));
  CHECK(outcome.exit == 3);
  CHECK(convert(folder.write("empty.jsonl", "")).exit == 3);
  for (const char* wrong :
       {"[1]\n", "{}\n", "{\"event\":3}\n", "\n", "\xff\xfe\n",
        "{\"event\":\"input\",\"t_us\":-1}\n", "{\"event\":\"input\",\"t_us\":1e300}\n",
        "{\"event\":\"input\",\"t_us\":18446744073709551615}\n"}) {
    const std::string good = R"({"t_us":0,"step":0,"event":"activated","seed":1})";
    outcome = convert(folder.write("wrong.jsonl", good + "\n" + wrong));
    CAPTURE(wrong, outcome.err);
    CHECK(outcome.exit == 1);
    CHECK_THAT(outcome.err, Contains("wrong.jsonl:2: "));
  }
  // As of a monitor that was killed: the rest is there.
  const std::string cut = folder.write("cut.jsonl", R"({"t_us":0,"event":"activated"})"
                                                    "\n{\"t_us\":1000,\"ev");
  outcome = convert(cut, "vcd");
  CHECK(outcome.exit == 0);
  CHECK_THAT(outcome.err, Contains("cut.jsonl:2: this line is incomplete"));
  // What no trace of ours says does no harm.
  const std::string odd =
      folder.write("odd.jsonl", R"({"event":"win"})"
                                "\n"
                                R"({"event":"command","actuator":3,"verb":[1],"to":{"a":null}})"
                                "\n"
                                R"({"event":"input","t_us":5,"sensor":null,"value":{}})"
                                "\n"
                                R"({"event":"set","t_us":3,"variable":"a b\n$end","value":"x y"})"
                                "\n"
                                R"({"event":"log","text":"say \"hi\""})"
                                "\n");
  for (const char* format : {"csv", "vcd", "perfetto"})
    CHECK(convert(odd, format).exit == 0);
  CHECK_NOTHROW(Vcd(convert(odd, "vcd").out));
  CHECK_THAT(convert(odd).out, Contains(R"(,"say ""hi""")"));

  CHECK(convert(cut, "pdf").exit == 2);
  CHECK(test::rsc({"trace", "convert", cut}).exit == 2);
  CHECK(test::rsc({"trace", "show", cut, "--to", "csv"}).exit == 2);
  outcome = test::rsc({"trace", "convert", cut, "--to", "csv", "-o", cut});
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err, Contains("is an input"));
}
