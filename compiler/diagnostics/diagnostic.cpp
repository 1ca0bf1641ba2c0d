// See diagnostic.hpp.
#include "compiler/diagnostics/diagnostic.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>

#include "compiler/source/ascii.hpp"
#include "compiler/source/sorting.hpp"

namespace robosync::compiler {

namespace {

struct CodeInfo {
  std::string_view name;
  Level level;
  std::string_view title;
};

constexpr CodeInfo codes[] = {
#define DIAGNOSTIC(code, level, title) {#code, Level::level, title},
#include "compiler/diagnostics/diagnostics.def"
#undef DIAGNOSTIC
};

constexpr Code in_order[] = {
#define DIAGNOSTIC(code, level, title) Code::code,
#include "compiler/diagnostics/diagnostics.def"
#undef DIAGNOSTIC
};

const CodeInfo& info(Code code) {
  return codes[static_cast<std::size_t>(code)];
}

// The place that a message is sorted by: its first primary label.
Span anchor(const Diagnostic& diagnostic) {
  for (const Label& label : diagnostic.labels) {
    if (label.primary) return label.span;
  }
  return diagnostic.labels.empty() ? Span{} : diagnostic.labels.front().span;
}

auto sort_key(const Diagnostic& diagnostic) {
  const Span span = anchor(diagnostic);
  return std::make_tuple(span.file, span.begin, span.end, diagnostic.code);
}

bool same(const Diagnostic& a, const Diagnostic& b) {
  return sort_key(a) == sort_key(b) && a.message == b.message;
}

}  // namespace

std::string_view level_name(Level level) {
  switch (level) {
    case Level::error:
      return "error";
    case Level::warning:
      return "warning";
    case Level::note:
      break;
  }
  return "note";
}

std::string_view applicability_name(Applicability applicability) {
  switch (applicability) {
    case Applicability::certain:
      return "certain";
    case Applicability::likely:
      return "likely";
    case Applicability::placeholder:
      break;
  }
  return "placeholder";
}

std::span<const Code> all_codes() {
  return in_order;
}
std::string_view code_name(Code code) {
  return info(code).name;
}
std::string_view code_title(Code code) {
  return info(code).title;
}
Level default_level(Code code) {
  return info(code).level;
}
bool is_lint(Code code) {
  return code_name(code).front() == 'W';
}
std::optional<Code> find_lint(std::string_view name) {
  const auto found = std::ranges::find_if(
      in_order, [name](Code code) { return is_lint(code) && code_name(code) == name; });
  return found != std::end(in_order) ? std::optional(*found) : std::nullopt;
}

Diagnostic& Diagnostic::label(Span span, std::string text, bool primary) {
  labels.push_back({span, std::move(text), primary});
  return *this;
}

Diagnostic& Diagnostic::helps(std::string text) {
  help.push_back(std::move(text));
  return *this;
}

Diagnostic& Diagnostic::appears_in_more(std::size_t places) {
  if (places == 0) return *this;
  return helps(places == 1 ? "it appears in one more place"
                           : "it appears in " + std::to_string(places) + " more places");
}

Diagnostic& Diagnostic::fix(Span span, std::string replacement, Applicability applicability) {
  fixes.push_back({span, std::move(replacement), applicability});
  return *this;
}

Diagnostic& Diagnostics::report(Code code, std::string message) {
  Diagnostic& diagnostic = all_.emplace_back();
  diagnostic.code = code;
  diagnostic.level = default_level(code);
  diagnostic.message = std::move(message);
  return diagnostic;
}

namespace {

std::size_t count(const std::vector<Diagnostic>& all, Level level) {
  return static_cast<std::size_t>(std::count_if(
      all.begin(), all.end(), [level](const Diagnostic& d) { return d.level == level; }));
}

}  // namespace

std::size_t Diagnostics::errors() const {
  return count(all_, Level::error);
}
bool Diagnostics::has_errors() const {
  return std::ranges::any_of(all_, [](const Diagnostic& one) { return one.level == Level::error; });
}
std::size_t Diagnostics::warnings() const {
  return count(all_, Level::warning);
}

bool Diagnostics::may_search(std::size_t names) {
  if (may_be_searched_ == 0) return false;
  may_be_searched_ -= std::min(names, may_be_searched_);
  return true;
}

void Diagnostics::found_from(Span use, const std::string& why, std::size_t before) {
  for (std::size_t i = before; i < all_.size(); ++i) {
    Diagnostic& d = all_[i];
    const auto is_there = [&](const Label& label) { return label.span.file == use.file; };
    if (d.level != Level::error || std::ranges::any_of(d.labels, is_there)) continue;
    for (Label& label : d.labels)
      label.primary = false;
    d.labels.insert(d.labels.begin(), {use, why, true});
  }
}

namespace {

void make_likely(Diagnostic& diagnostic) {
  for (Fix& fix : diagnostic.fixes)
    if (fix.applicability == Applicability::certain) fix.applicability = Applicability::likely;
}

bool continues_word(char c) {
  return c == '_' || (static_cast<unsigned char>(c) & 0x80U) != 0 || ('0' <= c && c <= '9') ||
         ascii::is_letter(c);
}

constexpr std::size_t kEnoughUses = 2;  // counting stops here

std::size_t uses_in(std::string_view text, std::string_view word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string_view::npos && found < kEnoughUses;
       at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool whole = (at == 0 || !continues_word(text[at - 1])) &&
                       (end == text.size() || !continues_word(text[end]));
    if (whole) ++found;
  }
  return found;
}

// How often `word` occurs in the user's own programs.
std::size_t uses_of(std::string_view word, const SourceMap& sources) {
  std::size_t found = 0;
  for (std::size_t id = 0; id < sources.size() && !word.empty() && found < kEnoughUses; ++id) {
    const SourceFile& file = sources.file(static_cast<FileId>(id));
    if (!file.name().starts_with('<') && id != kConfigurationFile)
      found += uses_in(file.text(), word);
  }
  return found;
}

// May the word that a fix gives be the misspelt one? A name of a program, if nothing else uses it. A name of robot.json is right;
// but a text (E0502), such as the name of a sound, only if a program uses it, too.
bool is_doubtful(const Diagnostic& diagnostic, const SourceMap& sources) {
  const std::string& word = diagnostic.fixes.front().replacement;
  const bool in_json = sources.size() > kConfigurationFile && !word.empty() &&
                       uses_in(sources.file(kConfigurationFile).text(), word) > 0;
  const std::size_t uses = uses_of(word, sources);
  return diagnostic.code == Code::E0502 ? in_json && uses == 0 : !in_json && uses == 1;
}

}  // namespace

