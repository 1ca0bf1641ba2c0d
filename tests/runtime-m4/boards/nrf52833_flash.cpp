// See nrf52833_flash.hpp.
#include "tests/runtime-m4/boards/nrf52833_flash.hpp"

#include <algorithm>

namespace robosync::tests {
namespace {

constexpr std::uintptr_t kReady = 0x4001'E400, kConfiguration = 0x4001'E504,
                         kErasePartially = 0x4001'E518, kEraseMs = 0x4001'E51C;
constexpr std::uintptr_t kReceived = 0x4000'2108, kReceive = 0x4000'2518;
constexpr unsigned kEraseTakesMs = 87, kWordUs = 43, kByteUs = 87, kLookUs = 10;

}  // namespace

void Nrf52833Flash::restart() {
  power_for.reset();
  dead_ = false;
  busy_us_ = 0;
  configuration_ = 0;
  erase_ms_ = 10;
}

std::uint32_t& Nrf52833Flash::word_at(std::uintptr_t address) {
  demand(address >= begin_ && address < kEnd && address % 4 == 0, "this is not the store");
  return words_[(address - begin_) / 4];
}

std::uint32_t Nrf52833Flash::read(std::uintptr_t address) {
  if (address == kReady) {
    pass_a_look();
    return busy_us_ == 0 ? 1 : 0;
  }
  if (address == kReceived) return received_;
  if (address == kReceive) {
    demand(!fifo_.empty(), "no byte has come");
    const std::uint8_t byte = fifo_.front();
    fifo_.pop_front();
    received_ = fifo_.empty() ? 0 : 1;
    return byte;
  }
  if (address >= 0x4000'0000) no_register(address);
  demand(busy_us_ == 0, "who reads flash that is at work stands still, and nobody wants that here");
  return word_at(address);
}

void Nrf52833Flash::write(std::uintptr_t address, std::uint32_t value) {
  if (address == kReceived) {
    demand(value == 0, "an event can only be cleared");
    received_ = 0;
  } else if (address == kConfiguration) {
    demand(busy_us_ == 0 || dead_, "the flash is at work");
    configuration_ = value;
  } else if (address == kEraseMs) {
    erase_ms_ = value & 0x7F;
  } else if (address == kErasePartially) {
    erase_partially(value);
  } else if (address < 0x4000'0000) {
    program(address, value);
  } else {
    no_register(address);
  }
}

bool Nrf52833Flash::goes_wrong() {
  if (dead_) return true;
  ++operations;
  if (power_for == 0U) return dead_ = true;
  if (power_for) --*power_for;
  return false;
}

void Nrf52833Flash::work_for(unsigned us) {
  busy_us_ = us;
  longest_us = std::max(longest_us, us);
}

// Until its parts add up to the time for a page, the contents are undefined.
void Nrf52833Flash::erase_partially(std::uint32_t page) {
  demand(configuration_ == 2, "nothing is erased without leave");
  demand(page % kPage == 0, "this is no page");
  demand(busy_us_ == 0, "the flash is at work");
  if (dead_) return;
  goes_wrong();
  const auto first = words_.begin() + (page - begin_) / 4;
  word_at(page);
  unsigned& so_far = pages_[page].erased_ms;
  so_far += dead_ ? 0 : erase_ms_;
  const bool blank = so_far >= kEraseTakesMs;
  if (blank)
    std::fill_n(first, kPage / 4, ~0U);
  else if (dead_ || so_far == erase_ms_)
    std::generate_n(first, kPage / 4, [&] { return static_cast<std::uint32_t>(random_()); });
  if (dead_) return;
  work_for(erase_ms_ * 1090);
  if (!blank || so_far - erase_ms_ >= kEraseTakesMs) return;
  ++erased[page];
  std::erase_if(written_, [&](const auto& one) { return one.first / kPage == page / kPage; });
}

void Nrf52833Flash::program(std::uintptr_t address, std::uint32_t value) {
  demand(configuration_ == 1, "nothing is written without leave");
  demand(busy_us_ == 0, "the flash is at work");
  std::uint32_t& word = word_at(address);
  if (dead_) return;
  pages_[static_cast<std::uint32_t>(address / kPage * kPage)].erased_ms = 0;
  demand(++written_[address] <= 2, "a word bears two writes until it is erased");
  word &= goes_wrong() ? value | static_cast<std::uint32_t>(random_()) : value;
  work_for(dead_ ? 0 : kWordUs);
}

void Nrf52833Flash::pass_a_look() {
  busy_us_ -= std::min(busy_us_, kLookUs);
  next_byte_us_ += kLookUs;
  if (line.empty() || next_byte_us_ < kByteUs) return;
  next_byte_us_ -= kByteUs;
  if (fifo_.size() < kFifo) {
    fifo_.push_back(line.front());
  } else {
    ++lost;
  }
  line.pop_front();
  received_ = 1;
}

}  // namespace robosync::tests
