// See json_mistakes.hpp. The parser's message is only used to tell whether a colon was expected, or a number was too large.
#include "compiler/config/json_mistakes.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "compiler/config/values.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/source/character_names.hpp"
#include "compiler/source/json.hpp"
#include "compiler/source/utf8.hpp"
#include "compiler/units/units.hpp"

namespace robosync::compiler::json {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '+' ||
         c == '-';
}

// The text that the parser rejected, and the last character before it that is not white space.
struct WrongText {
  std::size_t begin = 0, end = 0;
  std::size_t before = 0;  // its index; valid if `previous` is not 0
  char previous = 0;
};

WrongText find_wrong_text(const Mistake& mistake) {
  const std::string_view text = mistake.text;
  std::size_t first = mistake.good_until;
  while (first < text.size() && (is_space(text[first]) || text[first] == ',' || text[first] == ':'))
    ++first;
  WrongText wrong;
  wrong.begin = std::min(mistake.stopped_at == 0 ? 0 : mistake.stopped_at - 1, text.size());
  wrong.end = std::min(wrong.begin + 1, text.size());
  const bool whole_string = wrong.begin < text.size() && first < wrong.begin &&
                            text[first] == '"' && text[wrong.begin] == '"';
  if (whole_string) {
    wrong.begin = first;
  } else if (first < wrong.end && is_word(text[first])) {
    wrong.begin = first;
    wrong.end = first + 1;
  }
  if (wrong.begin < text.size() && is_word(text[wrong.begin])) {
    while (wrong.begin > 0 && is_word(text[wrong.begin - 1]))
      --wrong.begin;
    while (wrong.end < text.size() && is_word(text[wrong.end]))
      ++wrong.end;
  }
  for (std::size_t i = wrong.begin; i > 0; --i) {
    if (is_space(text[i - 1])) continue;
    wrong.before = i - 1;
    wrong.previous = text[i - 1];
    break;
  }
  return wrong;
}

bool ends_value(char c) {
  return c == '"' || c == '}' || c == ']' || std::isalnum(static_cast<unsigned char>(c)) != 0;
}

bool mentions(const Mistake& mistake, std::string_view words) {
  return mistake.reason.find(words) != std::string_view::npos;
}

Diagnostic& at_end(const Mistake& mistake, Diagnostics& diagnostics) {
  Diagnostic& d =
      diagnostics.report(Code::E0201, mistake.good_until == 0 ? "there is no JSON in this file"
                                                              : "the file ends too early");
  if (mistake.open_span) {
    const char bracket = mistake.text[mistake.open_span->begin];
    const Span opened{mistake.file, mistake.open_span->begin, mistake.open_span->begin + 1};
    d.label(opened, std::string("this is not closed with `") + (bracket == '{' ? '}' : ']') + "`",
            false);
  }
  return d;
}

std::string describe_word(std::string_view word) {
  const char c = word.front();
  const bool no_number =
      ascii::same(word, "NaN") || ascii::same(word, "Infinity") || ascii::same(word, "inf");
  if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.' ||
      no_number)
    return "JSON cannot read `" + std::string(word) + "` as a number";
  return "`" + std::string(word) + "` needs double quotes here";
}

std::string describe_character(const Mistake& mistake, const WrongText& wrong) {
  const char c = mistake.text[wrong.begin];
  const auto byte = static_cast<unsigned char>(c);
  if (byte >= 0x80)
    return "JSON does not use " + utf8::describe(utf8::decode(mistake.text, wrong.begin).value) +
           " outside of strings";
  if (c == '\'') return "JSON strings need double quotes";
  if (c == '/' || c == '#' || c == '%') return "JSON has no comments";
  if (byte < 0x20) return "a string runs past the end of its line, or contains a control character";
  if (mistake.good_until > 0 && !mistake.open_span)
    return "there is something after the end of the JSON";
  if (is_word(c)) return describe_word(mistake.text.substr(wrong.begin, wrong.end - wrong.begin));
  return "this is not JSON here";
}

// ---- mistakes with a suggested fix

