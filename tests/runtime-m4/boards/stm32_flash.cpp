// See stm32_flash.hpp.
#include "tests/runtime-m4/boards/stm32_flash.hpp"

namespace robosync::tests {
namespace {

constexpr std::uintptr_t kAccess = 0x4002'2000, kKey = 0x4002'2008, kStatus = 0x4002'2010,
                         kControl = 0x4002'2014, kDamage = 0x4002'2018;
constexpr std::uint32_t kDataCache = 1U << 10, kResetDataCache = 1U << 12;
constexpr std::uint32_t kProgrammingError = 1U << 3, kSequenceError = 1U << 7, kBusy = 1U << 16;
constexpr std::uint32_t kProgram = 1U << 0, kErase = 1U << 1, kBank2 = 1U << 11, kStart = 1U << 16,
                        kOptionLock = 1U << 30, kLock = 1U << 31;
constexpr std::uint32_t kDamaged = 1U << 31, kDamageInBank2 = 1U << 19;
constexpr unsigned kEraseUs = 24'470, kPairUs = 91;

}  // namespace

void Stm32Flash::restart() {
  power_for.reset();
  dead_ = false;
  busy_us_ = 0;
  access_ = 0x704;
  status_ = 0;
  control_ = kLock | kOptionLock;
  damage_ = 0;
  keys_ = 0;
  low_.reset();
  cache_is_stale_ = false;
}

std::uint32_t Stm32Flash::read(std::uintptr_t address) {
  if (!answers && address >= 0x4000'0000) return 0;
  switch (address) {
    case kAccess:
      return access_;
    case kStatus:
      pass_us(1);
      return status_ | (is_busy() ? kBusy : 0);
    case kControl:
      demand(!is_busy(), "whether this read waits for the end of the operation is not specified");
      return control_ & ~kStart;
    case kDamage:
      return damage_;
    default:
      if (address >= 0x4000'0000) no_register(address);
      return read_word(address);
  }
}

void Stm32Flash::write(std::uintptr_t address, std::uint32_t value) {
  if (!answers) return;
  switch (address) {
    case kAccess:
      return write_access(value);
    case kKey:
      demand((control_ & kLock) != 0, "it is not locked");
      demand(value == (keys_ == 0 ? 0x4567'0123 : 0xCDEF'89AB), "a wrong key locks it for good");
      if (++keys_ == 2) control_ &= ~kLock;
      return;
    case kStatus:
      status_ &= ~value;
      return;
    case kControl:
      return write_control(value);
    case kDamage:
      if ((value & kDamaged) != 0) damage_ = 0;
      return;
    default:
      if (address >= 0x4000'0000) no_register(address);
      program(address, value);
  }
}

void Stm32Flash::write_access(std::uint32_t value) {
  if ((value & kResetDataCache) != 0) {
    demand((value & kDataCache) == 0, "the cache is only emptied while it is off");
    cache_is_stale_ = false;
  }
  access_ = value;
}

void Stm32Flash::write_control(std::uint32_t value) {
  demand((control_ & kLock) == 0, "it is locked");
  demand(!is_busy(), "the flash is at work");
  control_ = value | (control_ & kOptionLock);  // software can only set it: RM0351, 3.7.6
  if ((value & kLock) != 0) keys_ = 0;
  if ((value & kStart) != 0) erase();
}

bool Stm32Flash::goes_wrong() {
  if (dead_) return true;
  ++operations;
  if (power_for == 0U) return dead_ = true;
  if (power_for) --*power_for;
  return false;
}

void Stm32Flash::erase() {
  demand((control_ & kErase) != 0 && (control_ & kProgram) == 0 && (control_ & kBank2) != 0,
         "only pages of the second bank");
  demand((access_ & kDataCache) == 0, "what the cache has goes wrong (ES0250)");
  if (dead_) return;
  const std::size_t page = control_ >> 3 & 0xFF, each = kPage / 8;
  demand((page + 1) * each <= pairs_.size(), "this is not the store");
  const bool wrong = goes_wrong();
  for (std::size_t i = page * each; i < (page + 1) * each; ++i)
    pairs_[i] = wrong ? Pair{static_cast<std::uint32_t>(random_()),
                             static_cast<std::uint32_t>(random_()), random_() % 2 == 0}
                      : Pair{};
  cache_is_stale_ = true;
  if (wrong) return;
  ++erased[static_cast<std::uint32_t>(page)];
  busy_us_ = kEraseUs;
}

void Stm32Flash::program(std::uintptr_t address, std::uint32_t value) {
  demand(!is_busy(), "the flash is at work");
  demand((control_ & kProgram) != 0 && (control_ & kLock) == 0, "nothing is written without leave");
  demand((access_ & kDataCache) == 0, "what the cache has goes wrong (ES0250)");
  if (!low_) {
    demand(address % 8 == 0, "two words begin where two words do");
    low_ = value;
    low_at_ = address;
    return;
  }
  demand(address == low_at_ + 4, "the second word belongs to the first");
  Pair& pair = pairs_.at((low_at_ - kBegin) / 8);
  const std::uint32_t low = *low_;
  low_.reset();
  if (dead_) return;
  if (status_ != 0) {
    status_ |= kSequenceError;
  } else if (!pair.blank()) {
    status_ |= kProgrammingError;
  } else if (goes_wrong()) {
    pair = {low | static_cast<std::uint32_t>(random_()), value, random_() % 2 == 0};
  } else {
    pair = {low, value, false};
    busy_us_ = kPairUs;
  }
  cache_is_stale_ = true;
}

std::uint32_t Stm32Flash::read_word(std::uintptr_t address) {
  demand(address >= kBegin && address % 4 == 0, "this is not the store");
  demand(!is_busy(), "who reads a bank that is at work waits for it");
  demand((access_ & kDataCache) == 0 || !cache_is_stale_, "the cache has what stood there before");
  const Pair& pair = pairs_.at((address - kBegin) / 8);
  if (pair.damaged) {
    demand(damage_ == 0, "the damage before was not forgotten");
    damage_ = kDamaged | (of_bank_1 ? 0 : kDamageInBank2) | ((address - kBegin) & 0x7'FFF8);
    ++nmis;
    if (nmi) nmi();
    return static_cast<std::uint32_t>(random_());
  }
  return address % 8 == 0 ? pair.low : pair.high;
}

}  // namespace robosync::tests
