// See flash.hpp. ST's RM0351, 3.3.5 to 3.3.8; DS10969: a page is erased in 25 ms at most, two words are written in 91 us.
// ES0250: while one bank is written, the data cache may load wrong data from the other one. So it is off during that time, and
// emptied afterwards.
#include "runtime-m4/boards/stm32l4/flash.hpp"

#include "runtime-m4/boards/stm32l4/registers.hpp"

namespace robosync::boards::stm32l4 {

namespace {

// A call comes every millisecond or, with bytes on the line in both directions, every 43 us: in all, longer than a page takes.
constexpr unsigned kMostCalls = 1000;
constexpr unsigned kMostLooks = 100'000;  // more than 5 ms at 80 MHz

bool is_ordered(std::uint32_t what) {
  return (flash::kControl.read() & flash::kOrder) == what;
}

void begin(std::uint32_t what) {
  flash::kAccess.clear(flash::kDataCache);
  if (flash::kControl.has(flash::kLock)) {
    flash::kKey.write(flash::kFirstKey);
    flash::kKey.write(flash::kSecondKey);
  }
  flash::kStatus.write(flash::kErrors);
  flash::kControl.write(what);
}

void end() {
  flash::kControl.write(flash::kLock);
  flash::kAccess.set(flash::kEmptyDataCache);
  flash::kAccess.clear(flash::kEmptyDataCache);
  flash::kAccess.set(flash::kDataCache);
}

}  // namespace

bool Flash::is_busy() {
  return flash::kStatus.has(flash::kBusy);
}

Erasing Flash::erase(std::uint32_t page, unsigned call) {
  if (call == kMostCalls) return Erasing::failed;
  if (is_busy()) return Erasing::goes_on;
  const std::uint32_t which =
      flash::kErasePage | flash::page_of_bank_2((page - flash::kBank2) / kPage);
  if (is_ordered(which)) {  // this page, not an erase of another page that was given up
    end();
    return Erasing::done;
  }
  begin(which);
  if (!is_ordered(which)) {  // in an emulator, or if the flash is locked until the next reset
    end();
    return Erasing::failed;
  }
  flash::kControl.write(which | flash::kStart);  // not read again before it is done: that may stall
  return Erasing::goes_on;
}

// Waits while two words are written, in the thread of the lowest rank.
void Flash::program(std::uint32_t at, std::span<const std::uint32_t, kUnit> words) {
  begin(flash::kProgram);
  {
    const port::Unprotected flash_is_open;
    port::Register{at}.write(words[0]);
    port::Register{at + sizeof words[0]}.write(words[1]);
  }
  for (unsigned i = 0; i < kMostLooks && is_busy(); ++i) {
  }
  end();
}

bool Flash::forgive_damage() {
  const std::uint32_t damage = flash::kDamage.read();
  if ((damage & flash::kDamaged) == 0 || (damage & flash::kInBank2) == 0) return false;
  flash::kDamage.write(flash::kDamaged);
  return true;
}

}  // namespace robosync::boards::stm32l4
