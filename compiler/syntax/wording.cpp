// See wording.hpp.
#include "compiler/syntax/wording.hpp"

#include <algorithm>

#include "compiler/diagnostics/nearest.hpp"
#include "compiler/source/utf8.hpp"
#include "compiler/syntax/blocks.hpp"
#include "compiler/syntax/habits.hpp"
#include "compiler/syntax/keyword_roles.hpp"
#include "compiler/syntax/unit_apart.hpp"

namespace robosync::compiler {

namespace {

bool expects(const std::vector<TokenKind>& expected, TokenKind kind) {
  return std::find(expected.begin(), expected.end(), kind) != expected.end();
}

constexpr std::string_view kOutside =
    "a line outside a block starts with a word such as WHEN, DEFINE or BEHAVIOR";

class Explainer {
public:
  Explainer(const Mistake& mistake, Diagnostics& diagnostics)
      : tokens_(mistake.tokens),
        source_(mistake.source),
        failure_(mistake.failure),
        edit_(mistake.edit),
        examples_(mistake.examples),
        diagnostics_(diagnostics) {}

  void explain() {
    if (for_behind_modifier()) return;
    switch (edit_.what) {
      case Edit::What::respell:
        return misspelt();
      case Edit::What::insert:
        return missing();
      case Edit::What::close_blocks:
        return not_closed(ends_inserted());
      case Edit::What::remove:
        return too_much();
      case Edit::What::replace:
        return something_else();
      case Edit::What::swap:
        return wrong_order();
      case Edit::What::skip:
        return unexpected();
    }
  }

private:
  // ---- parts of sentences

  // Shortens long texts: the snippet shows them anyway.
  std::string quote(std::size_t at) const {
    constexpr std::size_t longest = 40;
    std::string_view text = source_.text(tokens_[at].span);
    if (text.size() <= longest) return "`" + std::string(text) + "`";
    return "`" + std::string(text.substr(0, longest)) + "...`";
  }

  std::string found(std::size_t at) const {
    if (at >= tokens_.size()) return "the end";
    const TokenKind kind = tokens_[at].kind;
    if (kind == Kinds::NEWLINE) return "the end of the line";
    const Span span = tokens_[at].span;
    return span.begin == span.end ? describe(kind) : quote(at);
  }

  // The token that the grammar had taken before the one at `at`.
  std::size_t before(std::size_t at) const {
    if (at == failure_.stopped_at) return failure_.before;
    return at == 0 ? 0 : at - 1;
  }

  bool begins_line(std::size_t at) const {
    const std::size_t last = before(at);
    return last >= at || tokens_[last].kind == Kinds::NEWLINE;
  }

  // True also where the grammar would continue the line before; false if that line is incomplete.
  bool first_in_text_line(std::size_t at) const {
    const bool first = at < tokens_.size() && starts_line(tokens_, at);
    return first && (roles_of(tokens_[before(at)].kind) & role::before) == 0;
  }

  // " after `x`", or nothing at the start of a line.
  std::string after(std::size_t at) const {
    return begins_line(at) ? "" : " after " + found(before(at));
  }

  Span place(std::size_t at) const {
    if (at < tokens_.size() && tokens_[at].kind != Kinds::NEWLINE) return tokens_[at].span;
    Span span = tokens_[std::min(at, tokens_.size() - 1)].span;
    span.end = span.begin;
    return span;
  }

  std::size_t ends_inserted() const {
    return static_cast<std::size_t>(
        std::count_if(edit_.inserted.begin(), edit_.inserted.end(),
                      [](const Token& token) { return token.kind == Kinds::END; }));
  }

  bool outside_blocks() const {
    return expects(failure_.expected, Kinds::DEFINE) && expects(failure_.expected, Kinds::WHEN);
  }

