// See pasted.hpp. A line of RSL may begin with a number or a sign only where it continues the one above, so what counts is a line in
// which a word such as WHEN follows, or one that stands below DO.
#include "compiler/syntax/pasted.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "compiler/source/ascii.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/keyword_roles.hpp"

namespace robosync::compiler {
namespace {

constexpr std::string_view kFence = "```";

class Pasted {
public:
  Pasted(Tokens& tokens, const SourceFile& source, Diagnostics& diagnostics)
      : tokens_(tokens), source_(source), diagnostics_(diagnostics) {}

  std::vector<Span> leave_out() {
    for (const TokenKind kind : {TokenKind(Kinds::QUANTITY), TokenKind(Kinds::GREATER),
                                 TokenKind(Kinds::MINUS), TokenKind(Kinds::STAR)})
      leave_out_marks(kind);
    leave_out_fences();
    return std::move(places_);
  }

private:
  // `1.`, `1)`, `>`, `-` or `*`, and the index behind it; `at` if there is none of this kind.
  [[nodiscard]] std::size_t behind_mark(std::size_t at, TokenKind kind) const {
    if (tokens_[at].kind != kind || !starts_line(tokens_, at)) return at;
    if (kind != TokenKind(Kinds::QUANTITY)) return at + 1;
    const std::string_view number = source_.text(tokens_[at].span);
    const std::size_t digits = std::min(number.find_first_not_of("0123456789"), number.size());
    if (digits == 0 || !(number.substr(digits).empty() || number.substr(digits) == ".")) return at;
    const bool closed = at + 1 < tokens_.size() && tokens_[at + 1].kind == Kinds::CLOSE;
    return closed ? at + 2 : at + 1;
  }

  // AT may also stand in a command, whose number is on this line.
  [[nodiscard]] bool begins_item(std::size_t at) const {
    return at < tokens_.size() && tokens_[at].kind != Kinds::AT &&
           (roles_of(tokens_[at].kind) & (role::item | role::part)) != 0;
  }

  // Does a command have to stand in this line?
  [[nodiscard]] bool is_behind_do(std::size_t at) const {
    while (at > 0 && tokens_[at - 1].kind == Kinds::NEWLINE)
      --at;
    return at > 0 && is_one_of(tokens_[at - 1].kind, {Kinds::DO, Kinds::THEN, Kinds::ELSE});
  }

  void leave_out_marks(TokenKind kind) {
    const std::size_t before = places_.size();
    bool sure = false;
    for (std::size_t at = 0; at < tokens_.size();) {
      const std::size_t behind = behind_mark(at, kind);
      if (behind == at) {
        ++at;
        continue;
      }
      sure = sure || begins_item(behind) || is_behind_do(at);
      Span place = tokens_[at].span;
      place.end = tokens_[behind - 1].span.end;
      places_.push_back(place);
      at = behind;
    }
    if (!sure) {
      places_.resize(before);
      return;
    }
    erase_tokens(before);
    report(before, kind == TokenKind(Kinds::QUANTITY)
                       ? "lines of RSL have no numbers"
                       : "a line of RSL begins with a word, not with `" +
                             std::string(source_.text(places_[before])) + "`");
  }

  // The lines with three ` before and behind a program in a page.
  void leave_out_fences() {
    const std::size_t before = places_.size();
    if (source_.text().find(kFence) == std::string_view::npos) return;
    for (std::uint32_t number = 1; number <= source_.lines(); ++number) {
      const std::string_view line = ascii::trimmed(source_.line(number));
      if (!line.starts_with(kFence)) continue;
      const auto begin = static_cast<std::uint32_t>(line.data() - source_.text().data());
      places_.push_back(
          {tokens_.front().span.file, begin, begin + static_cast<std::uint32_t>(line.size())});
    }
    if (places_.size() == before) return;
    erase_tokens(before);
    report(before, "``` marks a program in a page, and does not belong to it");
  }

  // Those in the places from `first` on, which are in the order of the text.
  void erase_tokens(std::size_t first) {
    auto place = places_.cbegin() + static_cast<std::ptrdiff_t>(first);
    std::erase_if(tokens_, [&](const Token& token) {
      while (place != places_.cend() && place->end <= token.span.begin)
        ++place;
      return place != places_.cend() && place->begin <= token.span.begin &&
             token.kind != Kinds::NEWLINE;
    });
  }

  void report(std::size_t first, const std::string& what) {
    constexpr std::size_t most = 4;  // places shown
    Diagnostic& message = diagnostics_.report(Code::E0009, what);
    message.label(places_[first], "leave this out");
    const std::size_t shown = std::min(places_.size(), first + most);
    for (std::size_t at = first + 1; at < shown; ++at)
      message.label(places_[at], "and here", false);
    message.appears_in_more(places_.size() - shown);
    for (std::size_t at = first; at < places_.size(); ++at) {
      Span all = places_[at];
      while (all.end < source_.text().size() && source_.text()[all.end] == ' ')
        ++all.end;
      message.fix(all, "", Applicability::likely);
    }
  }

  Tokens& tokens_;
  const SourceFile& source_;
  Diagnostics& diagnostics_;
  std::vector<Span> places_;
};

}  // namespace

std::vector<Span> leave_out_pasted(Tokens& tokens, const SourceFile& source,
                                   Diagnostics& diagnostics) {
  if (tokens.empty()) return {};
  return Pasted(tokens, source, diagnostics).leave_out();
}

}  // namespace robosync::compiler
