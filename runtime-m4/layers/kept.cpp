// See kept.hpp.
#include "runtime-m4/layers/kept.hpp"

#include <algorithm>

#include "runtime-m4/layers/name_key.hpp"

namespace robosync::layers {

std::uint32_t kept_key(const vm::Image& image, const vm::Variable& variable) {
  return name_key(image.string(variable.name),
                  vm::crc32(std::as_bytes(std::span(&variable.dimension, 1))));
}

vm::Value initial_of(const vm::Image& image, const vm::Variable& variable,
                     std::span<const KeptNumber> kept) {
  if (variable.kind != vm::VariableKind::kept || kept.empty()) return variable.initial;
  const auto found = std::ranges::find(kept, kept_key(image, variable), &KeptNumber::key);
  if (found == kept.end()) return variable.initial;
  return std::clamp(found->value, variable.min, variable.max);
}

}  // namespace robosync::layers
