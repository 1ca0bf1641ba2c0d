// From a place and the characters around it to a sentence. nlohmann's own words are asked only
// whether a colon was expected, and whether a number was too large.
#include "compiler/config/json_mistake.hpp"

#include <algorithm>
#include <cctype>
#include <string>

namespace robosync::compiler::json {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '+' ||
         c == '-';
}

// What the parser did not like, and the last character before it that is not white space.
struct Place {
  std::size_t begin = 0, end = 0;
  std::size_t before = 0;  // its index; only if `previous` is not 0
  char previous = 0;
};

Place find_place(const Mistake& mistake) {
  const std::string_view text = mistake.text;
  std::size_t first = mistake.good_until;
  while (first < text.size() && (is_space(text[first]) || text[first] == ',' || text[first] == ':'))
    ++first;
  Place place;
  place.begin = std::min(mistake.stopped_at == 0 ? 0 : mistake.stopped_at - 1, text.size());
  place.end = std::min(place.begin + 1, text.size());
  const bool whole_string = place.begin < text.size() && first < place.begin &&
                            text[first] == '"' && text[place.begin] == '"';
  if (whole_string) {
    place.begin = first;
  } else if (first < place.end && is_word(text[first])) {
    place.begin = first;
    place.end = first + 1;
  }
  if (place.begin < text.size() && is_word(text[place.begin])) {
    while (place.begin > 0 && is_word(text[place.begin - 1]))
      --place.begin;
    while (place.end < text.size() && is_word(text[place.end]))
      ++place.end;
  }
  for (std::size_t i = place.begin; i > 0; --i) {
    if (is_space(text[i - 1])) continue;
    place.before = i - 1;
    place.previous = text[i - 1];
    break;
  }
  return place;
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
  if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.')
    return "JSON cannot read `" + std::string(word) + "` as a number";
  return "`" + std::string(word) + "` needs double quotes here";
}

std::string describe_character(const Mistake& mistake, const Place& place) {
  const char c = mistake.text[place.begin];
  const auto byte = static_cast<unsigned char>(c);
  if (byte >= 0x80) return "this is not UTF-8 text";
  if (c == '\'') return "JSON strings stand in double quotes";
  if (c == '/' || c == '#' || c == '%') return "JSON has no comments";
  if (byte < 0x20)
    return "a string goes over the end of its line, or has a control character in it";
  if (mistake.good_until > 0 && !mistake.open_span) return "there is something after the end";
  if (is_word(c)) return describe_word(mistake.text.substr(place.begin, place.end - place.begin));
  return "this is not JSON here";
}

}  // namespace

void report_mistake(const Mistake& mistake, Diagnostics& diagnostics) {
  const Place place = find_place(mistake);
  const auto span = [&](std::size_t begin, std::size_t end) {
    return Span{mistake.file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  };
  const Span here = span(place.begin, place.end);
  if (place.begin >= mistake.text.size()) {
    at_end(mistake, diagnostics).label(here);
    return;
  }
  const char c = mistake.text[place.begin];
  if (mentions(mistake, "number overflow")) {
    diagnostics.report(Code::E0201, "this number is too large").label(here);
  } else if (place.previous == ',' && (c == '}' || c == ']')) {
    diagnostics.report(Code::E0201, std::string("there is a comma too many before `") + c + "`")
        .label(span(place.before, place.before + 1))
        .fix(span(place.before, place.before + 1), "");
  } else if (mentions(mistake, "object separator") && place.previous == '"' && !is_space(c) &&
             c != ',') {
    diagnostics.report(Code::E0201, "a colon is missing between the key and its value")
        .label(here)
        .fix(span(place.before + 1, place.before + 1), ":");
  } else if (mistake.open_span && ends_value(place.previous) &&
             (c == '"' || c == '{' || c == '[') && place.before + 1 == mistake.good_until) {
    diagnostics.report(Code::E0201, "a comma is missing before this")
        .label(here)
        .fix(span(place.before + 1, place.before + 1), ",");
  } else {
    diagnostics.report(Code::E0201, describe_character(mistake, place)).label(here);
  }
}

}  // namespace robosync::compiler::json
