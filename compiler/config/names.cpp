#include "compiler/config/names.hpp"

#include <algorithm>
#include <cstdint>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/keywords.hpp"
#include "compiler/syntax/lexer_state.hpp"

namespace robosync::compiler {
namespace {

constexpr std::size_t kListed = 12;

// As the lexer takes it, with the letters of all languages.
bool can_be_written(std::string_view name) {
  return word_length(name) == name.size() &&
         name.find_first_not_of('_') != std::string_view::npos &&
         !(name.front() >= '0' && name.front() <= '9');
}

}  // namespace

std::string fold_name(std::string_view name) {
  std::string folded;
  folded.reserve(name.size());
  for (const char c : name)
    if (c != '_') folded += ascii::lower(c);
  return folded;
}

bool same_name(std::string_view a, std::string_view b) {
  auto at_a = a.begin(), at_b = b.begin();
  while (true) {
    while (at_a != a.end() && *at_a == '_')
      ++at_a;
    while (at_b != b.end() && *at_b == '_')
      ++at_b;
    if (at_a == a.end() || at_b == b.end()) return at_a == a.end() && at_b == b.end();
    if (!ascii::same(*at_a++, *at_b++)) return false;
  }
}

// FNV-1a.
std::size_t NameIndex::Hash::operator()(std::string_view name) const {
  std::uint64_t hash = 0xCBF2'9CE4'8422'2325;
  for (const char c : name)
    if (c != '_') hash = (hash ^ static_cast<unsigned char>(ascii::lower(c))) * 0x100'0000'01B3;
  return static_cast<std::size_t>(hash);
}

void check_name(const Spelled& name, Diagnostics& diagnostics) {
  if (!can_be_written(name.text)) {
    diagnostics.report(Code::E0103, "this is not a valid name in RSL")
        .label(name.span)
        .helps("a name is a letter followed by letters, digits and `_`");
  } else if (!may_name_a_part(name.text)) {
    diagnostics.report(Code::E0102, "`" + name.text + "` is a word of RSL")
        .label(name.span)
        .helps("give it another name, such as `my_" + fold_name(name.text) + "`");
  }
}

std::string list_names(const std::vector<std::string>& names, std::string_view last) {
  std::string list;
  const bool whole = names.size() <= kListed;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!whole && i == kListed / 2) {  // what a robot adds of its own stands last
      list += ", …";
      i = names.size() - kListed / 2;
    }
    if (i > 0) list += i + 1 == names.size() ? " " + std::string(last) + " " : ", ";
    list += "`" + names[i] + "`";
  }
  return list;
}

}  // namespace robosync::compiler