Span span_of(const Mistake& mistake, std::size_t begin, std::size_t end) {
  return {mistake.file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
}

// A fix is certain only if it makes the whole text JSON: otherwise there is another mistake, and this may be a part of it.
void mend(const Mistake& mistake, Span span, std::string_view replacement, Diagnostic& diagnostic) {
  std::string mended(mistake.text);
  mended.replace(span.begin, span.end - span.begin, replacement);
  diagnostic.fix(span, std::string(replacement),
                 Json::accept(mended) ? Applicability::certain : Applicability::likely);
}

constexpr std::array<char32_t, 8> kCurlyQuotes = {0x2018, 0x2019, 0x201A, 0x201C,
                                                  0x201D, 0x201E, 0xAB,   0xBB};

bool is_curly(char32_t point) {
  return std::ranges::find(kCurlyQuotes, point) != kCurlyQuotes.end();
}

// A string in curly quotes that ends on the same line.
bool is_in_curly_quotes(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  const utf8::CodePoint opening = utf8::decode(mistake.text, wrong.begin);
  if (!is_curly(opening.value)) return false;
  Diagnostic& d =
      diagnostics.report(Code::E0201, "JSON strings need straight quotes, not curly ones")
          .label(span_of(mistake, wrong.begin, wrong.begin + opening.size));
  const std::size_t inner = wrong.begin + opening.size;
  for (std::size_t at = inner; at < mistake.text.size();) {
    const utf8::CodePoint point = utf8::decode(mistake.text, at);
    const bool straight = point.value == '"';
    if (point.value == '\n' || point.value == '\\') break;
    if (straight || is_curly(point.value)) {
      mend(mistake, span_of(mistake, wrong.begin, at + point.size),
           "\"" + std::string(mistake.text.substr(inner, at - inner)) + "\"", d);
      break;
    }
    at += point.size;
  }
  return true;
}

// `True`, as in Python.
bool is_foreign_word(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  const std::string word(mistake.text.substr(wrong.begin, wrong.end - wrong.begin));
  const Span here = span_of(mistake, wrong.begin, wrong.end);
  const bool in_list = mistake.open_span && mistake.text[mistake.open_span->begin] == '[';
  const bool is_value =
      wrong.previous == ':' || (in_list && (wrong.previous == '[' || wrong.previous == ','));
  if (!is_value) return false;
  for (const std::string_view known : {"true", "false"}) {
    if (!ascii::same(word, known) || word == known) continue;
    Diagnostic& d =
        diagnostics
            .report(Code::E0201, "`" + word + "` is written `" + std::string(known) + "` in JSON")
            .label(here);
    mend(mistake, here, known, d);
    return true;
  }
  if (word != "None" && (!ascii::same(word, "null") || word == "null")) return false;
  diagnostics.report(Code::E0201, "JSON has no `" + word + "`")
      .label(here)
      .helps("to leave a value out, remove its key, too");
  return true;
}

// `"name": "cars, "type": …`: the string runs on to the opening quote of the next one.
bool is_unclosed_string(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  const std::string_view text = mistake.text;
  const bool touches = wrong.previous == '"' && wrong.before + 1 == wrong.begin && wrong.begin >= 2;
  if (!touches || std::isalpha(static_cast<unsigned char>(text[wrong.begin])) == 0) return false;
  const std::size_t opening = text.rfind('"', wrong.before - 1);
  if (opening == std::string_view::npos) return false;
  Diagnostic& d = diagnostics.report(Code::E0201, "this text has no closing quote")
                      .label(span_of(mistake, opening, wrong.before));
  const std::size_t last = text.find_last_not_of(" \t", wrong.before - 1);
  if (last > opening + 1 && (text[last] == ',' || text[last] == ':'))
    d.fix(span_of(mistake, last, last), "\"", Applicability::likely);
  return true;
}

// ---- brackets that do not match

char closer_of(char opener) {
  return opener == '{' ? '}' : ']';
}

// True if the brackets outside strings match.
bool is_balanced(std::string_view text) {
  std::string open;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') {
      for (++at; at < text.size() && text[at] != '"'; ++at)
        if (text[at] == '\\') ++at;
    } else if (c == '{' || c == '[') {
      open.push_back(closer_of(c));
    } else if (c == '}' || c == ']') {
      if (open.empty() || open.back() != c) return false;
      open.pop_back();
    }
  }
  return open.empty();
}

