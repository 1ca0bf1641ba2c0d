// The shipped code for the speaker of the micro:bit V2, against the model of the chip: what its pin does over time.
#include <cmath>

#include <catch2/catch.hpp>

#include "runtime-m4/boards/microbit-v2/speaker.hpp"
#include "tests/runtime-m4/boards/nrf52833.hpp"

using namespace robosync;
using tests::Nrf52833;
namespace speaker = boards::microbit::speaker;

namespace {

constexpr Nrf52833::Pin kSpeaker{0, 0};  // tech.microbit.org, schematic of the V2

struct Sounding : Nrf52833 {
  explicit Sounding(Fetch fetch) : Nrf52833(fetch) { speaker::start(); }
  // Rising edges, and how long it is high, in microseconds.
  struct Heard {
    unsigned edges = 0, high = 0;
  };
  Heard listen(unsigned microseconds) {
    Heard heard;
    bool before = level(kSpeaker) == Level::high;
    for (; microseconds > 0; --microseconds) {
      pass_microsecond();
      const bool now = level(kSpeaker) == Level::high;
      heard.edges += now && !before ? 1U : 0U;
      heard.high += now ? 1U : 0U;
      before = now;
    }
    return heard;
  }
};

}  // namespace

TEMPLATE_TEST_CASE_SIG("the speaker gives the tone that it is told, evenly, and none before", "",
                       ((Nrf52833::Fetch fetch), fetch), Nrf52833::Fetch::early,
                       Nrf52833::Fetch::late) {
  Sounding chip(fetch);
  CHECK(chip.level(kSpeaker) == Nrf52833::Level::low);
  CHECK(chip.configuration_of(kSpeaker) >> 8 == 3);  // H0H1, as CODAL drives it
  CHECK(chip.listen(50'000).high == 0);
  for (const unsigned hertz : {31U, 262U, 440U, 1000U, 1760U, 9999U}) {
    speaker::sound(hertz);
    chip.listen(100'000);  // the longest period before, and one more
    const auto heard = chip.listen(1'000'000);
    CHECK(std::abs(static_cast<double>(heard.edges) - hertz) <= 1 + hertz * hertz / 1e6);
    CHECK(std::abs(heard.high - 500'000.0) <= 20'000);
  }
}

TEST_CASE("the speaker is silent at once, for good, and begins again") {
  Sounding chip(Nrf52833::Fetch::late);
  for (unsigned after = 100'000; after < 100'900; after += 100) {
    speaker::sound(1000);
    CHECK(chip.listen(after).edges > 30);
    speaker::sound(0);
    CHECK(chip.level(kSpeaker) == Nrf52833::Level::low);
    CHECK(chip.listen(20'000).high == 0);
  }
}

TEST_CASE("the speaker takes any number for a tone") {
  Sounding chip(Nrf52833::Fetch::late);
  for (const std::uint32_t hertz : {1U, 250'000U, 1'000'000U, 4'000'000'000U}) {
    speaker::sound(hertz);
    CHECK(chip.listen(200'000).edges > 1);
  }
}
