// Control flow, waits, SETs and random numbers, run by the interpreter: where a response goes on,
// how often a loop runs, and what the caller is told.
#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include <catch2/catch.hpp>

#include "vm/interpreter.hpp"
#include "vm/opcode.hpp"

using namespace robosync::vm;
using Op = Opcode;

namespace {

constexpr unsigned kLoopCell = 9;
constexpr Word kMark = encode(Op::cmd, 1, 2, 3);

// A response in a frame of 16 cells, run from where it paused.
class Run {
public:
  Run(std::vector<Word> code, std::vector<Value> constants = {})
      : code_(std::move(code)), constants_(std::move(constants)) {
    machine.frame = frame.data();
    machine.constants = constants_.data();
  }
  Progress go(const Word* from = nullptr) {
    output_.assign(2000, 0);
    machine.output = output_.data();
    machine.output_end = output_.data() + output_.size();
    machine.wake = Machine::kNever;
    return respond(machine, from == nullptr ? code_.data() : from);
  }
  // Words put out by the last run.
  [[nodiscard]] std::vector<Word> said() const {
    return {output_.data(), static_cast<const Word*>(machine.output)};
  }
  [[nodiscard]] std::ptrdiff_t place(const Word* word) const { return word - code_.data(); }

  std::array<Value, 16> frame{};
  Machine machine;

private:
  std::vector<Word> code_;
  std::vector<Value> constants_;
  std::vector<Word> output_;
};

// How often the loop's body runs.
std::size_t rounds(Word begin, Value operand, std::vector<Value> constants = {}) {
  Run run({begin, kMark, encode_wide(Op::again, kLoopCell, 2), encode(Op::end)},
          std::move(constants));
  run.frame[0] = operand;
  CHECK(run.go().pause == Pause::ended);
  return run.said().size();
}

}  // namespace

TEST_CASE("unless and unless_known skip by the truth of their cell") {
  const auto skips = [](Op op, Value truth) {
    Run run({encode_wide(op, 0, 1), kMark, encode(Op::end)});
    run.frame[0] = truth;
    CHECK(run.go().pause == Pause::ended);
    return run.said().empty();
  };
  CHECK_FALSE(skips(Op::unless, kTrue));
  CHECK(skips(Op::unless, kFalse));
  CHECK(skips(Op::unless, kUnknown));
  CHECK_FALSE(skips(Op::unless_known, kTrue));
  CHECK_FALSE(skips(Op::unless_known, kFalse));
  CHECK(skips(Op::unless_known, kUnknown));
}

TEST_CASE("a jump skips as far as its 16 bits reach") {
  std::vector<Word> code(0xFFFF + 2, kMark);
  code.front() = encode_wide(Op::jump, 0, 0xFFFF);
  code.back() = encode(Op::end);
  code.insert(code.end() - 1, kMark);
  Run run(code);
  CHECK(run.go().pause == Pause::ended);
  CHECK(run.said() == std::vector<Word>{kMark});
}

TEST_CASE("a loop with a constant runs as often as it says") {
  for (const Value times : {1, 2, 3, 100})
    CHECK(rounds(encode_wide(Op::times, kLoopCell, 0), 0, {times * kScale}) ==
          static_cast<std::size_t>(times));
}

TEST_CASE("a loop with a number runs at least once, whatever the number") {
  const std::map<Value, std::size_t> expected = {{kUnknown, 1}, {kValueMin, 1}, {-1, 1},
                                                 {0, 1},        {1, 1},         {1000, 1},
                                                 {1001, 2},     {7 * kScale, 7}};
  for (const auto& [times, count] : expected) {
    CAPTURE(times);
    CHECK(rounds(encode(Op::times_v, kLoopCell, 0), times) == count);
  }
}

TEST_CASE("loops nest, each with its own count") {
  Run run({encode_wide(Op::times, 8, 0), kMark, encode_wide(Op::times, 9, 1), kMark,
           encode_wide(Op::again, 9, 2), encode_wide(Op::again, 8, 5), encode(Op::end)},
          {3 * kScale, 4 * kScale});
  CHECK(run.go().pause == Pause::ended);
  CHECK(run.said().size() == 3 * (1 + 4));
}

