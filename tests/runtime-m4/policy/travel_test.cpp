// A movement that goes by encoders: its end at the nearest edge, what each wheel gets meanwhile, and when it is given up.
#include "runtime-m4/policy/travel.hpp"

#include <catch2/catch.hpp>
#include <rapidcheck.h>

using namespace robosync;
using policy::EncoderCounts;
using policy::Travel;
using State = policy::Travel::State;

namespace {

// 40 edges are a turn of 204.2 mm: an edge is 5.105 mm.
constexpr vm::WheelEncoder kEncoder{
    .above = 204'200, .below = 40, .number = 0, .knows_direction = true};
constexpr vm::Value kSpeed = 200 * vm::kScale;  // an edge takes 25.525 ms

struct Journey {
  explicit Journey(std::int64_t way, std::array<bool, 2> back = {}, EncoderCounts from = {},
                   vm::Value speed = kSpeed)
      : begin(from) {
    travel.begin({kEncoder, kEncoder}, from, back, way, speed, now_ms);
  }
  State look(std::int32_t left, std::int32_t right, std::uint32_t after_ms = 20) {
    now_ms += after_ms;
    return travel.look({after(0, left), after(1, right)}, now_ms);
  }
  policy::EncoderCount after(std::size_t side, std::int32_t edges) const {
    const auto sum =
        static_cast<std::uint32_t>(begin[side].edges) + static_cast<std::uint32_t>(edges);
    return {.edges = static_cast<std::int32_t>(sum),
            .losses = static_cast<std::uint8_t>(begin[side].losses + lost[side])};
  }
  std::uint32_t next() const { return travel.next_look_ms(now_ms); }
  std::array<std::int32_t, 2> shares() const {
    return {travel.share(vm::Side::left), travel.share(vm::Side::right)};
  }
  EncoderCounts begin;
  std::array<unsigned, 2> lost{};
  std::uint32_t now_ms = UINT32_MAX - 100;  // the time wraps
  Travel travel;
};

using Shares = std::array<std::int32_t, 2>;

}  // namespace

TEST_CASE("travel: it ends at the edge nearest to its target, each wheel by itself") {
  // 19 edges are 96.995 mm, 20 are 102.1 mm.
  for (const auto& [way, edges] :
       {std::pair{99'547, 19}, {99'548, 20}, {104'652, 20}, {104'653, 21}}) {
    INFO(way);
    Journey journey(way);
    CHECK(journey.look(edges - 1, edges - 1) == State::going);
    CHECK(journey.look(edges, edges - 1) == State::going);
    CHECK(journey.shares() == Shares{0, 100});
    CHECK(journey.look(edges, edges) == State::arrived);
    CHECK(journey.travel.way() == edges * 204'200LL / 40);
  }
  Journey nowhere(2'552);
  CHECK(nowhere.look(0, 0) == State::arrived);
  Journey further(1'000);
  CHECK(further.look(5, 7) == State::arrived);
}

TEST_CASE("travel: its wheels may count backward, from any count on") {
  Journey turn(51'050, {true, false}, {{{-7, 200}, {INT32_MAX - 3, 3}}});
  CHECK(turn.look(-9, 9) == State::going);
  CHECK(turn.look(9, 9) == State::going);  // the wrong way
  CHECK(turn.shares() == Shares{100, 100});
  CHECK(turn.look(-10, 10) == State::arrived);
}

TEST_CASE("travel: the wheel that is ahead gets less, 1 % for a quarter of a millimetre") {
  Journey journey(1'000'000);
  CHECK(journey.look(3, 3) == State::going);
  CHECK(journey.shares() == Shares{100, 100});
  CHECK(journey.look(4, 3) == State::going);  // 5.105 mm: 20.4 quarters
  CHECK(journey.shares() == Shares{80, 100});
  CHECK(journey.look(4, 5) == State::going);
  CHECK(journey.shares() == Shares{100, 80});
  CHECK(journey.look(9, 5) == State::going);
  CHECK(journey.shares() == Shares{75, 100});  // no less
}

TEST_CASE("travel: a wheel that should turn and gives no edge blocks it, after its patience") {
  // Half a second, and four edges of 25 ms.
  for (const bool left : {true, false}) {
    Journey journey(102'100);
    CHECK(journey.look(2, 2) == State::going);
    CHECK(journey.look(left ? 2 : 3, left ? 3 : 2, 600) == State::going);
    CHECK(journey.look(left ? 2 : 4, left ? 4 : 2, 1) == State::blocked);
  }
  Journey slow(102'100, {}, {}, kSpeed / 20);  // 510 ms for an edge
  CHECK(slow.look(0, 0, 2540) == State::going);
  CHECK(slow.look(0, 0, 1) == State::blocked);
  Journey arrived(10'210);
  CHECK(arrived.look(2, 0, 400) == State::going);
  for (unsigned i = 0; i < 5; ++i)
    CHECK(arrived.look(2, i % 2 == 0 ? 1 : 0, 200) == (i < 4 ? State::going : State::blocked));
}

TEST_CASE("travel: a wheel that rocks or goes the wrong way is blocked, too") {
  Journey rocks(102'100);
  CHECK(rocks.look(2, 2) == State::going);
  for (unsigned i = 0; i < 5; ++i)
    CHECK(rocks.look(i % 2 == 0 ? 1 : 2, 3 + static_cast<std::int32_t>(i), 120) == State::going);
  CHECK(rocks.look(1, 9, 120) == State::blocked);
  Journey wrong(102'100);
  CHECK(wrong.look(-3, 3, 600) == State::going);
  CHECK(wrong.look(-4, 4, 1) == State::blocked);
}

TEST_CASE("travel: lost edges block it at once, also those of a wheel that has arrived") {
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    Journey journey(10'210, {}, {{{0, 255}, {0, 255}}});
    CHECK(journey.look(2, 1) == State::going);
    journey.lost[side] = 1;
    CHECK(journey.look(2, 2) == State::blocked);
  }
}

TEST_CASE("travel: without a target it goes on, and is trimmed and watched") {
  Journey journey(Travel::kNoTarget);
  CHECK(journey.look(1'000'000, 1'000'001) == State::going);
  CHECK(journey.shares() == Shares{100, 80});
  CHECK(journey.look(1'000'000, 1'000'002, 602) == State::blocked);
}

TEST_CASE(
    "travel: it is looked at before the first wheel may arrive, but not too often or rarely") {
  // 25.5 ms for an edge, which was seen up to 20 ms late.
  Journey journey(20 * 5105);
  CHECK(journey.next() == 20);
  journey.look(18, 10);
  CHECK(journey.next() == 20);
  journey.look(19, 10);
  CHECK(journey.next() == 6);
  journey.look(19, 10, 6);
  CHECK(journey.next() == 5);
  journey.look(19, 11, 300);  // it is slower
  CHECK(journey.next() == 5);
  journey.look(20, 11);
  CHECK(journey.next() == 20);
  Journey right(20 * 5105);
  right.look(10, 19);
  CHECK(right.next() == 6);
  Journey fast(20 * 5105, {}, {}, 20 * kSpeed);  // 1.3 ms for an edge
  CHECK(fast.next() == 6);
  fast.look(1, 1);
  CHECK(fast.next() == 5);
}

TEST_CASE("travel: whatever encoders give, numbers stay in range, and silence ends it") {
  const bool holds = rc::check("travel", [] {
    const auto any = [] { return *rc::gen::inRange<std::int32_t>(1, INT32_MAX); };
    const auto encoder = [&] {
      return vm::WheelEncoder{
          .above = *rc::gen::oneOf(rc::gen::inRange<std::int32_t>(1, 5),
                                   rc::gen::inRange<std::int32_t>(1, INT32_MAX)),
          .below = *rc::gen::inRange<std::uint16_t>(1, UINT16_MAX),
          .number = 0,
          .knows_direction = true};
    };
    const auto count = [] {
      return policy::EncoderCount{.edges = *rc::gen::arbitrary<std::int32_t>(), .losses = 0};
    };
    Travel travel;
    travel.begin({encoder(), encoder()}, {count(), count()},
                 {*rc::gen::arbitrary<bool>(), *rc::gen::arbitrary<bool>()}, any(), any(), 0);
    std::uint32_t now = 0;
    State state = State::going;
    EncoderCounts counts{};
    for (unsigned i = 0; i < 20 && state == State::going; ++i) {
      const std::uint32_t wait = travel.next_look_ms(now);
      RC_ASSERT(wait >= policy::kShortestLookMs);
      RC_ASSERT(wait <= policy::kLongestLookMs);
      now += wait;
      counts = {count(), count()};
      state = travel.look(counts, now);
      for (const vm::Side side : vm::kSides) {
        RC_ASSERT(travel.share(side) >= 0);
        RC_ASSERT(travel.share(side) <= 100);
      }
      RC_ASSERT(travel.way() >= 0);
    }
    if (state == State::going) state = travel.look(counts, now + 20'000'000);
    RC_ASSERT(state != State::going);
  });
  CHECK(holds);
}
