// The time words against those of tests/oracles, which remember everything: each is worked out anew
// from the whole history. Timelines are drawn, and start at any time, also shortly before the
// milliseconds wrap.
#include "vm/timers.hpp"

#include <array>
#include <optional>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/oracles/rsl/past.hpp"
#include "vm/opcode.hpp"

using namespace robosync::vm;
using Op = Opcode;
namespace oracle = robosync::oracle;

namespace {

struct Moment {
  std::uint32_t time;  // since the start of the timeline: does not wrap
  Value a, b;
};
using History = std::vector<Moment>;

constexpr std::uint32_t kSentinel = 0x5EED5EED;

// One timer in a condition of its own: cells 0 and 1 are its operands, 0 gets the result.
class Subject {
public:
  Subject(Op op, Value duration, unsigned count, std::uint32_t epoch)
      : code_{encode(op, 0, 1, 0), encode(Op::ret_number, 0)}, epoch_(epoch) {
    timer_ = {timer_kind_of(op), static_cast<std::uint8_t>(count), 1, duration};
    memory_.fill(kSentinel);
    for (unsigned i = 0; i < words(); ++i)
      memory_[1 + i] = 0;
    machine.frame = frame_.data();
    machine.timers = &timer_;
    machine.timer_memory = memory_.data();
  }
  Value evaluate(const Moment& moment) {
    frame_ = {moment.a, moment.b};
    machine.now = epoch_ + moment.time;
    machine.wake = Machine::kNever;
    machine.event = false;
    const Value result = robosync::vm::evaluate(machine, code_.data());
    REQUIRE(memory_[0] == kSentinel);
    REQUIRE(memory_[1 + words()] == kSentinel);
    return result;
  }
  // Milliseconds until it wants to be looked at again.
  [[nodiscard]] std::optional<std::uint32_t> sleeps() const {
    if (machine.wake == Machine::kNever) return {};
    return machine.wake - machine.now;
  }
  Machine machine;

private:
  [[nodiscard]] unsigned words() const { return timer_words(timer_); }

  std::array<Word, 2> code_;
  std::uint32_t epoch_;
  Timer timer_{};
  std::array<Value, 2> frame_{};
  std::array<std::uint32_t, kMaxEdges + 4> memory_{};
};

// ---- the model: the result in the last moment of a history

Value model(TimerKind kind, const History& history, std::uint32_t amount, unsigned times) {
  oracle::Past past;
  const bool is_number = kind == TimerKind::changed;
  const bool has_two = kind == TimerKind::sequence || kind == TimerKind::latch;
  oracle::Moment now;
  for (const Moment& moment : history) {
    now = {now.step + 1, moment.time};
    const oracle::Truth a = oracle::truth_of(moment.a);
    const oracle::Truth b = oracle::truth_of(moment.b);
    if (is_number)
      past.add({now, {}, {}, oracle::number_of(moment.b)});
    else
      past.add({now, has_two ? a : b, has_two ? b : oracle::Truth(), {}});
  }
  return oracle::value_of(past.truth({kind, amount, times}, now));
}

// ---- timelines

class Timeline {
public:
  explicit Timeline(std::uint32_t seed) : random_(seed) {}

  Moment next() {
    const std::uint32_t step = pick({0, 1, 1, 2, 10, 50, 100, 101});
    time_ += history_.empty() ? 0 : step;
    // Truths stay for a while, so that all durations are met.
    if (history_.empty() || random_() % 4 == 0) a_ = pick_truth();
    if (history_.empty() || random_() % 3 == 0) b_ = pick_truth();
    history_.push_back({time_, a_, b_});
    return history_.back();
  }
  Moment next_number() {
    const std::array<Value, 8> numbers{kUnknown, 0, 1, -1, 999, 1000, kValueMax, kValueMin};
    time_ += 1;
    history_.push_back({time_, 0, numbers[random_() % numbers.size()]});
    return history_.back();
  }
  [[nodiscard]] const History& history() const { return history_; }
  std::uint32_t pick(std::initializer_list<std::uint32_t> values) {
    return *(values.begin() + random_() % values.size());
  }

private:
  Value pick_truth() {
    const auto drawn = random_() % 5;
    return drawn == 0 ? kUnknown : drawn < 3 ? kTrue : kFalse;
  }

  std::mt19937 random_;
  std::uint32_t time_ = 0;
  Value a_ = kUnknown, b_ = kUnknown;
  History history_;
};

// Runs `op` and its model side by side, and counts how often each result came.
void agrees(Op op, unsigned count, bool is_event, std::uint32_t last_epoch = 0xFFFFFF00) {
  std::array<int, 3> seen{};
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    Timeline line(seed);
    const std::uint32_t duration = line.pick({0, 1, 2, 50, 100, 300, 2000});
    const std::uint32_t epoch = line.pick({0, 1000000, 0x7FFFFF00, last_epoch});
    Subject subject(op, static_cast<Value>(duration), count, epoch);
    for (int i = 0; i < 60; ++i) {
      const Moment moment = line.next();
      const Value expected = model(timer_kind_of(op), line.history(), duration, count);
      CAPTURE(seed, i, duration, count, epoch, moment.time);
      REQUIRE(subject.evaluate(moment) == expected);
      REQUIRE(subject.machine.event == (is_event && expected == kTrue));
      if (is_event)
        REQUIRE(subject.sleeps() == (expected == kTrue ? std::optional(1U) : std::nullopt));
      ++seen[expected == kTrue ? 0 : expected == kFalse ? 1 : 2];
    }
  }
  for (const int times : seen)
    CHECK(times > 10);  // or the timelines show nothing
}

}  // namespace

