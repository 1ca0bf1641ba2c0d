// The string and label sections under construction.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace robosync::compiler {

class Strings {
public:
  // Equal strings, and strings that end another, share their place.
  [[nodiscard]] std::uint16_t offset(std::string_view text);
  // Where the labels' offsets stand, one after another; equal rows share their place.
  [[nodiscard]] std::uint16_t row(const std::vector<std::string>& labels);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::vector<std::uint16_t>& labels() const { return labels_; }

private:
  // A string that one or more others end with.
  struct Ending {
    std::size_t end = 0;                     // of the first one of them: where its zero stands
    std::map<char, std::uint32_t> longer{};  // places in endings_, by the letter in front
  };

  std::string text_;
  std::vector<Ending> endings_;  // a tree; its root is the empty one
  std::vector<std::uint16_t> labels_;
};

// Where `row` stands in `list`; it is put at the end if it is nowhere yet.
template <typename Item>
std::uint16_t place_row(std::vector<Item>& list, const std::vector<Item>& row) {
  auto place = std::search(list.begin(), list.end(), row.begin(), row.end());
  if (place == list.end()) place = list.insert(list.end(), row.begin(), row.end());
  return static_cast<std::uint16_t>(place - list.begin());
}

}  // namespace robosync::compiler