// `["0deg", "90deg"}`: there are two possible fixes. Suggests the one with which all brackets of the text match.
bool is_wrong_bracket(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  const char c = mistake.text[wrong.begin];
  if (!mistake.open_span || wrong.previous == ',' || wrong.previous == ':' ||
      (c != '}' && c != ']' && c != ')'))
    return false;
  const std::size_t opening = mistake.open_span->begin;
  const std::string closer(1, closer_of(mistake.text[opening]));
  if (closer[0] == c) return false;
  Diagnostic& d = diagnostics
                      .report(Code::E0201, std::string(closer == "]" ? "a list" : "an object") +
                                               " ends with `" + closer + "`, not with `" + c + "`")
                      .label(span_of(mistake, wrong.begin, wrong.end))
                      .label(span_of(mistake, opening, opening + 1), "opened here", false);
  std::string mended(mistake.text);
  mended.insert(wrong.begin, closer);
  const std::size_t behind = wrong.before + 1;
  if (c != ')' && is_balanced(mended))
    d.helps("`" + closer + "` is missing before it")
        .fix(span_of(mistake, behind, behind), closer, Applicability::likely);
  mended.erase(wrong.begin + 1, 1);
  if (is_balanced(mended))
    d.fix(span_of(mistake, wrong.begin, wrong.end), closer, Applicability::likely);
  return true;
}

// `"sensors": {{"name": "a"}]`
void report_wrong_opener(const Mistake& mistake, std::size_t opening, Diagnostics& diagnostics) {
  const bool list = mistake.text[opening] == '{';
  const std::string better = list ? "[" : "{";
  const Span here = span_of(mistake, opening, opening + 1);
  Diagnostic& d =
      diagnostics
          .report(Code::E0201, std::string(list ? "a list" : "an object") + " begins with `" +
                                   better + "`, not with `" + mistake.text[opening] + "`")
          .label(here);
  std::string mended(mistake.text);
  mended[opening] = better[0];
  if (is_balanced(mended)) d.fix(here, better, Applicability::likely);
}

// `{"name": "a", {"name": "b"}`, `["a", "key": 1]`: an object in place of a key, or a key in a list.
bool is_unclosed_before(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  if (!mistake.open_span) return false;
  const std::string_view text = mistake.text;
  const std::size_t opening = mistake.open_span->begin;
  const char c = text[wrong.begin];
  const bool is_object = text[opening] == '{' && c == '{' && wrong.previous != ':';
  if (!is_object && (text[opening] != '[' || c != ':' || wrong.previous != '"')) return false;
  const std::size_t begin = is_object ? wrong.begin : text.rfind('"', wrong.before - 1);
  const std::size_t before = text.find_last_not_of(" \t\r\n", begin - 1);
  if (before == opening) {
    report_wrong_opener(mistake, opening, diagnostics);
    return true;
  }
  const std::string closer(1, closer_of(text[opening]));
  const bool comma = text[before] == ',';
  const std::size_t place = comma ? before : before + 1;
  const std::string missing = comma ? closer : closer + ",";
  std::string mended(text);
  if (!is_balanced(mended.insert(place, missing))) return false;
  diagnostics.report(Code::E0201, "`" + closer + "` is missing before this")
      .label(span_of(mistake, begin, is_object ? begin + 1 : wrong.before + 1))
      .label(span_of(mistake, opening, opening + 1), "opened here", false)
      .fix(span_of(mistake, place, place), missing, Applicability::likely);
  return true;
}

// `"\ud800"`, `"\u12"`, `"\q"`
bool is_wrong_escape(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  std::string_view what;
  if (mentions(mistake, "surrogate"))
    what = "JSON needs both halves of such a character, as in `\\ud83d\\ude00`";
  else if (mentions(mistake, "hex digits"))
    what = "`\\u` needs four hexadecimal digits";
  else if (mentions(mistake, "after backslash"))
    what = "JSON has no such character with `\\`; a backslash is written `\\\\`";
  else
    return false;
  diagnostics.report(Code::E0201, std::string(what))
      .label(span_of(mistake, wrong.begin, wrong.end));
  return true;
}

