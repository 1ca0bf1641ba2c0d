// See condition_behind.hpp.
#include "compiler/syntax/condition_behind.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "compiler/syntax/keyword_roles.hpp"

namespace robosync::compiler {

Tokens condition_first(const Tokens& tokens, TokenRange line, const SourceFile& source,
                       Diagnostics& diagnostics) {
  const Token& first = tokens[line.begin];
  const auto is_command =
      is_one_of(first.kind, {Kinds::NAME, Kinds::STOP, Kinds::SET, Kinds::LOG, Kinds::RAISE});
  std::size_t asks = line.begin + 1;
  while (asks < line.end && !is_one_of(tokens[asks].kind, {Kinds::WHEN, Kinds::IF}))
    ++asks;
  const auto begin = tokens.begin();
  const auto at = [&](std::size_t index) { return begin + static_cast<std::ptrdiff_t>(index); };
  const bool has_block = std::any_of(at(line.begin), at(line.end), [](const Token& token) {
    return is_one_of(token.kind, {Kinds::DO, Kinds::THEN, Kinds::ELSE, Kinds::ELSE_IF,
                                  Kinds::OPTION, Kinds::RESUME, Kinds::END});
  });
  // `points IF > 4` is another slip.
  if (!is_command || asks + 1 >= line.end || has_block || is_relation(tokens[asks + 1].kind))
    return {};
  const auto text = [&](std::size_t from, std::size_t to) {
    return source.text({first.span.file, tokens[from].span.begin, tokens[to - 1].span.end});
  };
  const std::string better =
      fmt::format("IF {} DO {} END", text(asks + 1, line.end), text(line.begin, asks));
  Span end = tokens[line.end - 1].span;
  diagnostics.report(Code::E0001, "a condition stands before its command, not behind it")
      .label({end.file, tokens[asks].span.begin, end.end})
      .helps(fmt::format("write `{}`", better))
      .fix({end.file, first.span.begin, end.end}, better, Applicability::likely);
  end.begin = end.end;
  Tokens mended{{Kinds::IF, tokens[asks].span}};
  mended.insert(mended.end(), at(asks + 1), at(line.end));
  mended.push_back({Kinds::DO, end});
  mended.insert(mended.end(), at(line.begin), at(asks));
  mended.push_back({Kinds::END, end});
  return mended;
}

}  // namespace robosync::compiler
