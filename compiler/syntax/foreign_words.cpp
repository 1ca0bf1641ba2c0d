// See foreign_words.hpp.
#include "compiler/syntax/foreign_words.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/word_list.hpp"

namespace robosync::compiler {
namespace {

struct Translation {
  TokenKind kind;
  std::string_view word, foreign;
};
constexpr std::array kTranslations = {
#define FOREIGN(word, foreign) Translation{Kinds::word, #word, foreign},
#include "compiler/syntax/foreign_words.def"
#undef FOREIGN
};

const Translation* translation(std::string_view word) {
  const auto* const found = std::ranges::find_if(
      kTranslations, [word](const Translation& one) { return has_word(one.foreign, word); });
  return found == kTranslations.end() ? nullptr : found;
}

class ForeignWords {
public:
  ForeignWords(Tokens& tokens, const SourceFile& source, const Vocabulary* robot)
      : tokens_(tokens), source_(source), robot_(robot), walk_(tokens) {}

  // Quick where there are none.
  [[nodiscard]] bool any() {
    for (std::size_t at = 0; at + 1 < tokens_.size(); ++at) {
      if (tokens_[at].kind != Kinds::NAME || !starts_line(tokens_, at)) continue;
      if (may_be_command(at) || may_be_call_or_band(at)) continue;
      const Translation* const meant = meant_at(at);
      // A slip of a word of RSL, such as ENDE, is no sign of another language.
      if (meant != nullptr && !is_near(text(at), meant->word)) return true;
    }
    return false;
  }

  void mend(Diagnostic& message) {
    for (std::size_t at = 0; at < tokens_.size(); ++at) {
      const Translation* const meant = meant_at(at);
      if (meant != nullptr) translate(at, *meant, message);
      walk_.step(at);
    }
    message.helps(help_);
  }

private:
  [[nodiscard]] std::string_view text(std::size_t at) const {
    return source_.text(tokens_[at].span);
  }

  // Commands are indented, and a name follows their verb.
  [[nodiscard]] bool may_be_command(std::size_t at) const {
    const bool asks = at + 3 < tokens_.size() && is_relation(tokens_[at + 3].kind);
    return is_one_of(tokens_[at + 1].kind, {Kinds::NAME, Kinds::STRING}) && !asks &&
           indentation(tokens_[at], source_) > 0;
  }
  // Of a DEFINE, which may be another module's; of a CHECK.
  [[nodiscard]] bool may_be_call_or_band(std::size_t at) const {
    return is_one_of(tokens_[at + 1].kind, {Kinds::NEWLINE, Kinds::WITH, Kinds::BELOW, Kinds::ABOVE,
                                            Kinds::BETWEEN, Kinds::OTHERWISE});
  }

  // Null when it is a name of the program or of the robot.
  [[nodiscard]] const Translation* meant_at(std::size_t at) {
    if (tokens_[at].kind != Kinds::NAME) return nullptr;
    const Translation* const meant = translation(text(at));
    return meant == nullptr || is_name(text(at)) ? nullptr : meant;
  }
  [[nodiscard]] bool is_name(std::string_view word) {
    if (knows(robot_, word)) return true;
    if (declared_.empty()) note_declared();
    return declared_.contains(lower(word));
  }

  void note_declared() {
    declared_.insert("");  // not to be looked for again
    for (std::size_t at = 1; at < tokens_.size(); ++at) {
      const TokenKind kind = tokens_[at - 1].kind;
      if (kind == Kinds::REMEMBER || (roles_of(kind) & role::item) != 0)
        declared_.insert(lower(text(at)));
    }
  }
  static std::string lower(std::string_view word) {
    std::string text(word);
    std::ranges::transform(text, text.begin(), ascii::lower);
    return text;
  }

  void translate(std::size_t at, const Translation& meant, Diagnostic& message) {
    constexpr std::size_t most = 5;  // words shown
    Token& token = tokens_[at];
    const bool inside =
        !walk_.open().empty() && tokens_[walk_.open().back()].kind != Kinds::BEHAVIOR;
    const bool asks_once = meant.kind == Kinds::WHEN && inside;
    token.kind = asks_once ? TokenKind(Kinds::IF) : meant.kind;
    const std::string word(asks_once ? "IF" : meant.word);
    if (message.labels.empty()) message.label(token.span);
    message.fix(token.span, word, Applicability::likely);
    const std::string instead = fmt::format("`{}` instead of `{}`", word, text(at));
    if (help_.find(instead) != std::string::npos || shown_ == most) return;
    ++shown_;
    help_ += (help_.empty() ? "write " : ", ") + instead;
  }

  Tokens& tokens_;
  const SourceFile& source_;
  const Vocabulary* robot_;
  BlockWalk walk_;
  std::set<std::string> declared_;
  std::string help_;
  std::size_t shown_ = 0;
};

}  // namespace

void mend_foreign_words(Tokens& tokens, const SourceFile& source, const Vocabulary* robot,
                        Diagnostics& diagnostics) {
  ForeignWords words(tokens, source, robot);
  if (words.any()) words.mend(diagnostics.report(Code::E0007, "the words of RSL are English"));
}

}  // namespace robosync::compiler
