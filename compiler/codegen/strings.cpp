#include "compiler/codegen/strings.hpp"

namespace robosync::compiler {

std::uint16_t Strings::offset(std::string_view text) {
  // Of more than an image holds, nobody reads the places.
  const bool full = text_.size() > UINT16_MAX;
  if (full) return 0;
  const std::size_t end = text_.size() + text.size();
  bool known = !endings_.empty();
  if (!known) endings_.push_back({end});
  std::uint32_t at = 0;
  for (std::size_t i = text.size(); i > 0; --i) {
    const auto next = static_cast<std::uint32_t>(endings_.size());
    const auto [longer, added] = endings_[at].longer.emplace(text[i - 1], next);
    at = longer->second;
    if (added) endings_.push_back({end});
    known = known && !added;
  }
  if (known) return static_cast<std::uint16_t>(endings_[at].end - text.size());
  text_ += text;
  text_ += '\0';
  return static_cast<std::uint16_t>(end - text.size());
}

std::uint16_t Strings::row(const std::vector<std::string>& labels) {
  std::vector<std::uint16_t> row;
  row.reserve(labels.size());
  for (const std::string& label : labels)
    row.push_back(offset(label));
  return place_row(labels_, row);
}

}  // namespace robosync::compiler