  // `WHEN x < 3 MARGIN 1 FOR 2s`
  bool for_behind_modifier() {
    std::size_t at = failure_.stopped_at;
    while (at < tokens_.size() && tokens_[at].kind == Kinds::NEWLINE)
      ++at;
    if (at >= tokens_.size() || tokens_[at].kind != Kinds::FOR) return false;
    std::size_t modifier = at;
    std::size_t back = at;
    while (back > 0 && !ends_search(tokens_[back].kind))
      if (is_modifier(tokens_[--back].kind)) modifier = back;
    const bool in_head = tokens_[back].kind == Kinds::WHEN || tokens_[back].kind == Kinds::WHILE;
    if (modifier == at || !in_head) return false;
    const std::string word = quote(modifier);
    diagnostics_.report(Code::E0001, "`FOR` belongs to the condition: it goes before " + word)
        .label(tokens_[at].span)
        .label(tokens_[modifier].span, "this goes after it", false)
        .helps("write `FOR` and its time first, then " + word);
    return true;
  }

  static bool is_modifier(TokenKind kind) {
    return kind == Kinds::PRIORITY || kind == Kinds::COOLDOWN || kind == Kinds::MARGIN ||
           kind == Kinds::WAITING || kind == Kinds::RESTARTING;
  }
  // The head of the rule begins or ends here.
  static bool ends_search(TokenKind kind) {
    return kind == Kinds::WHEN || kind == Kinds::WHILE || kind == Kinds::DO;
  }

  // ---- one for each kind of edit

  void misspelt() {
    const std::string better(edit_.keyword->spelling);
    diagnostics_.report(Code::E0007, "RSL does not know the word " + quote(edit_.at) + " here")
        .label(tokens_[edit_.at].span, "did you mean `" + better + "`?")
        .fix(tokens_[edit_.at].span, better,
             is_only_slip() && !stands_twice(edit_.at) ? Applicability::certain
                                                       : Applicability::likely);
  }

  // True when this is the only word of RSL within one typing slip.
  bool is_only_slip() const {
    const std::string_view word = source_.text(tokens_[edit_.at].span);
    const auto one_slip = [word](const Keyword& keyword) {
      return is_near(word, keyword.spelling) && mistakes(word, keyword.spelling) == 1;
    };
    return one_slip(*edit_.keyword) && std::ranges::count_if(keywords(), one_slip) == 1;
  }

  // The place of a missing token: after the token before it, not at the start of the next line.
  Span gap() const {
    Span span = edit_.inserted.front().span;
    if (!begins_line(edit_.at)) span.begin = span.end = tokens_[before(edit_.at)].span.end;
    return span;
  }

  // After the last word before the token, never at the start of a line.
  Span gap_before(std::size_t at) const {
    Span span = last_word_before(at);
    span.begin = span.end;
    return span;
  }

  void missing() {
    const TokenKind kind = edit_.inserted.front().kind;
    if (kind == Kinds::END) return not_closed(1);
    if (kind == Kinds::NEWLINE) {
      if (!report_unit_apart(tokens_, source_, edit_.at, diagnostics_)) line_goes_on();
      return;
    }
    if ((kind == Kinds::TIMES && bare_brackets()) || then_for_do(kind)) return;
    const std::string what = what_is_missing(kind, *edit_.expected);
    const std::string where = after(edit_.at);
    const bool first = where.empty() && edit_.at < tokens_.size();
    Diagnostic& message = diagnostics_.report(
        Code::E0008, what + " is missing" + (first ? " before " + found(edit_.at) : where));
    message.label(gap(), first ? "" : "here");
    const bool word = is_keyword(kind);
    // Only likely: another word may be missing, or more than this one.
    if (word && !first) message.fix(gap(), " " + plain(kind), Applicability::likely);
    if (word && first) message.fix(gap(), plain(kind) + " ", Applicability::likely);
    if (!word) show_line(message, edit_.at, *edit_.expected);
    if (where.empty() && outside_blocks() && word) message.helps(std::string(kOutside));
  }

