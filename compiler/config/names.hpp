// Names in robot.json and RSL ignore case and underscores (touchLevel = touch_level = TOUCH_LEVEL).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"

namespace robosync::compiler {

[[nodiscard]] std::string fold_name(std::string_view name);  // "touchlevel"
[[nodiscard]] bool same_name(std::string_view a, std::string_view b);

// Maps each name of a list to its index. The names must outlive this.
class NameIndex {
public:
  // True if the name is new; otherwise its first index stays.
  bool add(std::string_view name, std::size_t place) { return places_.emplace(name, place).second; }
  [[nodiscard]] bool empty() const { return places_.empty(); }
  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const {
    const auto found = places_.find(name);
    return found == places_.end() ? std::nullopt : std::optional(found->second);
  }

private:
  struct Hash {
    std::size_t operator()(std::string_view name) const;
  };
  struct Same {
    bool operator()(std::string_view a, std::string_view b) const { return same_name(a, b); }
  };
  std::unordered_map<std::string_view, std::size_t, Hash, Same> places_;
};

// Indexes the entries of a list by their names.
template <typename List>
NameIndex index_of(const List& list) {
  NameIndex index;
  for (std::size_t i = 0; i < list.size(); ++i)
    index.add(list[i].name.text, i);
  return index;
}

// A text and its source position.
struct Spelled {
  std::string text;
  Span span;

  // As messages show it: "`wave`".
  [[nodiscard]] std::string shown() const { return "`" + text + "`"; }
};

// Reports a name that RSL cannot write (E0103) or that is one of its words (E0102).
void check_name(const Spelled& name, Diagnostics& diagnostics);

// "`a`, `b` and `c`", for messages; of more than twelve, the first six and the last six.
[[nodiscard]] std::string list_names(const std::vector<std::string>& names,
                                     std::string_view last = "and");

}  // namespace robosync::compiler
