// Formats the texts of codes.def for display.
#include "compiler/explain/codes.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "compiler/source/ascii.hpp"

namespace robosync::compiler::explain {
namespace {

constexpr std::array kCodeTexts = {
#define EXPLAIN(code, meaning, wrong, mended) CodeText{Code::code, meaning, wrong, mended},
#include "compiler/explain/codes.def"
#undef EXPLAIN
};

std::string indented(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    result += fmt::format("{}{}\n", end == 0 ? "" : "    ", text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

}  // namespace

std::span<const CodeText> code_texts() {
  return kCodeTexts;
}

std::optional<Code> find_code(std::string_view name) {
  const auto same = [name](Code code) { return ascii::same(code_name(code), name); };
  const std::span<const Code> codes = all_codes();
  const auto found = std::ranges::find_if(codes, same);
  return found == codes.end() ? std::nullopt : std::optional(*found);
}

std::string code_text(Code code) {
  std::string text = fmt::format("{} ({}): {}\n", code_name(code), level_name(default_level(code)),
                                 code_title(code));
  const auto* const found = std::ranges::find(kCodeTexts, code, &CodeText::code);
  if (found == kCodeTexts.end()) return text;
  text += fmt::format("\n{}\n", found->meaning);
  if (!found->wrong.empty()) text += "\nFor example:\n\n" + indented(found->wrong);
  if (!found->mended.empty()) text += "\nCorrect:\n\n" + indented(found->mended);
  return text;
}

}  // namespace robosync::compiler::explain
