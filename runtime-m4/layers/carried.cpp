// See carried.hpp.
#include "runtime-m4/layers/carried.hpp"

#include <algorithm>

#include "runtime-m4/layers/name_key.hpp"

namespace robosync::layers {
namespace {

using Keys = std::array<std::uint32_t, policy::kMaxVariables>;

constexpr std::uint32_t kNotCarried = 0;

bool outlives(vm::VariableKind kind) {
  return kind == vm::VariableKind::plain || kind == vm::VariableKind::kept ||
         kind == vm::VariableKind::state || kind == vm::VariableKind::feeling;
}

// A REMEMBER stays the same one when KEPT is written behind it.
std::uint32_t key_of(const vm::Image& image, const vm::Variable& variable) {
  if (!outlives(variable.kind)) return kNotCarried;
  const std::uint32_t name = kept_key(image, variable);
  const bool is_number =
      variable.kind == vm::VariableKind::plain || variable.kind == vm::VariableKind::kept;
  return is_number ? name : vm::crc32(std::as_bytes(std::span(&variable.kind, 1)), name);
}

void find_keys(const vm::Image& image, Keys& keys) {
  for (std::size_t v = 0; v < image.variables.size(); ++v)
    keys[v] = key_of(image, image.variables[v]);
}

bool is_only_one(std::span<const std::uint32_t> keys, std::uint32_t key) {
  return key != kNotCarried && std::ranges::count(keys, key) == 1;
}

// The number of a label does not say which one it is: labels may be added and moved.
std::uint32_t label_key(const vm::Image& image, const vm::Variable& state, unsigned label) {
  return name_key(image.string(image.labels[state.first_label + label]));
}

vm::Value portable(const vm::Image& image, const vm::Variable& variable, vm::Value value) {
  if (variable.kind != vm::VariableKind::state) return value;
  return static_cast<vm::Value>(
      label_key(image, variable, static_cast<unsigned>(value / vm::kScale)));
}

std::optional<vm::Value> value_in(const vm::Image& image, const vm::Variable& variable,
                                  vm::Value carried) {
  if (variable.kind != vm::VariableKind::state)
    return std::clamp(carried, variable.min, variable.max);
  for (unsigned label = 0; label < variable.label_count; ++label)
    if (label_key(image, variable, label) == static_cast<std::uint32_t>(carried))
      return static_cast<vm::Value>(label) * vm::kScale;
  return std::nullopt;
}

}  // namespace

void Carried::take(const vm::Image& image, std::span<const vm::Value> values) {
  Keys keys{};
  find_keys(image, keys);
  const auto all = std::span(keys).first(image.variables.size());
  count_ = 0;
  for (std::size_t v = 0; v < image.variables.size(); ++v)
    if (is_only_one(all, keys[v]))
      entries_[count_++] = {keys[v], portable(image, image.variables[v], values[v])};
}

void Carried::apply(const vm::Image& image, std::span<vm::Value> values) const {
  if (count_ == 0) return;
  Keys keys{};
  find_keys(image, keys);
  const auto all = std::span(keys).first(image.variables.size());
  for (std::size_t v = 0; v < image.variables.size(); ++v) {
    if (!is_only_one(all, keys[v])) continue;
    const std::optional<vm::Value> carried = find(keys[v]);
    if (!carried) continue;
    const std::optional<vm::Value> value = value_in(image, image.variables[v], *carried);
    if (value) values[v] = *value;
  }
}

std::optional<vm::Value> Carried::find(std::uint32_t key) const {
  const auto known = std::span(entries_).first(count_);
  const auto found = std::ranges::find(known, key, &Entry::key);
  return found == known.end() ? std::nullopt : std::optional(found->value);
}

}  // namespace robosync::layers