  // Shows how a line of this kind is written, or how a line can begin here.
  void show_line(Diagnostic& message, std::size_t at,
                 const std::vector<TokenKind>& expected) const {
    const bool statement = expects(expected, Kinds::SET) && expects(expected, Kinds::WAIT);
    const bool known = !statement && !first_in_text_line(at);
    const std::string example = known ? examples_.written_like(tokens_, at) : "";
    if (!example.empty()) {
      message.helps(example);
    } else if (outside_blocks()) {
      message.helps(std::string(kOutside));
    } else if (expects(expected, Kinds::SEED) && expects(expected, Kinds::EXPECT)) {
      message.helps("a step begins with `AT`, `EXPECT` or `WAIT`");
    } else if (statement) {
      message.helps("write a command here, such as `" + examples_.command() +
                    "`, or a line with a word such as `SET`, `WAIT` or `IF`");
    }
  }

  // `MOVE base FORWARD (touch LEVEL * 1cm)`: TIMES after it would make it another command.
  bool bare_brackets() {
    const std::size_t last = before(edit_.at);
    if (last >= tokens_.size() || tokens_[last].kind != Kinds::CLOSE) return false;
    std::size_t first = last;
    for (std::size_t open = 1; open > 0 && first > 0;) {
      --first;
      if (tokens_[first].kind == Kinds::CLOSE) ++open;
      if (tokens_[first].kind == Kinds::OPEN) --open;
    }
    Span span = tokens_[first].span;
    span.end = tokens_[last].span.end;
    diagnostics_.report(Code::E0008, "this does not say what the number in brackets is for")
        .label(span)
        .helps("write TO, BY, AT, OVER or FOR before it, such as `BY (…)`, or TIMES after it");
    return true;
  }

  static std::string plain(TokenKind kind) {
    std::string text = describe(kind);
    text.erase(std::remove(text.begin(), text.end(), '`'), text.end());
    return text;
  }

  void line_goes_on() {
    const bool line_over = edit_.at >= tokens_.size() || tokens_[edit_.at].kind == Kinds::NEWLINE;
    if (line_over) {
      diagnostics_.report(Code::E0001, "this line ends too early")
          .label(gap_before(edit_.at), "here");
      return;
    }
    diagnostics_.report(Code::E0001, found(edit_.at) + " must be on a line of its own")
        .label(place(edit_.at), "the line should have ended before this");
  }

  void not_closed(std::size_t count) {
    for (const OpenBlock& block : open_blocks(tokens_, failure_.stopped_at, count, source_)) {
      Diagnostic& message = diagnostics_.report(
          Code::E0005, "this " + quote(block.opener) + " is not closed with `END`");
      message.label(tokens_[block.opener].span, "the block begins here");
      const bool before_a_word =
          block.missed < tokens_.size() && tokens_[block.missed].kind != Kinds::NEWLINE;
      if (before_a_word) {
        message.label(place(block.missed), "`END` is missing before this", false);
      } else {
        message.label(last_word_before(block.missed), "`END` is missing after this", false);
      }
    }
  }

  Span last_word_before(std::size_t at) const {
    std::size_t last = std::min(at, tokens_.size());
    while (last > 1 && tokens_[last - 1].kind == Kinds::NEWLINE)
      --last;
    return last > 0 ? tokens_[last - 1].span : Span{};
  }

  void too_much() {
    const Token& token = tokens_[edit_.at];
    if (token.kind == Kinds::END) return idle_end();
    if (token.kind == Kinds::NEWLINE) {
      Diagnostic& message =
          diagnostics_.report(Code::E0001, "this line ends too early" + after(edit_.at));
      message.label(place(edit_.at), "here");
      show_line(message, edit_.at, failure_.expected);
      return;
    }
    if (report_unit_apart(tokens_, source_, edit_.at, diagnostics_) || texts_added(edit_.at) ||
        nothing_follows())
      return;
    Diagnostic& message =
        diagnostics_.report(Code::E0009, quote(edit_.at) + " does not belong here");
    if (belongs_to_number(edit_.at) || (says_what_is_done(token.kind) && !stands_twice(edit_.at))) {
      message.label(token.span);  // without it, the number or the program would mean something else
    } else {
      message.label(token.span, "leave this out")
          .fix(token.span, "",
               stands_twice(edit_.at) ? Applicability::certain : Applicability::likely);
    }
    if (message.fixes.empty() || !stands_twice(edit_.at)) show_line(message, edit_.at, {});
  }

