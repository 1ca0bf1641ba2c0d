// How short a WAIT may be whose number is worked out: what the analysis says, held against the
// interpreter and the simulator.
#include <algorithm>
#include <map>
#include <random>
#include <sstream>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "analysis/interval.hpp"
#include "analysis/task_set.hpp"
#include "rsc/algorithm_modules.hpp"
#include "rsc/board.hpp"
#include "tests/rsc/process.hpp"
#include "tests/runtime-m4/robot.hpp"
#include "tests/timing/programs.hpp"
#include "vm/interpreter.hpp"
#include "vm/opcode.hpp"

using namespace robosync;
using analysis::Interval;
using Catch::Contains;

namespace {

// Of the rule at this line: how often it goes on or begins by itself, in ms, the shortest first.
std::vector<std::uint64_t> periods_of(const vm::Image& image, unsigned line) {
  const policy::BoardCosts& board = tool::board_costs();
  const analysis::TaskSet set = analysis::task_set_of(image, board, tool::module_cost);
  std::vector<std::uint64_t> periods;
  for (const analysis::Source& source : set.sources)
    if (source.name == fmt::format("the rule at line {}, by itself", line) ||
        source.name == fmt::format("the rule at line {}, after a pause", line))
      periods.push_back(source.period / board.instructions_per_ms());
  std::ranges::sort(periods);
  return periods;
}

using Periods = std::vector<std::uint64_t>;

// Of a rule that does this when it is touched.
Periods periods_of(const std::string& declared, const std::string& body) {
  const tool::Program program = test::compile_with_docs_robot("WHEN touch LEVEL > 3 DO\n" + body +
                                                              "\nLOG \"waited\"\nEND\n" + declared);
  return periods_of(program.image(), 1);
}

test::Outcome check(const std::string& program) {
  const test::Folder folder;
  folder.write("robot.json", testing::read_file(test::kRoot / "docs/robot.json"));
  return test::rsc({"check", "--timing", folder.write("robot.rsl", program)});
}

// Three states that follow each other, each after this wait.
std::string three_states(const std::string& wait) {
  std::string text = "STATE m: s0, s1, s2\nAT START DO SET m TO s1\nEND\n";
  for (int i = 0; i < 3; ++i)
    text +=
        fmt::format("WHEN m BECOMES s{}\nDO\n  {}\n  SET m TO s{}\nEND\n", i, wait, (i + 1) % 3);
  return text;
}

}  // namespace

TEST_CASE("check: a WAIT that is worked out takes as long as its least number") {
  CHECK(check(three_states("WAIT 2s")).exit == 0);
  CHECK(check(three_states("WAIT RANDOM(2s, 4s)")).exit == 0);
  CHECK(check(three_states("WAIT MAX(1s, touch LEVEL * 1s - 3s) + 1s")).exit == 1);  // unknown
  CHECK(check("REMEMBER pause = 2s\n" + three_states("WAIT pause")).exit == 0);
  CHECK(check("REMEMBER gap = 0s\n" + three_states("WAIT MAX(1s, gap)")).exit == 0);
  CHECK(check("REMEMBER gap = 0s\n" + three_states("WAIT 1s\n  WAIT gap")).exit == 0);
}

TEST_CASE("check: a WAIT that may be 0 is said to be the reason, by its line") {
  const test::Outcome refused = check("REMEMBER gap = 0s\n" + three_states("WAIT gap") +
                                      "WHEN touch LEVEL > 3 DO SHOW face happy\nEND\n");
  CHECK(refused.exit == 1);
  CHECK_THAT(refused.err, Contains("error[E0412]") && Contains("the WAIT at line 7 may be 0 s") &&
                              Contains("MAX(1s, ") && !Contains("lower rate"));
  const auto first = refused.err.find("for what follows the rule at line 15");
  CHECK((first == std::string::npos ||
         refused.err.find("for what follows the rule at line 15", first + 1) == std::string::npos));
  CHECK_THAT(refused.out, !Contains(" 0.0 %\n        processor"));
  if (refused.out.find("no bound") != std::string::npos)
    CHECK_THAT(refused.out, Contains("> 100 %"));
}