TEST_CASE("around goes on while its cell is true") {
  for (const Value truth : {kFalse, kUnknown}) {
    Run run({encode(Op::loop), kMark, encode_wide(Op::around, 0, 2), encode(Op::end)});
    run.frame[0] = truth;
    CHECK(run.go().pause == Pause::ended);
    CHECK(run.said().size() == 1);
  }
  Run run({encode(Op::loop), kMark, encode(Op::wait_done), encode_wide(Op::around, 0, 3),
           encode(Op::end)});
  run.frame[0] = kTrue;
  Progress progress = run.go();
  for (int i = 0; i < 3; ++i) {
    CHECK(progress.pause == Pause::until_done);
    progress = run.go(progress.next);
    CHECK(run.said().size() == 1);
  }
  run.frame[0] = kFalse;
  CHECK(run.go(progress.next).pause == Pause::ended);
}

TEST_CASE("around_always always goes on") {
  Run run({encode(Op::loop), kMark, encode(Op::wait_done), encode_wide(Op::around_always, 0, 3),
           encode(Op::end)});
  Progress progress = run.go();
  for (int i = 0; i < 5; ++i) {
    CHECK(progress.pause == Pause::until_done);
    CHECK(run.place(progress.next) == 3);
    progress = run.go(progress.next);
    CHECK(run.said().size() == 1);
  }
}

TEST_CASE("a wait says until when, and goes on behind itself") {
  const std::map<Value, std::uint32_t> expected = {
      {kUnknown, 1}, {kValueMin, 1}, {-1, 1}, {0, 1}, {1, 1}, {2, 2}, {kValueMax, 0x7FFFFFFF}};
  for (const std::uint32_t now : {0U, 1000U, 0xFFFFFFFFU})
    for (const auto& [duration, later] : expected) {
      CAPTURE(now, duration);
      Run run({encode(Op::wait, 0), kMark, encode(Op::end)});
      run.frame[0] = duration;
      run.machine.now = now;
      const Progress progress = run.go();
      CHECK(progress.pause == Pause::until_time);
      CHECK(progress.wake == now + later);
      CHECK(run.said().empty());
      CHECK(run.go(progress.next).pause == Pause::ended);
      CHECK(run.said().size() == 1);
    }
}

TEST_CASE("what was put out before a wait is put out once") {
  Run run({kMark, encode(Op::wait_done), kMark, kMark, encode(Op::end)});
  const Progress progress = run.go();
  CHECK(progress.pause == Pause::until_done);
  CHECK(run.said().size() == 1);
  CHECK(run.go(progress.next).pause == Pause::ended);
  CHECK(run.said().size() == 2);
}

TEST_CASE("poll gives up once, until as long as its cell is not true") {
  Run run({encode(Op::poll), encode(Op::move, 1, 0), encode_wide(Op::until, 1, 2), kMark,
           encode(Op::end)});
  run.machine.now = 77;
  run.frame[0] = kTrue;
  Progress progress = run.go();
  CHECK(progress.pause == Pause::polling);  // even though it is true already
  CHECK(progress.wake == 78);
  CHECK(run.place(progress.next) == 1);
  for (const Value truth : {kFalse, kUnknown}) {
    run.frame[0] = truth;
    progress = run.go(progress.next);
    CHECK(progress.pause == Pause::still_polling);
    CHECK(progress.wake == Machine::kNever);
    CHECK(run.place(progress.next) == 1);
  }
  run.frame[0] = kTrue;
  CHECK(run.go(progress.next).pause == Pause::ended);
  CHECK(run.said().size() == 1);
}

TEST_CASE("until that is true too soon gives up until it may go on, whatever is true then") {
  Run run({encode(Op::poll), encode(Op::move, 1, 0), encode_wide(Op::until, 1, 2), kMark,
           encode(Op::end)});
  run.machine.now = 77;
  Progress progress = run.go();
  run.frame[0] = kTrue;
  run.machine.left_ms = 5;
  progress = run.go(progress.next);
  CHECK(progress.pause == Pause::satisfied);
  CHECK(progress.wake == 82);
  CHECK(run.place(progress.next) == 3);
  run.frame[0] = kFalse;
  CHECK(run.go(progress.next).pause == Pause::ended);
  CHECK(run.said().size() == 1);
}