  // `WHEN` or `DEFINE` alone in a line, which the grammar would leave out, or what follows it.
  bool nothing_follows() {
    const std::size_t head = begins_alone(edit_.at) ? edit_.at : failure_.before;
    if (head > edit_.at || !begins_alone(head)) return false;
    const Span word = tokens_[head].span;
    Diagnostic& message =
        diagnostics_.report(Code::E0008, "the rest of the line is missing after " + quote(head));
    message.label({word.file, word.end, word.end}, "here");
    const std::string example = examples_.written_like(tokens_, head + 1);
    if (!example.empty()) message.helps(example);
    return true;
  }
  bool begins_alone(std::size_t at) const {
    const bool ends = at + 1 >= tokens_.size() || tokens_[at + 1].kind == Kinds::NEWLINE;
    return ends && starts_line(tokens_, at) &&
           ((roles_of(tokens_[at].kind) & role::item) != 0 ||
            is_one_of(tokens_[at].kind, {Kinds::WHEN, Kinds::WHILE}));
  }

  // Without such a word the line or the block would do something else: a mistake next to it is more likely.
  static bool says_what_is_done(TokenKind kind) {
    return is_one_of(kind, {Kinds::NOT, Kinds::ELSE, Kinds::RESUME, Kinds::OTHERWISE}) ||
           (roles_of(kind) & (role::item | role::statement)) != 0;
  }

  // A token written twice in a row is meant once. Any other extra token may lack something next to it. Between two commas
  // something may be missing, the other bracket may be elsewhere, and removing a NOT is never certain.
  bool stands_twice(std::size_t at) const {
    const auto same = [&](std::size_t other) {
      return other < tokens_.size() && tokens_[other].kind == tokens_[at].kind &&
             quote(other) == quote(at);
    };
    const bool never =
        is_one_of(tokens_[at].kind, {Kinds::COMMA, Kinds::NOT, Kinds::OPEN, Kinds::CLOSE});
    return !never && (same(at + 1) || (at > 0 && same(at - 1)));
  }

  // `"You have" + points`, as other languages join texts.
  bool texts_added(std::size_t at) {
    const auto is_text = [this](std::size_t place) {
      return place < tokens_.size() && tokens_[place].kind == Kinds::STRING;
    };
    if (at > 0 && is_text(at)) --at;
    if (at >= tokens_.size() || source_.text(tokens_[at].span) != "+") return false;
    if (!is_text(at + 1) && (at == 0 || !is_text(at - 1))) return false;
    diagnostics_.report(Code::E0009, "`+` does not join texts")
        .label(tokens_[at].span)
        .helps("write a comma between the parts: `\"You have\", points`")
        .fix(tokens_[at].span, ",", Applicability::likely);
    return true;
  }

  bool is_number(std::size_t at) const {
    return at < tokens_.size() && tokens_[at].kind == Kinds::QUANTITY;
  }

  bool belongs_to_number(std::size_t at) const {
    switch (tokens_[at].kind) {
      case Kinds::QUANTITY:
      case Kinds::PLUS:
      case Kinds::MINUS:
      case Kinds::STAR:
      case Kinds::SLASH:
        return true;
      default:
        return is_number(at + 1) ||
               (at > 0 && is_number(at - 1) && tokens_[at].kind == Kinds::COMMA);
    }
  }

