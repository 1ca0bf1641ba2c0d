#include "vm/opcode_traits.hpp"

namespace robosync::vm {
namespace {

constexpr std::array<Traits, kOpcodes.size()> make_traits() {
  std::array<Traits, kOpcodes.size()> traits{};
  for (std::size_t i = 0; i < traits.size(); ++i)
    traits[i] = Traits(kOpcodes[i]);
  return traits;
}

constexpr bool holds(Traits traits, const OpcodeInfo& info) {
  for (unsigned place = 0; place < info.operands.size(); ++place)
    if (traits.operand(place) != info.operands[place]) return false;
  for (const Context context : {Context::condition, Context::response, Context::safety}) {
    const bool wanted =
        (static_cast<unsigned>(info.contexts) & static_cast<unsigned>(context)) != 0;
    if (traits.stands_in(context) != wanted) return false;
  }
  return traits.flow() == info.flow && traits.effect() == info.effect;
}

constexpr bool all_hold() {
  const auto traits = make_traits();
  for (std::size_t i = 0; i < kOpcodes.size(); ++i)
    if (!holds(traits[i], kOpcodes[i])) return false;
  return true;
}
static_assert(all_hold(), "a column needs more bits");

}  // namespace

constexpr std::array<Traits, kOpcodes.size()> kTraits = make_traits();

}  // namespace robosync::vm
