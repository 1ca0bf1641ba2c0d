// See torn_names.hpp. Two passes, however many names there are.
#include "compiler/syntax/torn_names.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/rewritten.hpp"

namespace robosync::compiler {
namespace {

struct Torn {
  Span declared;
  std::vector<Span> places;  // all of them
};

bool is_torn(const Tokens& tokens, std::size_t at) {
  return at + 2 < tokens.size() && tokens[at].kind == Kinds::NAME &&
         tokens[at + 1].kind == Kinds::MINUS && tokens[at + 2].kind == Kinds::NAME &&
         tokens[at].span.end == tokens[at + 1].span.begin &&
         tokens[at + 1].span.end == tokens[at + 2].span.begin;
}

Span whole(const Tokens& tokens, std::size_t at) {
  return {tokens[at].span.file, tokens[at].span.begin, tokens[at + 2].span.end};
}

void report(const Torn& name, std::string_view word, Diagnostics& diagnostics) {
  constexpr std::size_t most = 4;  // places shown
  std::string better(word);
  std::ranges::replace(better, '-', '_');
  Diagnostic& message = diagnostics.report(Code::E0001, "a name has only letters, digits and `_`");
  message.label(name.declared).helps("write `" + better + "`");
  std::size_t shown = 1;
  for (const Span place : name.places) {
    message.fix(place, better, Applicability::likely);
    if (place.begin != name.declared.begin && shown++ < most)
      message.label(place, "and here", false);
  }
  if (shown > most) message.appears_in_more(shown - most);
}

}  // namespace

void mend_torn_names(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics) {
  std::map<std::string_view, Torn> names;
  for (std::size_t at = 0; at + 4 < tokens.size(); ++at)
    if (starts_line(tokens, at) && is_torn(tokens, at + 1) &&
        declares(tokens[at].kind, tokens[at + 4].kind))
      names.try_emplace(source.text(whole(tokens, at + 1)), Torn{whole(tokens, at + 1), {}});
  if (names.empty()) return;
  Rewritten rewritten(tokens);
  for (std::size_t at = 0; at < tokens.size(); ++at) {
    const auto name =
        is_torn(tokens, at) ? names.find(source.text(whole(tokens, at))) : names.end();
    if (name == names.end()) {
      rewritten.keep(at);
      continue;
    }
    name->second.places.push_back(whole(tokens, at));
    rewritten.other(at).push_back({Kinds::NAME, whole(tokens, at)});
    at += 2;
  }
  rewritten.finish();
  for (const auto& [word, name] : names)
    report(name, word, diagnostics);
}

}  // namespace robosync::compiler
