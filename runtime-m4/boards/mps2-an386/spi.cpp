#include "runtime-m4/boards/mps2-an386/spi.hpp"

#include "runtime-m4/boards/mps2-an386/registers.hpp"
#include "runtime-m4/port/cortex-m4/register.hpp"
#include "vm/drivers.hpp"

namespace robosync::boards::mps2::spi {
namespace {

constexpr port::Register kControl0{kSpi0 + kSpiControl0};
constexpr port::Register kControl1{kSpi0 + kSpiControl1};
constexpr port::Register kData{kSpi0 + kSpiData};
constexpr port::Register kStatus{kSpi0 + kSpiStatus};
constexpr port::Register kPrescale{kSpi0 + kSpiPrescale};

constexpr std::uint32_t kDivider = 26;  // of the clock; an even number
static_assert(kClockHz / kDivider <= 1'000'000);
constexpr unsigned kFifo = 8;  // places
static_assert(vm::kMostSpiBytes <= kFifo);
// A poll takes more than five cycles, and a byte 8 * kDivider.
constexpr unsigned kPollsOfByte = 48;
static_assert(kPollsOfByte * 5 > 8 * kDivider);

// What came after an earlier transfer was given up.
void discard_received() {
  for (unsigned i = 0; i < kFifo && kStatus.has(kSpiReceived); ++i)
    static_cast<void>(kData.read());
}

bool await_byte(unsigned& polls) {
  while (!kStatus.has(kSpiReceived))
    if (polls-- == 0) return false;
  return true;
}

}  // namespace

void start() {
  kControl0.write(kSpiBytes);
  kPrescale.write(kDivider);
  kControl1.write(kSpiOn);
}

bool transfer(std::span<const std::byte> out, std::span<std::byte> in) {
  if (out.size() + in.size() > vm::kMostSpiBytes || !kStatus.has(kSpiSentAll)) return false;
  discard_received();
  for (const std::byte byte : out)
    kData.write(std::to_integer<std::uint32_t>(byte));
  for (std::size_t i = 0; i < in.size(); ++i)
    kData.write(0);
  unsigned polls = kPollsOfByte * static_cast<unsigned>(out.size() + in.size());
  for (std::size_t i = 0; i < out.size() + in.size(); ++i) {
    if (!await_byte(polls)) return false;
    const auto byte = static_cast<std::byte>(kData.read());
    if (i >= out.size()) in[i - out.size()] = byte;
  }
  return true;
}

}  // namespace robosync::boards::mps2::spi