TEST_CASE("FOR: true at every sample for as long") {
  // At the wrap it may be 2 ms late: see FOR wakes.
  agrees(Op::held, 0, false, 0xFFF00000);
}

TEST_CASE("n TIMES WITHIN: rising edges in a sliding window, then from 0") {
  for (const unsigned count : {1U, 2U, 3U, 5U})
    agrees(Op::counted, count, true);
}

TEST_CASE("THEN WITHIN: a rising edge soon enough after another") {
  agrees(Op::sequence, 0, true);
}

TEST_CASE("MARGIN: stays until it is well past") {
  agrees(Op::latch, 0, false);
}

TEST_CASE("BECOMES: true now, known to be false before") {
  agrees(Op::rose, 0, true);
}

TEST_CASE("CHANGES: differs from the value it last was true for") {
  int events = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    Timeline line(seed);
    const auto least = static_cast<Value>(line.pick({0, 1, 2, 1000, 1001, 0x7FFFFFFF}));
    Subject subject(Op::changed, least, 0, 0);
    for (int i = 0; i < 60; ++i) {
      const Moment moment = line.next_number();
      const Value expected =
          model(TimerKind::changed, line.history(), static_cast<std::uint32_t>(least), 0);
      CAPTURE(seed, i, least, moment.b);
      REQUIRE(subject.evaluate(moment) == expected);
      REQUIRE(subject.machine.event == (expected == kTrue));
      events += expected == kTrue ? 1 : 0;
    }
  }
  CHECK(events > 1000);
}

TEST_CASE("FOR wakes at the moment it becomes true, and is true there") {
  for (const std::uint32_t epoch : {0U, 1U, 5000U, 0xFFFFFF9DU, 0xFFFFFFFFU}) {
    CAPTURE(epoch);
    Subject subject(Op::held, 100, 0, epoch);
    CHECK(subject.evaluate({0, 0, kFalse}) == kFalse);
    CHECK(subject.sleeps() == std::nullopt);
    CHECK(subject.evaluate({0, 0, kTrue}) == kFalse);
    const std::uint32_t sleeps = subject.sleeps().value();
    CHECK((sleeps >= 100 && sleeps <= 102));  // later only next to the wrap
    CHECK(subject.evaluate({99, 0, kTrue}) == kFalse);
    CHECK(subject.evaluate({sleeps, 0, kTrue}) == kTrue);
    CHECK(subject.sleeps() == std::nullopt);
    // It stays true, also when the milliseconds have gone all the way round.
    CHECK(subject.evaluate({sleeps + 0x80000000U, 0, kTrue}) == kTrue);
    CHECK(subject.evaluate({sleeps + 0xFFFFFFFFU, 0, kTrue}) == kTrue);
  }
}

TEST_CASE("the ends of a window belong to it") {
  for (const std::uint32_t apart : {100U, 101U}) {
    const Value expected = apart == 100 ? kTrue : kFalse;
    Subject counted(Op::counted, 100, 2, 7);
    CHECK(counted.evaluate({0, 0, kTrue}) == kFalse);
    CHECK(counted.evaluate({1, 0, kFalse}) == kFalse);
    CHECK(counted.evaluate({apart, 0, kTrue}) == expected);
    Subject sequence(Op::sequence, 100, 0, 7);
    CHECK(sequence.evaluate({0, kTrue, kFalse}) == kFalse);
    CHECK(sequence.evaluate({apart, kTrue, kTrue}) == expected);
  }
}

TEST_CASE("a wake that is sooner than the one known counts, a later one does not") {
  Machine machine;
  machine.now = 0xFFFFFFF0;
  wake_at(machine, 20);
  CHECK(machine.wake == 20);
  wake_at(machine, 21);
  CHECK(machine.wake == 20);
  wake_at(machine, 0xFFFFFFF5);
  CHECK(machine.wake == 0xFFFFFFF5);
  machine.wake = Machine::kNever;
  wake_at(machine, Machine::kNever);  // the time that means never is passed over
  CHECK(machine.wake == 0);
}

TEST_CASE("any content of the timer memory is harmless") {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto kind = static_cast<TimerKind>(random() % 6);
    const std::uint8_t count = kind == TimerKind::counted ? 1 + random() % kMaxEdges : 0;
    const Timer timer{kind, count, 0, static_cast<Value>(random() % 1000)};
    std::vector<std::uint32_t> memory(timer_words(timer));  // its end is watched by ASan
    for (std::uint32_t& word : memory)
      word = static_cast<std::uint32_t>(random());
    std::array<Value, 2> frame{random() % 2 == 0 ? kTrue : kFalse, random() % 2 == 0 ? kTrue : 0};
    Machine machine;
    machine.frame = frame.data();
    machine.timers = &timer;
    machine.timer_memory = memory.data();
    machine.now = static_cast<std::uint32_t>(random());
    const Value result = time_word(machine, encode(Op::held, 0, 1, 0));
    REQUIRE((result == kTrue || result == kFalse || result == kUnknown));
  }
}

TEST_CASE("a time is reached from itself on, where the clock wraps as well") {
  CHECK(reached(5, 5));
  CHECK(reached(5, 6));
  CHECK_FALSE(reached(6, 5));
  CHECK(reached(0xFFFFFFFF, 0));
  CHECK_FALSE(reached(0, 0xFFFFFFFF));
}
