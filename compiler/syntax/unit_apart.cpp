// See unit_apart.hpp.
#include "compiler/syntax/unit_apart.hpp"

#include <string>
#include <string_view>

#include "compiler/source/ascii.hpp"
#include "compiler/units/foreign_units.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler {

namespace {

bool ends_with_digit(const Token& token, const SourceFile& source) {
  const std::string_view number = source.text(token.span);
  return token.kind == Kinds::QUANTITY && !number.empty() && ascii::is_digit(number.back());
}

}  // namespace

bool is_behind_digits(const Tokens& tokens, const SourceFile& source, std::size_t at) {
  return at > 0 && at < tokens.size() && tokens[at].kind == Kinds::NAME &&
         ends_with_digit(tokens[at - 1], source);
}

bool is_decimal_comma(const Tokens& tokens, const SourceFile& source, std::size_t comma) {
  if (comma == 0 || comma + 1 >= tokens.size()) return false;
  const Token &whole = tokens[comma - 1], &decimals = tokens[comma + 1];
  return tokens[comma].kind == Kinds::COMMA && ends_with_digit(whole, source) &&
         decimals.kind == Kinds::QUANTITY && decimals.span.begin == whole.span.end + 1;
}

bool report_unit_apart(const Tokens& tokens, const SourceFile& source, std::size_t at,
                       Diagnostics& diagnostics) {
  if (!is_behind_digits(tokens, source, at)) return false;
  const Span number = tokens[at - 1].span;
  const std::string unit(source.text(tokens[at].span));
  const Unit* const known = find_unit(unit);
  const std::string_view foreign = foreign_unit(unit);
  const std::string_view ours = known != nullptr ? known->spelling : unit_word(unit);
  if (ours.empty() && foreign.empty()) return false;
  std::string why = "a unit follows its number without a space";
  if (!foreign.empty())
    why = "`" + unit + "` does not belong here";
  else if (known == nullptr)
    why = "this unit is written `" + std::string(ours) + "` in RSL";
  Diagnostic& message = diagnostics.report(Code::E0009, why).label(tokens[at].span);
  if (!foreign.empty()) {
    message.helps("RSL does not have this unit: " + std::string(foreign));
    return true;
  }
  const std::string better = std::string(source.text(number)) + std::string(ours);
  message.helps("write `" + better + "`")
      .fix({number.file, number.begin, tokens[at].span.end}, better, Applicability::likely);
  return true;
}

std::optional<Edit> explain_unit_apart(const Tokens& tokens, const SourceFile& source,
                                       const Attempt& failure, Diagnostics& diagnostics) {
  const std::size_t at = failure.stopped_at;
  // `60 deg/s` is another mistake: see misplaced_words.cpp.
  if (at + 1 < tokens.size() && tokens[at + 1].kind == Kinds::SLASH) return std::nullopt;
  // `12,5 deg`: see foreign_habits.cpp.
  if (at >= 2 && is_decimal_comma(tokens, source, at - 2)) return std::nullopt;
  if (!report_unit_apart(tokens, source, at, diagnostics)) return std::nullopt;
  Edit leaves_out;
  leaves_out.what = Edit::What::remove;
  leaves_out.at = at;
  leaves_out.removed = 1;
  return leaves_out;
}

}  // namespace robosync::compiler
