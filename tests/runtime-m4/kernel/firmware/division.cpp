// 64-bit division on the board (port/cortex-m4/divide.S): checks the results against the definition.
#include "tests/runtime-m4/kernel/firmware/rig.hpp"

namespace {

// Numbers of all lengths: every bit pattern is as likely as every length.
class Draw {
public:
  std::uint64_t number() {
    const unsigned shift = static_cast<unsigned>(bits()) % 64;
    return bits() >> shift;
  }

private:
  std::uint64_t bits() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return state_;
  }

  std::uint64_t state_ = 88172645463325252U;  // Marsaglia's xorshift64
};

void check_unsigned(std::uint64_t n, std::uint64_t d) {
  const std::uint64_t quotient = n / d;
  const std::uint64_t rest = n % d;
  CHECK(rest < d);
  CHECK(quotient * d + rest == n);
  CHECK(quotient <= n);  // the product has not wrapped
}

void unsigned_numbers() {
  constexpr std::uint64_t kEdges[] = {
      1, 2, 999, 1000, 0xFFFF, 0x10000, 0xFFFF'FFFF, 0x1'0000'0000, ~std::uint64_t{0}};
  for (const std::uint64_t n : kEdges)
    for (const std::uint64_t d : kEdges) {
      check_unsigned(n, d);
      check_unsigned(n - 1, d);
    }
  Draw draw;
  for (unsigned i = 0; i < 5000; ++i)
    check_unsigned(draw.number(), draw.number() | 1);
}

// Rounded towards 0; the remainder has the sign of the dividend.
void check_signed(std::int64_t n, std::int64_t d) {
  const std::int64_t quotient = n / d;
  const std::int64_t rest = n % d;
  CHECK(quotient * d + rest == n);
  CHECK(rest == 0 || (rest < 0) == (n < 0));
  CHECK((rest < 0 ? -rest : rest) < (d < 0 ? -d : d));
}

void signed_numbers() {
  Draw draw;
  for (unsigned i = 0; i < 5000; ++i) {
    const auto n = static_cast<std::int64_t>(draw.number() >> 1);
    const auto d = static_cast<std::int64_t>(draw.number() >> 1 | 1);
    check_signed(n, d);
    check_signed(-n, d);
    check_signed(n, -d);
    check_signed(-n, -d);
  }
}

constexpr rig::Scenario kScenarios[] = {
    {"division of 64 bits", unsigned_numbers},
    {"division of 64 bits with a sign", signed_numbers},
};

}  // namespace

std::span<const rig::Scenario> rig::division_scenarios() {
  return kScenarios;
}
