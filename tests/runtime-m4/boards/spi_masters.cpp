// See spi_masters.hpp.
#include "tests/runtime-m4/boards/spi_masters.hpp"

namespace robosync::tests {
namespace {

constexpr std::uintptr_t kSpim2 = 0x4002'3000;
constexpr std::uintptr_t kSpi1 = 0x4001'3000, kDma1 = 0x4002'0000, kThird = 0x4002'0030;
constexpr std::uintptr_t kAhb1Clocks = 0x4002'1048, kApb2Clocks = 0x4002'1060;
constexpr unsigned kNsOf4MHz = 250, kNsOf2500kHz = 400;

std::uint8_t byte_at(std::uint32_t memory, std::size_t index) {
  return static_cast<const volatile std::uint8_t*>(memory_at(memory))[index];
}

}  // namespace

// The highest bit first.
void SpiLine::say(std::uint8_t byte, unsigned ns_of_bit) {
  for (unsigned bit = 8; bit-- > 0;) {
    last_ = (byte >> bit & 1) != 0;
    heard(last_, ns_of_bit);
  }
}

void SpiLine::say_nothing(unsigned ns) {
  heard(idle == Idle::as_it_was ? last_ : idle == Idle::high, ns);
}

std::uint32_t NrfSpim::read(std::uintptr_t address) {
  if (address < kSpim2 || address >= kSpim2 + 0x1000) return Nrf52833::read(address);
  if (is_dead) {
    if (address == kSpim2 + 0x104) ++looks;
    return address == kSpim2 + 0x500 ? enable_ : 0;
  }
  switch (address - kSpim2) {
    case 0x104:
      ++looks;
      pass(1);
      return stopped_;
    case 0x118:
      return ended_;
    case 0x500:
      return enable_;
    default:
      no_register(address);
  }
}

void NrfSpim::write(std::uintptr_t address, std::uint32_t value) {
  if (address < kSpim2 || address >= kSpim2 + 0x1000) return Nrf52833::write(address, value);
  switch (address - kSpim2) {
    case 0x010:
      return value == 1 ? start() : void();
    case 0x014:
      if (value == 1) stops_ = true;
      return;
    case 0x104:
    case 0x118:
      demand(value == 0, "an event can only be cleared");
      (address == kSpim2 + 0x104 ? stopped_ : ended_) = 0;
      return;
    case 0x500:
      demand(is_dead || !runs_, "the module is switched while it sends");
      enable_ = value;
      return;
    case 0x508:
    case 0x50C:
      demand(enable_ == 0, "its pin is chosen while the module is on");
      (address == kSpim2 + 0x508 ? clock_ : output_) = value;
      return;
    case 0x524:
      frequency_ = value;
      return;
    case 0x538:
      receive_count_ = value;
      return;
    case 0x544:
      memory_ = value;
      return;
    case 0x548:
      demand(value < 0x1'0000, "a count has 16 bits");
      count_ = value;
      return;
    default:
      no_register(address);
  }
}

void NrfSpim::start() {
  if (is_dead) return;
  demand(enable_ == 7 && !runs_, "the module is started while it is off, or sends");
  demand(frequency_ == 0x4000'0000 && receive_count_ == 0, "the model knows 4 MHz, and one way");
  demand(configuration_of({output_ >> 5, output_ & 31}) == 0b11 &&
             !is_set({output_ >> 5, output_ & 31}),
         "its pin is no output, or high when the module lets it go");
  // Nordic, PS nRF52832, SPI: "The SCK must always be connected to a pin, and that pin's input buffer must always be connected".
  demand(clock_ < 64 && clock_ != output_ && configuration_of({clock_ >> 5, clock_ & 31}) == 0b01,
         "the module has no clock pin, or does not hear it: it sends nothing");
  runs_ = true;
  stops_ = false;
  sent_ = 0;
}

void NrfSpim::pass_byte() {
  say(byte_at(memory_, sent_++), kNsOf4MHz);
  if (sent_ < count_ && !stops_) return;
  runs_ = false;
  ended_ = 1;
  if (stops_) stopped_ = 1;
}

// While the module is off, its pin is low.
void NrfSpim::pass(unsigned us) {
  for (unsigned passed = 0; passed < us; passed += 2) {
    if (runs_)
      pass_byte();
    else if (enable_ == 7)
      say_nothing(2000);
    else
      heard(false, 2000);
  }
}

std::uint32_t Stm32Spi::read(std::uintptr_t address) {
  switch (address) {
    case kAhb1Clocks:
      return ahb1_;
    case kApb2Clocks:
      return apb2_;
    case kDma1 + 0xA8:
      return select_;
    default:
      return Stm32Timers::read(address);
  }
}

// Without its clock it ignores writes.
void Stm32Spi::write(std::uintptr_t address, std::uint32_t value) {
  const bool dma = address >= kDma1 && address < kDma1 + 0x400;
  const bool spi = address >= kSpi1 && address < kSpi1 + 0x400;
  if ((dma && (ahb1_ & 1) == 0) || (spi && (apb2_ & 1U << 12) == 0)) return;
  const bool on = (dma_ & 1) != 0;
  switch (address) {
    case kAhb1Clocks:
      ahb1_ = value;
      return;
    case kApb2Clocks:
      apb2_ = value;
      return;
    case kDma1 + 0x04:
      demand(value == 0xF00, "another channel's flags are forgotten");
      return;
    case kDma1 + 0xA8:
      select_ = value;
      return;
    case kThird:
      dma_ = value;
      moved_ = 0;
      return;
    case kThird + 4:
    case kThird + 8:
    case kThird + 12:
      demand(!on, "a channel is told something while it is on");
      (address == kThird + 4 ? left_ : address == kThird + 8 ? peripheral_ : memory_) = value;
      return;
    case kSpi1:
      demand((control_ & 1U << 6) == 0 || value == control_ || value == 0,
             "the SPI is changed while it is on");
      control_ = value;
      if ((value & 1U << 6) == 0) waiting_.clear();
      return;
    case kSpi1 + 4:
      demand((control_ & 1U << 6) == 0 || value == control2_, "the SPI is changed while it is on");
      control2_ = value;
      return;
    default:
      Stm32Timers::write(address, value);
  }
}

// Takes successive bytes from memory as the SPI requests them.
void Stm32Spi::fill() {
  if ((dma_ & 1) == 0 || (control2_ & 1U << 1) == 0) return;
  demand(peripheral_ == kSpi1 + 0x0C && (select_ >> 8 & 0xF) == 1 && dma_ == 0b1001'0001,
         "the channel does not bring bytes to the SPI");
  for (; waiting_.size() < 4 && left_ > 0; --left_)
    waiting_.push_back(byte_at(memory_, moved_++));
}

void Stm32Spi::pass_byte() {
  // BIDIMODE, BIDIOE, SSM, SSI, SPE, a 32nd of 80 MHz, MSTR.
  demand(control_ == 0 || control_ == 0xC364, "the model knows one way out, and 2.5 MHz");
  const bool on = (control_ & 1U << 6) != 0;
  if (on) fill();
  const bool has_it = has_pin();
  if (on && !waiting_.empty() && (control2_ & 0xF00) == 0x700) {
    const std::uint8_t byte = waiting_.front();
    waiting_.pop_front();
    if (has_it) return say(byte, kNsOf2500kHz);
  }
  if (!has_it)
    heard(level({'A', 7}) == Level::high, 8 * kNsOf2500kHz);
  else
    say_nothing(8 * kNsOf2500kHz);
}

bool Stm32Spi::has_pin() {
  const std::uint32_t function = Stm32Timers::read(0x4800'0020) >> 28;
  const std::uint32_t mode = Stm32Timers::read(0x4800'0000) >> 14 & 3;
  return function == 5 && mode == 2;
}

void Stm32Spi::pass(unsigned us) {
  for (unsigned passed = 0; passed < 1000 * us; passed += 8 * kNsOf2500kHz)
    pass_byte();
}

}  // namespace robosync::tests
