#include "compiler/query/rename.hpp"

#include <algorithm>
#include <cctype>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/functions.hpp"
#include "compiler/syntax/keywords.hpp"
#include "compiler/syntax/lexer.hpp"

namespace robosync::compiler::query {
namespace {

std::string shown(std::string_view name) {
  return "`" + std::string(name) + "`";
}

// True if the text consists of names only. A label may have several.
bool is_written_as_name(std::string_view name, bool may_have_several) {
  SourceMap sources;
  const FileId file = sources.add("", std::string(name));
  Diagnostics diagnostics;
  const std::vector<Token> tokens = lex(sources.file(file), file, diagnostics);
  const bool number = tokens.size() == 1 || (may_have_several && !tokens.empty());
  const bool whole =
      number && tokens.front().span.begin == 0 && tokens.back().span.end == name.size();
  return whole && diagnostics.all().empty() &&
         std::ranges::all_of(tokens, [](const Token& token) { return token.kind == Kinds::NAME; });
}

}  // namespace

std::string why_not_renamed(const Symbol& symbol, const SourceMap& sources) {
  if (!symbol.declared) return shown(symbol.name) + " is a word of RSL";
  const std::string& name = sources.file(symbol.declared->file).name();
  if (symbol.kind == SymbolKind::verb || symbol.kind == SymbolKind::word)
    return shown(symbol.name) + " belongs to a device of the robot";
  if (symbol.kind == SymbolKind::module) return shown(symbol.name) + " is a file of its own";
  if (!symbol.is_there && symbol.kind == SymbolKind::label)
    return shown(symbol.name) + " is a word of the sensor, which " + name + " describes";
  if (!symbol.is_there) return shown(symbol.name) + " belongs to the device of the sensor";
  if (symbol.declared->file > kConfigurationFile)
    return shown(symbol.name) + " is declared in " + name + ", which other programs may use too";
  return {};
}

std::string why_not_called(std::string_view name, const Symbol& symbol, const Project& project,
                           const Symbols& symbols) {
  if (is_keyword(name)) return shown(name) + " is a word of RSL";
  if (!is_written_as_name(name, symbol.kind == SymbolKind::label))
    return shown(name) + " is no name: letters, digits and `_`, and no digit at the beginning";
  if (same_name(symbol.name, name)) return {};
  // In `SET mood TO calm`, a label is where a number could be, so labels and variables must have different names, too.
  const auto is_taken = [&](const Symbol& other) {
    const bool apart = symbol.kind == SymbolKind::label && other.kind == SymbolKind::label &&
                       other.within != symbol.within;
    const bool elsewhere = symbol.kind == SymbolKind::channel &&
                           other.kind == SymbolKind::channel && other.owner != symbol.owner;
    return !apart && !elsewhere && same_name(other.name, name);
  };
  Diagnostics ignored;
  Names names(project.trees, project.robot, ignored);
  const bool taken = std::ranges::any_of(symbols.all(), is_taken) || names.is_verb(name) ||
                     names.is_word(name) || find_function(name) != nullptr;
  const std::string kind = names.kind_of(name);
  if (!kind.empty()) return shown(name) + " is " + kind + " already";
  return taken ? shown(name) + " is a name already" : "";
}

// ---- a sensor and its channel in one word

namespace {

// How many characters of `text` say `name`, which it begins with.
std::size_t length_of(std::string_view name, std::string_view text) {
  std::size_t letters = fold_name(name).size(), at = 0;
  for (; letters > 0 && at < text.size(); ++at)
    if (text[at] != '_') --letters;
  return at;
}

bool has_lower(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return c >= 'a' && c <= 'z'; });
}

// LEVEL as in `touchLevel` is `Level`.
std::string written_like(std::string_view old, std::string_view name) {
  std::string text(name);
  if (!has_lower(old)) return text;
  if (!has_lower(text)) std::ranges::transform(text, text.begin(), ascii::lower);
  if (old.front() >= 'A' && old.front() <= 'Z') text.front() = ascii::upper(text.front());
  return text;
}

}  // namespace

std::optional<std::string> joined_name(std::string_view text, const Symbol& meant,
                                       const Symbol& renamed, std::string_view name,
                                       const Project& project) {
  if (meant.kind != SymbolKind::channel || same_name(text, meant.name)) return std::nullopt;
  if (renamed.owner != meant.owner) return std::nullopt;
  std::size_t at = length_of(project.robot.sensors.at(meant.owner).name.text, text);
  if (renamed.kind == SymbolKind::sensor)
    return written_like(text.substr(0, at), name).append(text.substr(at));
  if (renamed.kind != SymbolKind::channel || renamed.place != meant.place) return std::nullopt;
  while (at < text.size() && text[at] == '_')
    ++at;
  return std::string(text.substr(0, at)).append(written_like(text.substr(at), name));
}

// ---- the program afterwards

std::string why_not_same(const Symbols& before, const Diagnostics& said_before,
                         const Symbols& after, const Diagnostics& said_after) {
  // By code, as the messages of before may say the name.
  const auto errors = [](const Diagnostics& said, Code code) {
    return std::ranges::count_if(said.all(), [code](const Diagnostic& one) {
      return one.level == compiler::Level::error && one.code == code;
    });
  };
  for (const Diagnostic& one : said_after.all())
    if (errors(said_after, one.code) > errors(said_before, one.code)) return "then " + one.message;
  const auto same = [](const Occurrence& a, const Occurrence& b) {
    return a.symbol == b.symbol && a.span.file == b.span.file;
  };
  const bool is_same = std::ranges::equal(before.occurrences(), after.occurrences(), same);
  return is_same ? "" : "then another name would mean something else";
}

}  // namespace robosync::compiler::query