// `"range": (0, 90)`
bool is_round_bracket(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  const std::string_view text = mistake.text;
  const bool is_value = wrong.previous == ':' || wrong.previous == ',' || wrong.previous == '[';
  if (text[wrong.begin] != '(' || !mistake.open_span || !is_value) return false;
  Diagnostic& d = diagnostics.report(Code::E0201, "a list needs square brackets in JSON")
                      .label(span_of(mistake, wrong.begin, wrong.end));
  const std::size_t last = text.find_first_of("(){}[]", wrong.begin + 1);
  if (last != std::string_view::npos && text[last] == ')')
    d.fix(span_of(mistake, wrong.begin, last + 1),
          "[" + std::string(text.substr(wrong.begin + 1, last - wrong.begin - 1)) + "]",
          Applicability::likely);
  return true;
}

bool is_semicolon(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  const std::string_view text = mistake.text;
  if (text[wrong.begin] != ';' || !mistake.open_span || !ends_value(wrong.previous) ||
      mentions(mistake, "object separator"))
    return false;
  const std::size_t next = text.find_first_not_of(" \t\r\n", wrong.begin + 1);
  const bool last = next == std::string_view::npos || text[next] == '}' || text[next] == ']';
  const Span here = span_of(mistake, wrong.begin, wrong.end);
  Diagnostic& d = diagnostics
                      .report(Code::E0201, last ? "the last entry needs no `;` in JSON"
                                                : "JSON needs a comma here, not `;`")
                      .label(here);
  mend(mistake, here, last ? "" : ",", d);
  return true;
}

// `"type" "type": "PWM"`
bool stands_twice(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  const std::string_view text = mistake.text;
  if (wrong.begin == 0 || (text[wrong.begin] != '"' && !is_word(text[wrong.begin]))) return false;
  std::size_t end = wrong.end;
  if (text[wrong.begin] == '"') {
    end = text.find('"', wrong.begin + 1);
    if (end++ == std::string_view::npos) return false;
  }
  const std::string_view word = text.substr(wrong.begin, end - wrong.begin);
  const std::size_t behind = wrong.before + 1;
  if (word.size() > behind || text.substr(behind - word.size(), word.size()) != word) return false;
  const std::size_t first = behind - word.size();
  if (word.front() != '"' && first > 0 && is_word(text[first - 1])) return false;
  Diagnostic& d =
      diagnostics.report(Code::E0201, "`" + std::string(word) + "` is written twice in a row")
          .label(span_of(mistake, wrong.begin, end));
  mend(mistake, span_of(mistake, behind, end), "", d);
  return true;
}

// `"type": "PWM",, "pin": 3`. In `[2,, 3]` a number may be missing instead.
bool is_second_comma(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  const char before = wrong.previous;
  if (mistake.text[wrong.begin] != ',' || !mistake.open_span ||
      (before != ',' && before != '{' && before != '['))
    return false;
  const Span comma = span_of(mistake, wrong.begin, wrong.end);
  Diagnostic& d = diagnostics.report(Code::E0201, "there is an extra comma").label(comma);
  if (mistake.text[mistake.open_span->begin] == '{')
    mend(mistake, comma, "", d);
  else
    d.fix(comma, "", Applicability::likely);
  return true;
}

// In `[2, ]` the second number may be missing instead.
bool is_extra_comma(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  const char c = mistake.text[wrong.begin];
  if (wrong.previous != ',' || (c != '}' && c != ']')) return false;
  const Span comma = span_of(mistake, wrong.before, wrong.before + 1);
  Diagnostic& d =
      diagnostics.report(Code::E0201, std::string("there is an extra comma before `") + c + "`")
          .label(comma);
  const std::size_t last = mistake.text.find_last_not_of(" \t\r\n", wrong.before - 1);
  const bool sure = c == '}' || (last != std::string_view::npos && mistake.text[last] == '}');
  if (sure)
    mend(mistake, comma, "", d);
  else
    d.fix(comma, "", Applicability::likely);
  return true;
}