TEST_CASE("what a WAIT takes at least") {
  CHECK(periods_of("", "WAIT RANDOM(2s, 4s)") == Periods{2000});
  CHECK(periods_of("", "WAIT RANDOM(1s, 3s) * 2 + 500ms") == Periods{2500});
  CHECK(periods_of("", "WAIT 10s - RANDOM(1s, 3s)") == Periods{7000});
  CHECK(periods_of("", "WAIT RANDOM(4s, 6s) / 2") == Periods{2000});
  CHECK(periods_of("", "WAIT MIN(RANDOM(4s, 6s), 3s)") == Periods{3000});
  CHECK(periods_of("", "WAIT ABS(RANDOM(-3s, -2s))") == Periods{2000});
  CHECK(periods_of("", "WAIT ROUND(RANDOM(1.4s, 5s))") == Periods{1000});
  CHECK(periods_of("", "WAIT RANDOM(-2s, 4s)") == Periods{1});
  CHECK(periods_of("", "WAIT 2s / RANDOM(-1, 1)") == Periods{1});
  CHECK(periods_of("", "WAIT touch LEVEL * 1s") == Periods{1});
  CHECK(periods_of("", "WAIT MAX(1s, touch LEVEL * 1s)") == Periods{1});  // may be unknown
}

TEST_CASE("what a WAIT for a variable takes at least: of all that it may be") {
  CHECK(periods_of("REMEMBER p = 2s", "WAIT p") == Periods{2000});
  CHECK(periods_of("REMEMBER p = 2s\nEVERY 1s DO SET p TO RANDOM(1s, 5s)\nEND", "WAIT p") ==
        Periods{1000});
  CHECK(periods_of(
            "REMEMBER p = 2s\nREMEMBER q = 4s\nEVERY 1s DO\nSET p TO q / 4\nSET q TO p * 4\nEND",
            "WAIT p") == Periods{1000});
  CHECK(periods_of("REMEMBER p = 2s\nEVERY 1s DO SET p TO p - 1ms\nEND", "WAIT p") == Periods{1});
  CHECK(periods_of("REMEMBER p = 2s\nEVERY 1s DO LOWER p BY 1ms\nEND", "WAIT p") == Periods{1});
  CHECK(periods_of("REMEMBER p = 2s\nEVERY 1s DO SET p TO touch LEVEL * 1s\nEND", "WAIT p") ==
        Periods{1});
  CHECK(periods_of("REMEMBER p = 2s\nEVERY 1s DO SET p TO touch LEVEL * 1s\nEND",
                   "WAIT MAX(1s, p)") == Periods{1000});
  CHECK(periods_of("REMEMBER p = 2s KEPT", "WAIT p") == Periods{1});
  CHECK(periods_of("FEELING joy FROM 0 TO 10 START 5\nEVERY 1s DO RAISE joy BY 1\nEND",
                   "WAIT joy * 1s + 3s") == Periods{3000});
  // Here it is what it was just set to; after a wait others may have set it.
  CHECK(periods_of("REMEMBER p = 0s", "SET p TO RANDOM(1s, 2s)\nWAIT p") == Periods{1000});
  CHECK(periods_of("REMEMBER p = 0s",
                   "SET p TO 1s\nIF touch LEVEL > 5 DO\nSET p TO 20ms\nEND\nWAIT p") ==
        Periods{20});
  CHECK(periods_of("REMEMBER p = 0s", "SET p TO 5s\nWAIT 3s\nWAIT p") == Periods{3000, 3001});
}

TEST_CASE("a TIMER is always known, and never below 0") {
  CHECK(periods_of("TIMER t", "WAIT MAX(1s, t)") == Periods{1000});
  CHECK(periods_of("TIMER t", "WAIT t + 1s") == Periods{1000});
  CHECK(periods_of("TIMER t", "WAIT t * 2") == Periods{1});
  CHECK(check("TIMER t\n" + three_states("WAIT t + 1s")).exit == 0);
}