  // An IF whose END is before an ELSE that was meant for it, so that a later END is one too many.
  std::optional<IdleEnd> ended_before_else() const {
    BlockWalk walk(tokens_);
    for (std::size_t at = 0; at < edit_.at; ++at) {
      walk.step(at);
      if (tokens_[at].kind != Kinds::END || walk.end_was_idle()) continue;
      std::size_t next = at + 1;
      while (next < edit_.at && tokens_[next].kind == Kinds::NEWLINE)
        ++next;
      const std::size_t block = walk.closed();
      const std::size_t first = next == at + 1 ? at : next;  // of the line with the ELSE
      if (tokens_[next].kind == Kinds::ELSE && tokens_[block].kind == Kinds::IF &&
          starts_line(tokens_, first) && starts_line(tokens_, block) &&
          indentation(tokens_[first], source_) == indentation(tokens_[block], source_))
        return IdleEnd{block, at};
    }
    return std::nullopt;
  }

  void idle_end() {
    if (const auto early = ended_before_else()) {
      const Span end = tokens_[early->by].span;
      diagnostics_.report(Code::E0010, "`ELSE` takes no `END` before it")
          .label(end)
          .label(tokens_[early->closed].span, "the block begins here", false)
          .helps("one `END`, after the `ELSE` part, closes both")
          .fix(end, "", Applicability::likely);
      return;
    }
    Diagnostic& message = diagnostics_.report(Code::E0006, "this `END` closes nothing");
    message.label(tokens_[edit_.at].span);
    if (const auto early = early_end(tokens_, edit_.at, source_)) {
      message.label(tokens_[early->by].span, "this one already closed the block", false);
      message.label(tokens_[early->closed].span, "the block begins here", false);
    }
    const auto goes_on = [](const Token& token) { return token.kind == Kinds::ELSE_IF; };
    if (std::any_of(tokens_.begin(), tokens_.begin() + static_cast<std::ptrdiff_t>(edit_.at),
                    goes_on))
      message.helps("one `END` closes an IF with all its ELSE IFs");
  }

  void something_else() {
    const TokenKind wanted = edit_.inserted.front().kind;
    const TokenKind kind = tokens_[edit_.at].kind;
    if (wanted == Kinds::NAME && is_keyword(kind)) {
      const bool value = edit_.at > 0 && (roles_of(kind) & role::name) != 0 &&
                         is_preposition(tokens_[edit_.at - 1].kind);
      diagnostics_
          .report(Code::E0010, quote(edit_.at) + " is a word of RSL and cannot be a name" +
                                   (value ? " here" : ""))
          .label(place(edit_.at),
                 value ? "write it in brackets, or choose another name" : "choose another name");
      return;
    }
    if (wanted == Kinds::IF && (roles_of(kind) & role::part) != 0) return rule_inside();
    if (then_for_do(wanted)) return;
    if (edit_.at == failure_.stopped_at) return unexpected();
    Diagnostic& message =
        diagnostics_.report(Code::E0001, found(edit_.at) + " does not fit here" + after(edit_.at));
    message.label(place(edit_.at), what_is_missing(wanted, {}) + " would fit");
    if (is_keyword(wanted)) message.fix(place(edit_.at), plain(wanted), Applicability::likely);
    show_line(message, edit_.at, failure_.expected);
  }

  // A THEN in place of DO, or in front of one. THEN may also begin a second condition.
  bool then_for_do(TokenKind wanted) {
    const std::size_t at = edit_.at;
    if (wanted != Kinds::DO || at == 0 || tokens_[at].kind != Kinds::THEN || !asks_before(at))
      return false;
    std::size_t next = at + 1;
    while (next < tokens_.size() && tokens_[next].kind == Kinds::NEWLINE)
      ++next;
    const bool has_do = next < tokens_.size() && tokens_[next].kind == Kinds::DO;
    Span then = place(at);
    Diagnostic& message =
        diagnostics_.report(Code::E0001, "a condition ends with `DO` in RSL, not with `THEN`")
            .label(then);
    if (has_do) then.begin = tokens_[at - 1].span.end;
    message.fix(then, has_do ? "" : "DO", Applicability::likely);
    return true;
  }

