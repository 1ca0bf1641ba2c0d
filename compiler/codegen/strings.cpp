#include "compiler/codegen/strings.hpp"

namespace robosync::compiler {

std::uint16_t Strings::offset(std::string_view text) {
  std::string entry(text);
  entry += '\0';
  std::size_t place = text_.find(entry);
  if (place == std::string::npos) {
    place = text_.size();
    text_ += entry;
  }
  return static_cast<std::uint16_t>(place);
}

std::uint16_t Strings::row(const std::vector<std::string>& labels) {
  std::vector<std::uint16_t> row;
  row.reserve(labels.size());
  for (const std::string& label : labels)
    row.push_back(offset(label));
  return place_row(labels_, row);
}

}  // namespace robosync::compiler