TEST_CASE("check: a program that reads no sensor is not told to give one a lower rate") {
  std::string text;
  for (int i = 0; i < 60; ++i)
    text += "EVERY 1ms DO LOG \"busy\", RANDOM(0, 5) * RANDOM(0, 5)\nEND\n";
  const test::Outcome refused = check(text);
  CHECK(refused.exit == 1);
  CHECK_THAT(refused.err, Contains("error[E0412]") &&
                              Contains("let rules run less often, or make") && !Contains("sensor"));
}

TEST_CASE("what may be over at once comes as seldom as all that waits on the way to it again") {
  const std::string none = "REMEMBER p = 0s";
  CHECK(periods_of(none, "WAIT 1s\nWAIT p") == Periods{1000, 1001});
  CHECK(periods_of(none, "WAIT p\nWAIT 1s") == Periods{1});  // it may be interrupted and begin anew
  CHECK(periods_of(none, "WAIT 1s\nREPEAT 3 TIMES\nWAIT 200ms\nWAIT p\nEND") == Periods{200, 201});
  CHECK(periods_of(none, "WAIT 1s\nREPEAT 3 TIMES\nWAIT p\nEND") == Periods{1});
  CHECK(periods_of(none, "IF p < 5s DO\nWAIT 1s\nELSE\nWAIT 2s\nEND\nWAIT p") ==
        Periods{1000, 1001});
  CHECK(periods_of(none, "IF touch LEVEL > 5 DO\nWAIT 1s\nEND\nWAIT p") == Periods{1});
}

TEST_CASE("EVERY comes round as seldom as the least number that it may be") {
  const auto every = [](const std::string& time) {
    const tool::Program program = test::compile_with_docs_robot(
        "EVERY " + time + " DO\nLOG \"round\"\nEND\nREMEMBER p = 2s\n");
    return periods_of(program.image(), 1);
  };
  CHECK(every("3s") == Periods{3000});
  CHECK(every("2s TO 5s") == Periods{2000});
  CHECK(every("p") == Periods{2000});
  CHECK(every("p - RANDOM(1s, 2s)") == Periods{1});
}

TEST_CASE("an instruction gives nothing outside of the interval that is said") {
  std::mt19937 random(7);
  const auto number = [&] {
    const vm::Value edges[] = {vm::kUnknown, vm::kValueMin, vm::kValueMax, 0, 1, -1, 1000, -1000};
    if (random() % 4 == 0) return edges[random() % std::size(edges)];
    return static_cast<vm::Value>(random()) >> random() % 31;
  };
  for (std::size_t o = 0; o < vm::kOpcodes.size(); ++o) {
    const vm::OpcodeInfo& info = vm::kOpcodes[o];
    if (info.operands[0] != vm::Operand::write && info.operands[0] != vm::Operand::write_same)
      continue;
    for (unsigned i = 0; i < 4000; ++i) {
      vm::Value constant = number();
      while (constant == vm::kUnknown ||
             (vm::is_positive(vm::widened(info.operands[2])) && constant <= 0) ||
             (vm::is_positive(info.operands[2]) && constant <= 0))
        constant = number();
      const std::vector<vm::Value> constants{constant};
      vm::Image image;
      image.constants = constants;
      const bool wide = vm::is_wide(info.operands[1]);
      const bool k = info.operands[2] != vm::Operand::read && info.operands[2] != vm::Operand::none;
      const auto op = static_cast<vm::Opcode>(o);
      const vm::Word word = wide ? vm::encode_wide(op, 0, 0) : vm::encode(op, 0, 1, k ? 0 : 2);
      std::vector<Interval> cells(3);
      for (Interval& cell : cells) {
        const vm::Value a = number(), b = random() % 3 == 0 ? a : number();
        cell = {std::min(a, b), std::max(a, b)};
      }
      const Interval said = analysis::result_of(image, word, cells);
      for (unsigned j = 0; j < 8; ++j) {
        vm::Value frame[3] = {};
        for (unsigned c = 1; c < 3; ++c) {
          std::uniform_int_distribution<vm::Value> between(cells[c].low, cells[c].high);
          frame[c] = j < 4 ? (j >> (c - 1) & 1 ? cells[c].low : cells[c].high) : between(random);
        }
        vm::Machine machine{};
        machine.frame = frame;
        machine.constants = constants.data();
        machine.random = 1 + static_cast<std::uint32_t>(random());
        const vm::Word code[] = {word, vm::encode(vm::Opcode::end)};
        const vm::Value b = frame[1], c = frame[2];
        static_cast<void>(vm::run(machine, code, nullptr));
        if (frame[0] < said.low || frame[0] > said.high) {
          CAPTURE(info.name, b, c, constant, frame[0], said.low, said.high);
          FAIL();
        }
      }
    }
  }
}