  // Is this still the line that asks: WHEN, WHILE, IF?
  bool asks_before(std::size_t at) const {
    while (at > 0 && !begins_something(tokens_[at - 1].kind))
      --at;
    return at > 0 &&
           is_one_of(tokens_[at - 1].kind, {Kinds::WHEN, Kinds::WHILE, Kinds::IF, Kinds::ELSE_IF});
  }
  static bool begins_something(TokenKind kind) {
    return is_one_of(kind, {Kinds::DO, Kinds::ELSE, Kinds::ELSE_IF, Kinds::END}) ||
           (kind != Kinds::THEN && (roles_of(kind) & (role::opens | role::statement)) != 0);
  }

  void rule_inside() {
    diagnostics_.report(Code::E0010, quote(edit_.at) + " cannot be used inside a response")
        .label(place(edit_.at), "a rule belongs outside, or in a BEHAVIOR")
        .helps(std::string(in_response(tokens_[edit_.at].kind)))
        .helps("to start another rule, close the response with `END` first");
  }

  void wrong_order() {
    if (tokens_[edit_.at + 1].kind == Kinds::NEWLINE && is_keyword(tokens_[edit_.at].kind)) {
      diagnostics_
          .report(Code::E0010, quote(edit_.at) + " is a word of RSL and cannot be a name here")
          .label(tokens_[edit_.at].span, "choose another name");
      return;
    }
    const Span first = tokens_[edit_.at].span;
    const Span second = tokens_[edit_.at + 1].span;
    diagnostics_
        .report(Code::E0001,
                quote(edit_.at) + " and " + found(edit_.at + 1) + " are in the wrong order")
        .label({first.file, first.begin, second.end});
  }

  static bool is_comparison(TokenKind kind) { return is_relation(kind) || kind == Kinds::IS; }

  // `0 < x < 3`
  bool is_chained() const {
    std::size_t at = failure_.stopped_at;
    if (at >= tokens_.size() || !is_comparison(tokens_[at].kind)) return false;
    if (!expects(failure_.expected, Kinds::AND)) return false;
    while (at > 0 && tokens_[at - 1].kind != Kinds::NEWLINE) {
      if (is_comparison(tokens_[--at].kind)) return true;
    }
    return false;
  }

  void unexpected() {
    const std::size_t at = failure_.stopped_at;
    if (is_chained()) {
      diagnostics_.report(Code::E0001, "a comparison has two sides; this is a third")
          .label(place(at))
          .helps("compare twice: `0 < x AND x < 3`, or write `x IS BETWEEN 0 AND 3`");
      return;
    }
    if (texts_added(at)) return;
    Diagnostic& message = diagnostics_.report(Code::E0001, cannot_stand(at));
    message.label(place(at));
    const bool command = at < tokens_.size() && tokens_[at].kind == Kinds::NAME;
    if (outside_blocks() && command)
      message.helps("commands belong in a rule or a DEFINE: `WHEN ... DO ... END`");
    else
      show_line(message, at, failure_.expected);
  }

  std::string cannot_stand(std::size_t at) const {
    if (at >= tokens_.size()) return "the file ends too early";
    if (tokens_[at].kind == Kinds::NEWLINE) return "this line ends too early" + after(at);
    return first_in_text_line(at) ? "a line cannot begin with " + found(at) + " here"
                                  : found(at) + " is not allowed" + after(at);
  }

  const Tokens& tokens_;
  const SourceFile& source_;
  const Attempt& failure_;
  const Edit& edit_;
  const Examples& examples_;
  Diagnostics& diagnostics_;
};

}  // namespace

void explain(const Mistake& mistake, Diagnostics& diagnostics) {
  Explainer(mistake, diagnostics).explain();
}

}  // namespace robosync::compiler
