// One pass over the text that only tracks strings and nesting. May assume that the text has been
// parsed without error.
#include "rsc/trace/json_lines.hpp"

#include <algorithm>

namespace robosync::tool {
namespace {

class Scanner {
public:
  Scanner(std::string_view text, std::string_view key) : text_(text), key_(key) {}

  std::vector<TextRange> run() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"') {
        string();
        continue;
      }
      if (c == '{' || c == '[') open(c);
      if (c == '}' || c == ']') close();
      if (c == ',' && in_array()) separate();
      ++at_;
    }
    return std::move(elements_);
  }

private:
  bool in_array() const { return inside_ && depth_ == 2; }

  void string() {
    const std::size_t begin = ++at_;
    while (at_ < text_.size() && text_[at_] != '"')
      at_ += text_[at_] == '\\' ? 2 : 1;
    // At depth 1 every string is a key or a value; only a key is followed by a colon and the array.
    if (depth_ == 1) last_key_ = text_.substr(begin, at_ - begin);
    ++at_;
  }

  void open(char c) {
    ++depth_;
    if (depth_ == 2 && c == '[' && last_key_ == key_) {
      inside_ = true;
      begin_ = at_ + 1;
    }
  }

  void close() {
    if (in_array()) {
      separate();
      inside_ = false;
    }
    --depth_;
  }

  // An element ends here. Its range starts at its first character that is not white space.
  void separate() {
    const std::size_t begin = text_.find_first_not_of(" \t\r\n", begin_);
    if (begin < at_) elements_.push_back({begin, at_});
    begin_ = at_ + 1;
  }

  std::string_view text_, key_, last_key_;
  std::size_t at_ = 0;
  std::size_t begin_ = 0;
  int depth_ = 0;
  bool inside_ = false;
  std::vector<TextRange> elements_;
};

}  // namespace

std::vector<TextRange> array_elements(std::string_view text, std::string_view key) {
  return Scanner(text, key).run();
}

std::size_t line_of(std::string_view text, std::size_t at) {
  return 1 + static_cast<std::size_t>(std::ranges::count(text.substr(0, at), '\n'));
}

}  // namespace robosync::tool