// A whole file of another format.
bool is_other_format(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  if (mistake.good_until > 0 || mistake.open_span) return false;
  const std::string_view behind = ascii::trimmed(mistake.text.substr(wrong.end));
  const bool word = is_word(mistake.text[wrong.begin]);
  std::string_view format;
  if (mistake.text[wrong.begin] == '<') format = "XML";
  if (word && (behind.starts_with(':') || mistake.text.starts_with("---"))) format = "YAML";
  const bool assigned = word && behind.starts_with('=');
  if (format.empty() && !assigned) return false;
  Diagnostic& message =
      diagnostics
          .report(Code::E0201,
                  assigned ? "JSON is an object alone: nothing stands before it"
                           : "this looks like " + std::string(format) + ", but rsc reads JSON here")
          .label(span_of(mistake, wrong.begin, wrong.end));
  if (assigned)
    message.helps("begin with `{`");
  else
    message.helps("such as `{\"key\": [\"text\", 1.5, true]}`");
  return true;
}

// `[0deg, 90deg]`
bool is_bare_measure(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  const std::string word(mistake.text.substr(wrong.begin, wrong.end - wrong.begin));
  const std::size_t unit = std::min(word.find_first_not_of("-0123456789."), word.size());
  if (unit == 0 || unit == word.size() || find_unit(std::string_view(word).substr(unit)) == nullptr)
    return false;
  const std::string quoted = "\"" + word + "\"";
  diagnostics.report(Code::E0201, "a number with a unit needs double quotes in JSON")
      .label(span_of(mistake, wrong.begin, wrong.end), "write `" + quoted + "`")
      .fix(span_of(mistake, wrong.begin, wrong.end), quoted, Applicability::likely);
  return true;
}

bool is_mended(const Mistake& mistake, const WrongText& wrong, Diagnostics& diagnostics) {
  return is_wrong_escape(mistake, wrong, diagnostics) ||
         is_in_curly_quotes(mistake, wrong, diagnostics) ||
         is_unclosed_string(mistake, wrong, diagnostics) ||
         is_wrong_bracket(mistake, wrong, diagnostics) ||
         is_unclosed_before(mistake, wrong, diagnostics) ||
         is_round_bracket(mistake, wrong, diagnostics) ||
         is_semicolon(mistake, wrong, diagnostics) || stands_twice(mistake, wrong, diagnostics) ||
         is_extra_comma(mistake, wrong, diagnostics) ||
         is_second_comma(mistake, wrong, diagnostics) ||
         (is_word(mistake.text[wrong.begin]) && is_foreign_word(mistake, wrong, diagnostics));
}

}  // namespace

void report_mistake(const Mistake& mistake, Diagnostics& diagnostics) {
  const WrongText wrong = find_wrong_text(mistake);
  const auto span = [&](std::size_t begin, std::size_t end) {
    return span_of(mistake, begin, end);
  };
  const Span here = span(wrong.begin, wrong.end);
  if (wrong.begin >= mistake.text.size()) {
    at_end(mistake, diagnostics).label(here);
    return;
  }
  if (is_mended(mistake, wrong, diagnostics)) return;
  const char c = mistake.text[wrong.begin];
  if (mentions(mistake, "number overflow")) {
    const std::string number(mistake.text.substr(wrong.begin, wrong.end - wrong.begin));
    diagnostics.report(Code::E0201, no_room_for(number, canonical_unit(vm::Dimension::number)))
        .label(here);
  } else if (mentions(mistake, "object separator") && wrong.previous == '"' && !is_space(c) &&
             c != ',') {
    Diagnostic& d =
        diagnostics
            .report(Code::E0201, c == '=' ? "a key and its value need a colon between them, not `=`"
                                          : "a colon is missing between the key and its value")
            .label(here);
    mend(mistake, c == '=' ? here : span(wrong.before + 1, wrong.before + 1), ":", d);
  } else if (mistake.open_span && ends_value(wrong.previous) &&
             (c == '"' || c == '{' || c == '[') && wrong.before + 1 == mistake.good_until) {
    Diagnostic& d = diagnostics.report(Code::E0201, "a comma is missing before this").label(here);
    const Span place = span(wrong.before + 1, wrong.before + 1);
    // After a number, a digit may have taken the comma's place.
    if (ascii::is_digit(wrong.previous))
      d.fix(place, ",", Applicability::likely);
    else
      mend(mistake, place, ",", d);
  } else if (!is_other_format(mistake, wrong, diagnostics) &&
             !is_bare_measure(mistake, wrong, diagnostics)) {
    diagnostics.report(Code::E0201, describe_character(mistake, wrong)).label(here);
  }
}

}  // namespace robosync::compiler::json
