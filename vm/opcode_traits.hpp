// The properties of each opcode on the board at run time: its line of opcodes.def without name,
// documentation and cost, packed into one word.
#pragma once

#include "vm/opcode.hpp"

namespace robosync::vm {

template <typename Enum>
constexpr std::uint32_t as_bits(Enum value) {
  return static_cast<std::uint32_t>(value);
}

class Traits {
public:
  constexpr Traits() = default;  // of an invalid opcode, which is allowed nowhere
  constexpr explicit Traits(const OpcodeInfo& info)
      : bits_(as_bits(info.operands[0]) | as_bits(info.operands[1]) << kKindBits |
              as_bits(info.operands[2]) << 2 * kKindBits | as_bits(info.contexts) << kContextShift |
              as_bits(info.flow) << kFlowShift | as_bits(info.effect) << kEffectShift) {}

  [[nodiscard]] constexpr Operand operand(unsigned place) const {
    return static_cast<Operand>(bits_ >> place * kKindBits & kKindMask);
  }
  [[nodiscard]] constexpr Flow flow() const {
    return static_cast<Flow>(bits_ >> kFlowShift & kFlowMask);
  }
  [[nodiscard]] constexpr Effect effect() const {
    return static_cast<Effect>(bits_ >> kEffectShift);
  }
  [[nodiscard]] constexpr bool stands_in(Context context) const {
    return (bits_ >> kContextShift & as_bits(context)) != 0;
  }

private:
  static constexpr unsigned kKindBits = 5;
  static constexpr std::uint32_t kKindMask = 0x1F;
  static constexpr unsigned kContextShift = 3 * kKindBits;
  static constexpr unsigned kFlowShift = kContextShift + 3;
  static constexpr std::uint32_t kFlowMask = 0xF;
  static constexpr unsigned kEffectShift = kFlowShift + 4;
  std::uint32_t bits_ = 0;
};

extern const std::array<Traits, kOpcodes.size()> kTraits;

// For any word. For a verified word, use kTraits[word & 0xFF].
inline Traits traits_of(Word word) {
  const std::size_t number = word & 0xFF;
  return number < kTraits.size() ? kTraits[number] : Traits();
}

}  // namespace robosync::vm