namespace {

// A duration that is worked out, of which much is 0, negative or unknown.
std::string drawn(std::mt19937& random, unsigned depth) {
  const auto again = [&] { return drawn(random, depth - 1); };
  const auto ms = [&] { return static_cast<int>(random() % 400) - 50; };
  if (depth == 0) {
    const int low = ms();
    switch (random() % 4) {
      case 0:
        return fmt::format("RANDOM({}ms, {}ms)", low, low + 1 + static_cast<int>(random() % 100));
      case 1:
        return random() % 4 == 0 ? "near X * 10ms" : "p";
      case 2:
        return "q";
      default:
        return fmt::format("{}ms", ms());
    }
  }
  switch (random() % 8) {
    case 0:
      return again() + " + " + again();
    case 1:
      return fmt::format("({} - {})", again(), again());
    case 2:
      return fmt::format("({}) * {}", again(), static_cast<int>(random() % 5) - 1);
    case 3:
      return fmt::format("({}) / {}", again(), static_cast<int>(random() % 3) + 1);
    case 4:
      return fmt::format("MIN({}, {})", again(), again());
    case 5:
      return fmt::format("MAX({}, {})", again(), again());
    case 6:
      return fmt::format("ABS({})", again());
    default:
      return fmt::format("({}) / (RANDOM(-1, 3))", again());
  }
}

std::string drawn_body(std::mt19937& random, unsigned depth) {
  std::string body;
  for (unsigned i = 0; i < 1 + random() % 3; ++i) {
    switch (random() % (depth == 0 ? 3U : 5U)) {
      case 0:
        body += fmt::format("SET p TO {}\n", drawn(random, 2));
        break;
      case 3:
        body += "IF near X > 50 DO\n" + drawn_body(random, depth - 1) + "ELSE\n" +
                drawn_body(random, depth - 1) + "END\n";
        break;
      case 4:
        body += "REPEAT 3 TIMES\n" + drawn_body(random, depth - 1) + "WAIT 20ms\nEND\n";
        break;
      default:
        body += fmt::format("WAIT {}\n", drawn(random, 2));
    }
  }
  return body;
}

// In ms, of those of the first ten rules.
template <typename Wanted>
Periods times_of_going_on(const test::Robot& robot, const Wanted& wanted) {
  Periods times;
  std::istringstream lines(robot.only("go_on"));
  for (std::string line; std::getline(lines, line);)
    if (wanted(static_cast<unsigned>(line.back() - '0'))) times.push_back(std::stoull(line));
  return times;
}

// In any stretch, of each source one more at most than its periods that fit.
void check_no_more_often(const Periods& times, const Periods& said) {
  for (std::size_t i = 0; i < times.size(); ++i)
    for (std::size_t j = i; j < std::min(times.size(), i + 50); ++j) {
      std::uint64_t most = 0;
      for (const std::uint64_t period : said)
        most += (times[j] - times[i]) / period + 1;
      if (j - i + 1 > most) {
        CAPTURE(times[i], times[j], j - i + 1, most);
        FAIL();
      }
    }
}

}  // namespace

