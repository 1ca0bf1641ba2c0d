#include "compiler/query/rename.hpp"

#include <algorithm>
#include <cctype>

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

std::string why_not_renamed(const Symbol& symbol, FileId file, const SourceMap& sources) {
  if (!symbol.declared) return shown(symbol.name) + " is a word of RSL";
  const std::string& name = sources.file(symbol.declared->file).name();
  if (symbol.kind == SymbolKind::verb || symbol.kind == SymbolKind::word)
    return shown(symbol.name) + " belongs to a device of the robot";
  if (symbol.kind == SymbolKind::module) return shown(symbol.name) + " is a file of its own";
  if (!symbol.is_there && symbol.kind == SymbolKind::label)
    return shown(symbol.name) + " is a word of the sensor, which " + name + " describes";
  if (symbol.declared->file != file)
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
    return !apart && same_name(other.name, name);
  };
  Diagnostics ignored;
  Names names(project.trees, project.robot, ignored);
  const bool taken = std::ranges::any_of(symbols.all(), is_taken) || names.is_verb(name) ||
                     names.is_word(name) || find_function(name) != nullptr;
  const std::string kind = names.kind_of(name);
  if (!kind.empty()) return shown(name) + " is " + kind + " already";
  return taken ? shown(name) + " is a name already" : "";
}

}  // namespace robosync::compiler::query
