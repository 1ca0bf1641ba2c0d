// The boards' shipped stores in their own flash, against models of the flash: the power is cut at every word that is written, and
// at every part of an erase.
#include "runtime-m4/boards/stm32l4/flash.hpp"

#include <catch2/catch.hpp>

#include "runtime-m4/boards/common/flash_store.hpp"
#include "runtime-m4/boards/microbit-v2/flash.hpp"
#include "runtime-m4/boards/microbit-v2/uart.hpp"
#include "runtime-m4/update/keeper.hpp"
#include "runtime-m4/update/key_store.hpp"
#include "runtime-m4/update/number_store.hpp"
#include "runtime-m4/update/program_store.hpp"
#include "tests/runtime-m4/boards/nrf52833_flash.hpp"
#include "tests/runtime-m4/boards/stm32_flash.hpp"
#include "vm/identity.hpp"

using namespace robosync;
using boards::Store;
using layers::KeptNumber;
using update::KeyStore;
using update::NumberStore;
using update::ProgramStore;
using update::Work;

namespace {

using Bytes = std::vector<std::byte>;
using Numbers = std::vector<KeptNumber>;
constexpr std::uint32_t kPages = 12;  // four of them for numbers

struct MicrobitFlash {
  tests::Nrf52833Flash chip{kPages * tests::Nrf52833Flash::kPage};
  boards::FlashStore<boards::microbit::Flash> store{chip.begin(), chip.bytes()};
  void rest() {}
};

struct L475Flash {
  tests::Stm32Flash chip{kPages * tests::Stm32Flash::kPage};
  boards::FlashStore<boards::stm32l4::Flash> store{chip.kBegin, chip.bytes()};
  bool forgiven = true;
  L475Flash() {
    chip.nmi = [this] { forgiven = forgiven && boards::stm32l4::Flash::forgive_damage(); };
  }
  void rest() { chip.pass_ms(1); }
};

std::uint32_t beginning(const MicrobitFlash& flash) {
  return flash.chip.begin();
}
std::uint32_t beginning(const L475Flash& flash) {
  return flash.chip.kBegin;
}

// Completes the request of a ProgramStore or NumberStore. Bounded.
template <typename Flash, typename Kept>
void finish(Flash& flash, Kept& store) {
  for (unsigned i = 0; i < 10'000; ++i) {
    const Work work = store.work();
    if (work == Work::none || work == Work::ended) return;
    if (work == Work::rests || work == Work::waits) flash.rest();
  }
  FAIL("the store comes to no end");
}

// After power-up: the contents of RAM are lost.
template <typename Kept, typename Flash>
Kept opened(Flash& flash) {
  flash.chip.restart();
  flash.store = decltype(flash.store)(beginning(flash), flash.store.size());
  Kept store(&flash.store);
  store.open();
  finish(flash, store);
  return store;
}

Bytes some_image(unsigned seed, std::size_t size) {
  Bytes image(size);
  std::mt19937 random(seed);
  std::generate(image.begin(), image.end(), [&] { return static_cast<std::byte>(random()); });
  return image;
}

ProgramStore::Program named(const Bytes& image) {
  return {static_cast<std::uint32_t>(image.size()), vm::name_of(vm::Identity().finish(image))};
}

template <typename Flash>
void keep(Flash& flash, ProgramStore& store, const Bytes& image) {
  store.write(image, named(image));
  finish(flash, store);
  if (store.written() != named(image)) return;
  store.keep_written();
  finish(flash, store);
}

template <typename Flash>
Bytes kept(Flash& flash, ProgramStore& store) {
  Bytes room(flash.store.size());
  store.read_kept(room);
  finish(flash, store);
  return {store.image().begin(), store.image().end()};
}

Numbers some_numbers(unsigned seed) {
  std::mt19937 random(seed);
  Numbers numbers(vm::kMaxKept);
  for (KeptNumber& number : numbers)
    number = {static_cast<std::uint32_t>(random()), static_cast<vm::Value>(random() % 100'000)};
  return numbers;
}

template <typename Flash>
void write(Flash& flash, NumberStore& store, unsigned seed) {
  store.write(some_numbers(seed));
  finish(flash, store);
}

template <typename Flash>
Numbers numbers(Flash& flash) {
  const auto store = opened<NumberStore>(flash);
  return {store.numbers().begin(), store.numbers().end()};
}

}  // namespace

TEMPLATE_TEST_CASE(
    "flash: a cut of the power at every word leaves the program of before, or the new one", "",
    MicrobitFlash, L475Flash) {
  const Bytes first = some_image(1, 4000), second = some_image(2, 400), third = some_image(3, 160);
  const auto begin = [&](TestType& flash) {
    auto store = opened<ProgramStore>(flash);
    keep(flash, store, first);
    keep(flash, store, second);
    flash.chip.operations = 0;
  };
  unsigned operations = 0;
  for (unsigned cut = 0; cut <= operations; ++cut) {
    CAPTURE(cut);
    TestType flash;
    begin(flash);
    auto store = opened<ProgramStore>(flash);
    if (operations != 0) flash.chip.power_for = cut;
    keep(flash, store, third);
    if (operations == 0) operations = flash.chip.operations;
    const bool whole = cut == operations || store.kept() == named(third);
    auto again = opened<ProgramStore>(flash);
    REQUIRE(again.kept() == named(whole ? third : second));
    REQUIRE(kept(flash, again) == (whole ? third : second));
    keep(flash, again, second);  // and it works again
    auto last = opened<ProgramStore>(flash);
    REQUIRE(kept(flash, last) == second);
  }
  CHECK(operations > 20);
}

TEMPLATE_TEST_CASE(
    "flash: a cut of the power at every word leaves the numbers of before, or the new ones", "",
    MicrobitFlash, L475Flash) {
  // The last place of a page, and the first one of the next, which is erased first.
  const unsigned together = TestType().store.page() / update::StoreLayout::kNumbersBytes;
  for (const unsigned before : {together - 2, together - 1}) {
    unsigned operations = 0;
    for (unsigned cut = 0; cut <= operations; ++cut) {
      CAPTURE(before, cut);
      TestType flash;
      auto store = opened<NumberStore>(flash);
      for (unsigned i = 0; i < before; ++i)
        write(flash, store, i);
      flash.chip.operations = 0;
      if (operations != 0) flash.chip.power_for = cut;
      write(flash, store, 77);
      if (operations == 0) operations = flash.chip.operations;
      const Numbers now = numbers(flash);
      REQUIRE((now == some_numbers(before - 1) || now == some_numbers(77)));
      if (cut == operations) REQUIRE(now == some_numbers(77));
      auto again = opened<NumberStore>(flash);
      for (unsigned i = 0; i < 3; ++i)  // a spoiled place is skipped
        write(flash, again, 100 + i);
      REQUIRE(numbers(flash) == some_numbers(102));
    }
    CHECK(operations > 15);
  }
}

TEMPLATE_TEST_CASE("flash: numbers wear the pages of their ring evenly, and no others", "",
                   MicrobitFlash, L475Flash) {
  TestType flash;
  auto store = opened<NumberStore>(flash);
  constexpr unsigned kRing = kPages / 3, kTurns = 3;
  const unsigned together = flash.store.page() / update::StoreLayout::kNumbersBytes;
  for (unsigned i = 1; i <= kTurns * kRing * together; ++i)
    write(flash, store, i);
  CHECK(flash.chip.erased.size() == kRing);
  for (const auto& [page, times] : flash.chip.erased)
    CHECK(times == kTurns);
  CHECK(numbers(flash) == some_numbers(kTurns * kRing * together));
}

TEMPLATE_TEST_CASE("flash: a write that is given up for another one spoils neither", "",
                   MicrobitFlash, L475Flash) {
  const Bytes first = some_image(1, 4000), second = some_image(2, 3000);
  for (unsigned works = 0; works < 100; ++works) {
    CAPTURE(works);
    TestType flash;
    auto programs = opened<ProgramStore>(flash);
    NumberStore numbers_there(&flash.store);
    numbers_there.open();
    finish(flash, numbers_there);
    programs.write(first, named(first));
    for (unsigned i = 0; i < works; ++i)
      if (const Work work = programs.work();
          (work == Work::rests || work == Work::waits) && i + 1 < works)
        flash.rest();
    programs.give_up();
    write(flash, numbers_there, 5);
    keep(flash, programs, second);
    CHECK(kept(flash, programs) == second);
    CHECK(numbers(flash) == some_numbers(5));
  }
}

TEST_CASE(
    "micro:bit: while the flash is erased nobody waits for more than 2.2 ms, and no byte of the "
    "line is lost") {
  MicrobitFlash flash;
  Bytes heard;
  for (unsigned i = 0; i < 4000; ++i)
    flash.chip.line.push_back(static_cast<std::uint8_t>(i % 251));
  const auto hear = [&] {
    while (boards::microbit::Uart::has_received())
      heard.push_back(boards::microbit::Uart::receive());
  };
  const Bytes piece = some_image(1, 16);
  for (const std::uint32_t page : {0U, 4096U, 8192U})
    while (flash.store.write(page, piece) == Store::Outcome::goes_on)
      hear();
  hear();
  CHECK(flash.chip.erased.size() == 3);
  CHECK(flash.chip.longest_us == 2180);
  CHECK(flash.chip.lost == 0);
  REQUIRE(heard.size() > 3000);
  for (std::size_t i = 0; i < heard.size(); ++i)
    REQUIRE(heard[i] == static_cast<std::byte>(i % 251));
}

TEST_CASE("B-L475E-IOT01A: damage in the flash is forgiven where the store is, and nowhere else") {
  L475Flash flash;
  Bytes piece(16);
  CHECK(flash.store.read(0, piece) == Store::Outcome::done);
  CHECK(flash.chip.nmis == 0);
  CHECK_FALSE(boards::stm32l4::Flash::forgive_damage());
  flash.chip.damage(flash.chip.kBegin + 8);
  CHECK(flash.store.read(0, piece) == Store::Outcome::done);
  CHECK(flash.chip.nmis == 2);
  CHECK(flash.forgiven);
  flash.chip.of_bank_1 = true;
  flash.chip.nmi = [&] { flash.forgiven = boards::stm32l4::Flash::forgive_damage(); };
  CHECK_THROWS(flash.store.read(0, piece));
  CHECK_FALSE(flash.forgiven);
}

namespace {

link::Pair some_owner(std::uint8_t seed) {
  link::Pair owner{};
  owner.key.fill(seed);
  owner.seed.fill(seed);
  return owner;
}

void write(L475Flash& flash, KeyStore& keys, std::uint8_t owner) {
  keys.write(true, some_owner(owner));
  finish(flash, keys);
}

std::uint8_t owner_in(L475Flash& flash) {
  const auto keys = opened<KeyStore>(flash);
  CHECK(keys.there());
  return keys.record().paired == 0 ? std::uint8_t{0} : keys.record().owner.seed[0];
}

// The store's answer to the last call. Calls come `us` apart; at most `calls` of them.
Store::Outcome outcome_of_write(L475Flash& flash, unsigned us, unsigned& calls) {
  const Bytes piece = some_image(1, Store::kPiece);
  Store::Outcome outcome = Store::Outcome::at_work;
  for (const unsigned most = std::exchange(calls, 0);
       outcome == Store::Outcome::at_work && calls < most; ++calls) {
    outcome = flash.store.write(0, piece);
    flash.chip.pass_us(us);
  }
  return outcome;
}

}  // namespace

TEST_CASE(
    "B-L475E-IOT01A: a cut of the power at every word leaves the owner of before, or the new one") {
  for (unsigned cut = 0, operations = 0; cut <= operations; ++cut) {
    CAPTURE(cut);
    L475Flash flash;
    auto keys = opened<KeyStore>(flash);
    write(flash, keys, 1);
    write(flash, keys, 2);
    flash.chip.operations = 0;
    if (operations != 0) flash.chip.power_for = cut;
    write(flash, keys, 3);
    if (operations == 0) operations = flash.chip.operations;
    CHECK(operations == 9);  // its page, and eight times two words
    REQUIRE(owner_in(flash) == (cut == operations || keys.written() ? 3 : 2));
    auto again = opened<KeyStore>(flash);
    write(flash, again, 4);
    REQUIRE(owner_in(flash) == 4);
  }
}

TEST_CASE("B-L475E-IOT01A: who erases lets nobody wait, however often he is asked meanwhile") {
  // As often as bytes on the line in both directions allow, and as rarely as the link thread runs.
  for (const unsigned us : {43U, 1000U, 30'000U}) {
    CAPTURE(us);
    L475Flash flash;
    unsigned calls = 1000;
    CHECK(outcome_of_write(flash, us, calls) == Store::Outcome::done);
    CHECK(calls >= 4);
    CHECK(flash.chip.erased.size() == 1);
  }
}

TEST_CASE("B-L475E-IOT01A: a flash that does nothing, or never ends, is a store that is spent") {
  L475Flash flash;
  Bytes piece(Store::kPiece);
  unsigned calls = 10;
  SECTION("its registers are not there") {
    flash.chip.answers = false;
    CHECK(outcome_of_write(flash, 1000, calls) == Store::Outcome::spent);
    CHECK(calls == 2);
    CHECK(flash.store.read(0, piece) == Store::Outcome::done);
    flash.chip.answers = true;
    calls = 100;
    CHECK(outcome_of_write(flash, 1000, calls) == Store::Outcome::done);
  }
  SECTION("it is at work for ever") {
    flash.chip.stuck = true;
    calls = 1100;
    CHECK(outcome_of_write(flash, 1000, calls) == Store::Outcome::spent);
    CHECK(calls > 900);
    for (calls = 0; calls < 1100; ++calls)
      if (flash.store.read(0, piece) == Store::Outcome::spent) break;
    CHECK(calls < 1000);
    flash.chip.stuck = false;
    flash.chip.pass_ms(25);
    CHECK(flash.store.read(0, piece) == Store::Outcome::done);
    calls = 100;
    CHECK(outcome_of_write(flash, 1000, calls) == Store::Outcome::done);
  }
}