void Diagnostics::doubt(Span region) {
  const auto is_there = [region](const Diagnostic& d) {
    const Span place = anchor(d);
    return d.level == Level::error && place.file == region.file && region.begin <= place.begin &&
           place.begin <= region.end;
  };
  if (std::ranges::count_if(all_, is_there) < 2) return;
  for (Diagnostic& diagnostic : all_)
    if (is_there(diagnostic)) make_likely(diagnostic);
}

void Diagnostics::doubt_names(const SourceMap& sources) {
  std::size_t searches = 20;  // each scans all of the text
  // With two errors in a line, the other one may be the real mistake.
  using Line = std::pair<FileId, std::uint32_t>;
  const auto line_of = [&](const Diagnostic& diagnostic) {
    const Span place = anchor(diagnostic);
    return Line{place.file, sources.file(place.file).line_of(place.begin)};
  };
  std::map<Line, std::size_t> errors;
  for (const Diagnostic& diagnostic : all_)
    if (diagnostic.level == Level::error) ++errors[line_of(diagnostic)];
  for (Diagnostic& diagnostic : all_) {
    const bool of_name = diagnostic.code == Code::E0501 || diagnostic.code == Code::E0502;
    if (!of_name || diagnostic.fixes.empty()) continue;
    const Fix& fix = diagnostic.fixes.front();
    if (fix.applicability != Applicability::certain) continue;
    const bool sure = errors[line_of(diagnostic)] == 1 && searches > 0 &&
                      uses_of(sources.text(fix.span), sources) == 1 &&
                      !is_doubtful(diagnostic, sources);
    if (searches > 0) --searches;
    if (!sure) make_likely(diagnostic);
  }
}

// A name that is misspelt in its declaration is unknown at every use, and whoever writes a sign of another language writes it again:
// reports it once.
void Diagnostics::merge_repeated() {
  constexpr std::size_t most = 4;  // places shown
  std::map<std::string, std::size_t> first;
  std::vector<Diagnostic> merged;
  for (Diagnostic& diagnostic : all_) {
    const auto [known, added] = first.emplace(diagnostic.message, merged.size());
    const bool is_name = diagnostic.code == Code::E0501;
    const bool merges = (is_name || diagnostic.code == Code::E0002) && !added &&
                        merged[known->second].code == diagnostic.code;
    if (!merges) {
      merged.push_back(std::move(diagnostic));
      continue;
    }
    Diagnostic& one = merged[known->second];
    for (const Fix& fix : diagnostic.fixes)
      one.fix(fix.span, fix.replacement, is_name ? Applicability::likely : fix.applicability);
    if (is_name) make_likely(one);
    if (++one.repeated < most) one.label(anchor(diagnostic), "and here", false);
  }
  for (Diagnostic& one : merged)
    one.appears_in_more(one.repeated + 1 - std::min(one.repeated + 1, most));
  all_ = std::move(merged);
}

void Diagnostics::finish() {
  sort_stably(all_, {}, sort_key);
  all_.erase(std::unique(all_.begin(), all_.end(), same), all_.end());
  merge_repeated();
}

}  // namespace robosync::compiler