TEST_CASE("no response goes on more often than is said") {
  std::mt19937 random(11);
  unsigned bounded = 0;
  for (unsigned p = 0; p < 150; ++p) {
    const std::string program = fmt::format(
        "WHILE near X > 3 DO\n{}WAIT 5ms\nEND\nREMEMBER p = 90ms\nREMEMBER q = 70ms\n"
        "EVERY 130ms DO\nSET p TO {}\nEND\n{}",
        drawn_body(random, 2), drawn(random, 1),
        random() % 2 == 0 ? "" : fmt::format("EVERY 70ms DO SET q TO {}\nEND\n", drawn(random, 1)));
    INFO(program);
    if (compiler::compile({"robot.rsl", program}, {"robot.json", test::kPlainRobot})
            .diagnostics.errors() > 0)
      continue;  // a number below 0
    test::Robot robot(program);
    const Periods said = periods_of(robot.image(), 1);
    REQUIRE_FALSE(said.empty());
    bounded += said.size() > 1 || said.front() > 1 ? 1 : 0;
    for (std::uint64_t ms = 0; ms < 4000; ms += 37)
      robot.feed(ms, "X", static_cast<int>(random() % 100));
    robot.run(4000);
    const Periods times = times_of_going_on(robot, [](unsigned rule) { return rule == 0; });
    check_no_more_often(times, said);
  }
  CHECK(bounded > 20);
}

namespace {

// Pauses and commands, short ones and such as are done at once.
std::string drawn_short(std::mt19937& random, unsigned depth) {
  std::string body;
  for (unsigned i = 0; i < 1 + random() % 3; ++i) {
    switch (random() % (depth == 0 ? 5U : 6U)) {
      case 0:
        body += fmt::format("MOVE a FOR {}ms\n", random() % 30);
        break;
      case 1:
        body += fmt::format("WAIT {}ms\n", 1 + random() % 60);
        break;
      case 2:
        body += "THEN\n";
        break;
      case 3:
        body += fmt::format("WAIT UNTIL near X {}\n",
                            random() % 2 == 0 ? fmt::format("> {}", random() % 100) : "CHANGES");
        break;
      case 4:
        body +=
            fmt::format("WAIT UNTIL near X > {} WITHIN {}ms\n", random() % 100, 1 + random() % 40);
        break;
      default:
        body += "IF near X > 50 DO\n" + drawn_short(random, depth - 1) + "ELSE\n" +
                drawn_short(random, depth - 1) + "END\n";
    }
  }
  return body;
}

std::string drawn_head(std::mt19937& random) {
  switch (random() % 3) {
    case 0:
      return fmt::format("EVERY {}ms", 10 + random() % 50);
    case 1:
      return fmt::format("WHEN near X > {}", random() % 100);
    default:
      return fmt::format("WHILE near X > {}", random() % 60);
  }
}

// When the rule goes on, and when it begins without a trigger of another kind than an EVERY's, in ms.
Periods times_by_itself(const test::Robot& robot, char rule, bool is_every) {
  Periods times;
  std::istringstream lines(robot.only("fire win go_on"));
  std::string fired;
  for (std::string line; std::getline(lines, line);) {
    const std::string at = line.substr(0, line.find(' '));
    if (line.find(std::string(" r") + rule) == std::string::npos) continue;
    if (line.find(" fire ") != std::string::npos) fired = at;
    const bool triggered = line.find(" win ") != std::string::npos && fired == at && !is_every;
    if (line.find(" fire ") == std::string::npos && !triggered) times.push_back(std::stoull(at));
  }
  return times;
}

}  // namespace

