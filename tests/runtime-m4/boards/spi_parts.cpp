// See spi_parts.hpp.
#include "tests/runtime-m4/boards/spi_parts.hpp"

#include <utility>

namespace robosync::tests {
namespace {

constexpr std::uintptr_t kSpim3 = 0x4002'F000, kUarte1 = 0x4002'8000;
constexpr std::uintptr_t kSpi1 = 0x4001'3000, kDma1 = 0x4002'0000;
constexpr std::uintptr_t kApb2Resets = 0x4002'1040, kAhb1 = 0x4002'1048, kApb2 = 0x4002'1060;
constexpr std::uint32_t kSpi1Bit = 1U << 12;

// The edge connector's outputs, and its pin for an enable input.
const std::map<unsigned, Nrf52833::Pin> kSelects{
    {16, {1, 2}}, {0, {0, 2}}, {1, {0, 3}}, {2, {0, 4}}, {12, {0, 12}}};

}  // namespace

// Nothing drives the input where no part is selected: it is pulled up.
std::uint8_t SpiParts::exchange(std::uint8_t out, const std::vector<unsigned>& selected) {
  demand(selected.size() <= 1, "two parts are selected");
  if (selected.empty()) {
    release();
    return 0xFF;
  }
  if (!std::exchange(goes_on_, true)) heard.push_back({selected.front(), {}});
  Heard& now = heard.back();
  demand(now.select == selected.front(), "another part is selected during a transfer");
  now.bytes.push_back(out);
  const auto part = answers.find(now.select);
  if (part == answers.end()) return 0xFF;
  const auto answer = part->second.find(now.bytes.front());
  const std::size_t place = now.bytes.size() - 2;
  const bool answered = now.bytes.size() > 1 && answer != part->second.end();
  return answered && place < answer->second.size() ? answer->second[place] : 0xFF;
}

// --- nRF52833 ---

std::vector<unsigned> SpimParts::selected() const {
  std::vector<unsigned> low;
  for (const auto& [number, pin] : kSelects)
    if ((answers.contains(number) || number == 16) && level(pin) == Level::low)
      low.push_back(number);
  return low;
}

std::uint32_t SpimParts::read(std::uintptr_t address) {
  if (address == kUarte1 + 0x158) return player_stopped_;
  if (address < kSpim3 || address >= kSpim3 + 0x1000) return Nrf52833::read(address);
  switch (address - kSpim3) {
    case 0x104:
      pass_microsecond();  // each poll takes time
      return stopped_;
    case 0x118:
      return ended_;
    case 0x538:
      return receive_;
    case 0x53C:
      return received_;
    default:
      no_register(address);
  }
}

void SpimParts::write_player(std::uintptr_t offset, std::uint32_t value) {
  switch (offset) {
    case 0x00C:
      player_stopped_ = 1;
      return;
    case 0x158:
      player_stopped_ = value;
      return;
    case 0x500:
      player_enable_ = value;
      return;
    case 0x50C:
    case 0x524:
      return;
    default:
      no_register(offset);
  }
}

void SpimParts::write(std::uintptr_t address, std::uint32_t value) {
  if (address >= kUarte1 && address < kUarte1 + 0x1000)
    return write_player(address - kUarte1, value);
  if (address < kSpim3 || address >= kSpim3 + 0x1000) {
    Nrf52833::write(address, value);
    if (selected().empty()) release();
    return;
  }
  const std::uintptr_t offset = address - kSpim3;
  const bool of_pins = offset >= 0x508 && offset <= 0x510;
  demand(enable_ == 0 || !(of_pins || offset == 0x524 || offset == 0x554),
         "the module is set up while it is on");
  demand(!runs_ || offset < 0x534, "a buffer is changed during the transfer");
  switch (offset) {
    case 0x010:
      return value == 1 ? start() : void();
    case 0x014:
      if (value == 1 && runs_) stops_ = true;
      return;
    case 0x104:
    case 0x118:
      demand(value == 0, "an event can only be cleared");
      (offset == 0x104 ? stopped_ : ended_) = 0;
      return;
    case 0x304:
      interrupts_ |= value;
      return;
    case 0x500:
      demand(value != 7 || player_enable_ == 0, "UARTE1 has a pin of the module");
      demand(is_dead || !runs_, "the module is switched while it sends");
      enable_ = value;
      runs_ = false;
      return;
    case 0x508:
      clock_ = value;
      return;
    case 0x50C:
      output_ = value;
      return;
    case 0x510:
      input_ = value;
      return;
    case 0x524:
      frequency_ = value;
      return;
    case 0x534:
      to_ = value;
      return;
    case 0x538:
      receive_ = value;
      return;
    case 0x544:
      from_ = value;
      return;
    case 0x548:
      send_ = value;
      return;
    case 0x554:
      mode_ = value;
      return;
    default:
      no_register(address);
  }
}

void SpimParts::start() {
  demand(enable_ == 7 && !runs_, "the module is started while it is off, or sends");
  demand(ended_ == 0, "the end of an earlier transfer would be taken for the end of this one");
  demand(frequency_ == 0x1000'0000 && mode_ == 0, "the model knows 1 MHz, and mode 0");
  demand(send_ == receive_ && send_ > 0, "the model sends as many bytes as it receives");
  demand(clock_ == (kClock.first << 5 | kClock.second) && configuration_of(kClock) == 0b01 &&
             !is_set(kClock),
         "the clock has another pin, is not heard, or is high at rest");
  demand(output_ == (kOutput.first << 5 | kOutput.second) && configuration_of(kOutput) == 0b11,
         "the output is no output");
  demand(input_ == (kInput.first << 5 | kInput.second) && configuration_of(kInput) == 0b1100,
         "the input is no input, or not pulled up");
  runs_ = true;
  stops_ = false;
  done_ = 0;
  received_ = 0;
  left_us_ = 8;
}

void SpimParts::end(bool stopped) {
  runs_ = false;
  received_ = done_ - (loses_one ? 1 : 0);
  ended_ = 1;
  if (stopped) stopped_ = 1;
}

void SpimParts::pass_microsecond() {
  Nrf52833::pass_microsecond();
  if (!runs_ || is_dead || enable_ != 7) return;
  if (stuck) return stops_ ? end(true) : void();
  if (--left_us_ != 0) return;
  left_us_ = 8;
  const auto* const out = static_cast<const volatile std::uint8_t*>(memory_at(from_));
  auto* const in =
      const_cast<volatile std::uint8_t*>(static_cast<const volatile std::uint8_t*>(memory_at(to_)));
  in[done_] = exchange(out[done_], selected());
  if (++done_ == send_ || stops_) end(stops_);
}

// --- STM32L475 ---

std::vector<unsigned> Stm32SpiParts::selected() const {
  std::vector<unsigned> low;
  for (const auto& [number, pin] : selects)
    if ((answers.contains(number) || number == 45) && level(pin) == Level::low)
      low.push_back(number);
  return low;
}

bool Stm32SpiParts::has_pin(unsigned bit) {
  return (Stm32Timers::read(0x4800'0020) >> 4 * bit & 0xF) == 5 &&
         (Stm32Timers::read(0x4800'0000) >> 2 * bit & 3) == 2;
}

bool Stm32SpiParts::interrupt() const {
  return ((flags_ & 1U << 5) != 0 && (to_memory_.control & 1U << 1) != 0) ||
         ((flags_ & 1U << 7) != 0 && (to_memory_.control & 1U << 3) != 0);
}

// BSY: while a byte, or the end of its last clock, is on the line, or one waits.
std::uint32_t Stm32SpiParts::read(std::uintptr_t address) {
  switch (address) {
    case kAhb1:
      return ahb1_;
    case kApb2:
      return apb2_;
    case kApb2Resets:
      return resets_;
    case kDma1:
      return flags_;
    case kDma1 + 0xA8:
      return select_;
    case kSpi1 + 8:
      pass_tick();  // each poll takes time
      return (left_ != 0 || tail_ != 0 || !sends_.empty() ? 1U << 7 : 0U) | lost_;
    default:
      return Stm32Timers::read(address);
  }
}

void Stm32SpiParts::reset() {
  control_ = 0;
  control2_ = 0x700;
  lost_ = 0;
  sends_.clear();
  came_.clear();
  left_ = tail_ = 0;
}

void Stm32SpiParts::write_channel(Channel& channel, std::uintptr_t offset, std::uint32_t value) {
  if (offset == 0) {
    if ((value & 1) != 0 && (channel.control & 1) == 0) channel.moved = 0;
    channel.control = value;
    return;
  }
  demand((channel.control & 1) == 0, "a channel is told something while it is on");
  (offset == 4 ? channel.count : offset == 8 ? channel.peripheral : channel.memory) = value;
}

void Stm32SpiParts::write_own(std::uintptr_t offset, std::uint32_t value) {
  demand((control_ & 1U << 6) == 0, "the SPI is set up while it is on");
  switch (offset) {
    case 0:
      control_ = value;
      return;
    case 4:
      control2_ = value;
      return;
    default:
      no_register(offset);
  }
}

// Without its clock a peripheral ignores writes.
void Stm32SpiParts::write(std::uintptr_t address, std::uint32_t value) {
  const bool dma = address >= kDma1 && address < kDma1 + 0x400;
  const bool spi = address >= kSpi1 && address < kSpi1 + 0x400;
  if ((dma && (ahb1_ & 1) == 0) || (spi && (apb2_ & kSpi1Bit) == 0)) return;
  if (spi) return write_own(address - kSpi1, value);
  switch (address) {
    case kAhb1:
      ahb1_ = value;
      return;
    case kApb2:
      apb2_ = value;
      return;
    case kApb2Resets:
      resets_ = value;
      if ((value & kSpi1Bit) != 0) reset();
      return;
    case kDma1 + 0x04:
      flags_ &= ~value;
      return;
    case kDma1 + 0xA8:
      select_ = value;
      return;
    default:
      break;
  }
  if (address >= kDma1 + 0x1C && address <= kDma1 + 0x28)
    return write_channel(to_memory_, address - kDma1 - 0x1C, value);
  if (address >= kDma1 + 0x30 && address <= kDma1 + 0x3C)
    return write_channel(from_memory_, address - kDma1 - 0x30, value);
  Stm32Timers::write(address, value);
  if (!selected().empty()) return;
  demand(left_ == 0 && tail_ == 0, "the part is released before the clock has ended");
  release();
}

// The place in memory of the next byte; null if the channel moves none. A channel that failed does not work before its flag is
// cleared.
volatile std::uint8_t* Stm32SpiParts::dma(Channel& channel, unsigned number,
                                          std::uint32_t control) {
  if ((channel.control & 1) == 0 || channel.count == 0) return nullptr;
  demand((flags_ >> 4 * (number - 1) & 0b1000) == 0, "the channel has failed");
  demand((select_ >> 4 * (number - 1) & 0xF) == 1, "the channel hears somebody else");
  demand((channel.control & 0x7FF0) == control, "the channel is set wrong");
  demand(channel.peripheral == kSpi1 + 0x0C, "the channel is for something else");
  --channel.count;
  if (channel.count == 0) flags_ |= 0b11U << 4 * (number - 1);
  auto* const memory = const_cast<volatile std::uint8_t*>(
      static_cast<const volatile std::uint8_t*>(memory_at(channel.memory)));
  return memory + channel.moved++;
}

void Stm32SpiParts::fill() {
  if ((control2_ & 1U << 1) == 0) return;
  while (sends_.size() < 3) {
    const auto* const byte = dma(from_memory_, 3, 0x90);
    if (byte == nullptr) return;
    const std::uint8_t sent = *byte;
    sends_.push_back(sent);
  }
}

void Stm32SpiParts::empty() {
  if (came_.empty() || (control2_ & 1U) == 0 || dma_is_late) return;
  if ((to_memory_.control & 1) != 0 && std::exchange(dma_fails, false)) {
    flags_ |= 0b1001U << 4;
    to_memory_.control &= ~1U;
    return;
  }
  if (auto* const place = dma(to_memory_, 2, 0x80)) {
    *place = came_.front();
    came_.pop_front();
  }
}

// 0.1 us. 625 kHz is 1.6 us a bit. A byte has come half a clock before its end.
void Stm32SpiParts::pass_tick() {
  if ((control_ & 1U << 6) == 0) return;
  // SSM, SSI, SPE, a 128th of 80 MHz, MSTR; 8 bits, a byte counts as received, DMA both ways.
  demand(control_ == 0x374 && control2_ == 0x1703, "the model knows 625 kHz, mode 0, and DMA");
  fill();
  empty();
  if (tail_ != 0) --tail_;
  if (stuck) return;
  if (left_ == 0 && tail_ == 0 && !sends_.empty()) {
    byte_ = sends_.front();
    sends_.pop_front();
    left_ = 120;
    demand(has_pins(), "a pin does not have the SPI's function");
  }
  if (left_ == 0 || --left_ != 0) return;
  tail_ = 8;
  const std::uint8_t came = exchange(byte_, selected());
  came_.size() < 4 ? came_.push_back(came) : void(lost_ = 1U << 6);
}

void Stm32SpiParts::pass_microsecond() {
  Stm32Timers::pass_microsecond();
  for (unsigned tick = 0; tick < 10; ++tick)
    pass_tick();
}

}  // namespace robosync::tests