TEST_CASE("a deadline is reached at its time, and until then it is what the wait wakes for") {
  for (const std::uint32_t begin : {0U, 5000U, 0xFFFFFFF0U}) {  // the last: over the wrap
    CAPTURE(begin);
    Run run({encode(Op::deadline, 9, 0), encode(Op::poll), encode(Op::reached, 1, 9),
             encode_wide(Op::until, 1, 2), encode(Op::end)});
    run.frame[0] = 30;
    run.machine.now = begin;
    Progress progress = run.go();
    for (const std::uint32_t later : {1U, 2U, 29U}) {
      run.machine.now = begin + later;
      progress = run.go(progress.next);
      CHECK(progress.pause == Pause::still_polling);
      CHECK(progress.wake == begin + 30);
    }
    run.machine.now = begin + 30;
    CHECK(run.go(progress.next).pause == Pause::ended);
  }
}

TEST_CASE("a deadline without a known duration is reached at once") {
  for (const Value duration : {kUnknown, kValueMin, -1, 0}) {
    Run run({encode(Op::deadline, 9, 0), encode(Op::reached, 1, 9), encode_wide(Op::unless, 1, 1),
             kMark, encode(Op::end)});
    run.machine.now = 123456;
    run.frame[0] = duration;
    CHECK(run.go().pause == Pause::ended);
    CHECK(run.said().size() == 1);
  }
}

TEST_CASE("set and shift write the response's own cell, and say what they wrote") {
  const auto write = [](std::vector<Word> code, Value value) {
    code.push_back(encode(Op::end));
    Run run(code);
    run.frame.fill(11);
    run.frame[1] = value;
    CHECK(run.go().pause == Pause::ended);
    return run;
  };
  Run run = write({encode(Op::set, 5, 1)}, 70);
  CHECK(run.frame[5] == 70);
  CHECK(run.machine.written() == 1U << 5);
  CHECK(run.machine.assigned == 1U << 5);
  run = write({encode(Op::shift, 0, 1)}, -70);
  CHECK(run.frame[0] == -70);
  CHECK(run.machine.written() == 1);
  CHECK(run.machine.assigned == 0);
  run = write({encode(Op::set, 2, 1), encode(Op::shift, 2, 1), encode(Op::shift, 3, 1)}, 5);
  CHECK(run.machine.written() == 0b1100);
  CHECK(run.machine.assigned == 0b0100);
}

TEST_CASE("an unknown value is not set") {
  for (const Op op : {Op::set, Op::shift}) {
    Run run({encode(op, 5, 1), encode(Op::end)});
    run.frame[5] = 3;
    run.frame[1] = kUnknown;
    CHECK(run.go().pause == Pause::ended);
    CHECK(run.frame[5] == 3);
    CHECK(run.machine.written() == 0);
    CHECK(run.machine.assigned == 0);
  }
}

namespace {
Value draw(Machine& machine, Value b, Value c) {
  std::array<Value, 3> frame{b, c, 0};
  machine.frame = frame.data();
  const std::array<Word, 2> code{encode(Op::random, 2, 0, 1), encode(Op::ret_number, 2)};
  return evaluate(machine, code.data());
}
}  // namespace

TEST_CASE("random numbers fill their range evenly, in either order of its ends") {
  Machine machine;
  constexpr int kDraws = 70000;
  for (const bool swapped : {false, true}) {
    std::map<Value, int> seen;
    for (int i = 0; i < kDraws; ++i)
      ++seen[swapped ? draw(machine, 3, -3) : draw(machine, -3, 3)];
    REQUIRE(seen.size() == 7);
    CHECK(seen.begin()->first == -3);
    CHECK(seen.rbegin()->first == 3);
    // 10,000 each; the standard deviation is 93.
    for (const auto& [value, count] : seen)
      CHECK(std::abs(count - kDraws / 7) < 560);
  }
}

TEST_CASE("random numbers from the whole range, from one number, and from an unknown") {
  Machine machine;
  bool low = false;
  bool high = false;
  for (int i = 0; i < 1000; ++i) {
    const Value drawn = draw(machine, kValueMin, kValueMax);
    REQUIRE(drawn != kUnknown);
    low = low || drawn < kValueMin / 2;
    high = high || drawn > kValueMax / 2;
    CHECK(draw(machine, 42, 42) == 42);
  }
  CHECK((low && high));
  CHECK(draw(machine, kUnknown, 1) == kUnknown);
  CHECK(draw(machine, 1, kUnknown) == kUnknown);
}

TEST_CASE("the same seed draws the same numbers, and the state never becomes 0") {
  Machine one;
  Machine two;
  one.random = two.random = 0xFFFFFFFF;
  for (int i = 0; i < 100000; ++i) {
    REQUIRE(draw(one, 0, kValueMax) == draw(two, 0, kValueMax));
    REQUIRE(one.random != 0);
  }
}