TEST_CASE("no response begins or goes on by itself more often than is said") {
  std::mt19937 random(21);
  unsigned many = 0;
  for (unsigned p = 0; p < 300; ++p) {
    const std::string head = drawn_head(random);
    // What may not lose its actuator begins again for other reasons, and is worked out by others.
    const bool may_lose = random() % 2 == 0;
    const std::string high = fmt::format(
        "BEHAVIOR high PRIORITY 60\nWHEN far Y CHANGES BY 30% DO\nMOVE a FOR {}ms\nEND\nEND\n",
        random() % 30);
    const std::string program =
        fmt::format("{}BEHAVIOR low PRIORITY 40\n{} DO\n{}MOVE a FOR {}ms\nEND\nEND\n",
                    may_lose ? high : "\n\n\n\n\n", head, drawn_short(random, 2), random() % 30);
    INFO(program);
    if (compiler::compile({"robot.rsl", program}, {"robot.json", test::kPlainRobot})
            .diagnostics.errors() > 0)
      continue;
    test::Robot robot(program);
    const Periods said = periods_of(robot.image(), 7);
    for (std::uint64_t ms = 0; ms < 3000; ms += 1 + random() % 12)
      if (const char* const channel = random() % 2 == 0 ? "X" : "Y"; robot.has(channel))
        robot.feed(ms, channel, static_cast<int>(random() % 100));
    robot.run(3000);
    Periods times = times_by_itself(robot, may_lose ? '1' : '0', head.starts_with("EVERY"));
    // A WHILE may end a round and begin the next one in the same millisecond: both count as one.
    const auto doubled = std::ranges::unique(times);
    times.erase(doubled.begin(), doubled.end());
    many += times.size() > 30 ? 1 : 0;
    check_no_more_often(times, said);
  }
  CHECK(many > 100);
}

TEST_CASE("responses that hold the same actuator go on no more often together than is said") {
  std::mt19937 random(12);
  constexpr unsigned kRules = 5;
  std::size_t total = 0;
  for (unsigned p = 0; p < 40; ++p) {
    std::string program;
    std::vector<bool> moves_a;
    for (unsigned r = 0; r < kRules; ++r) {
      moves_a.push_back(random() % 3 != 0);
      program += fmt::format("WHEN near X IS BETWEEN {} AND {} DO\n{}\nWAIT 30ms\nWAIT 40ms\nEND\n",
                             r * 20, r * 20 + 25, moves_a[r] ? "MOVE a TO 50%" : "MOVE b TO 50%");
    }
    INFO(program);
    test::Robot robot(program);
    Periods said;
    const policy::BoardCosts& board = tool::board_costs();
    for (const auto& source :
         analysis::task_set_of(robot.image(), board, tool::module_cost).sources)
      if (source.name == "responses that hold a")
        said.push_back(source.period / board.instructions_per_ms());
    if (std::ranges::count(moves_a, true) < 2) {
      CHECK(said.empty());
      continue;
    }
    REQUIRE(said == Periods{30});
    for (std::uint64_t ms = 0; ms < 4000; ms += 13)
      robot.feed(ms, "X", static_cast<int>(random() % 100));
    robot.run(4000);
    const Periods times = times_of_going_on(robot, [&](unsigned rule) { return moves_a[rule]; });
    total += times.size();
    for (std::size_t i = 1; i < times.size(); ++i)
      CHECK(times[i] - times[i - 1] >= said.front());
  }
  CHECK(total > 300);
}

TEST_CASE("check: states that follow each other, each with a THEN, cost no more than one") {
  const auto states = [](unsigned count) {
    std::string text = "STATE m: s0";
    for (unsigned i = 1; i < count; ++i)
      text += fmt::format(", s{}", i);
    for (unsigned i = 0; i < count; ++i)
      text += fmt::format(
          "\nWHEN m BECOMES s{}\nDO\n  MOVE left_arm TO 10deg\n  THEN\n  SET m TO s{}\nEND", i,
          (i + 1) % count);
    const tool::Program program = test::compile_with_docs_robot(text + "\n");
    return analysis::utilization(
        analysis::task_set_of(program.image(), tool::board_costs(), tool::module_cost));
  };
  CHECK(states(9) < states(3) + 0.06);
}
