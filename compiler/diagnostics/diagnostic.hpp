// Diagnostics as data: collected during compilation, printed once at the end (render.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/source/source_file.hpp"

namespace robosync::compiler {

enum class Level : std::uint8_t { error, warning, note };

[[nodiscard]] std::string_view level_name(Level level);  // "error"

// Every code. diagnostics.def has their levels and titles.
enum class Code : std::uint16_t {
#define DIAGNOSTIC(code, level, title) code,
#include "compiler/diagnostics/diagnostics.def"
#undef DIAGNOSTIC
};

[[nodiscard]] std::span<const Code> all_codes();
[[nodiscard]] std::string_view code_name(Code code);  // "E0501"
[[nodiscard]] std::string_view code_title(Code code);
[[nodiscard]] Level default_level(Code code);
// True when the user can set its level.
[[nodiscard]] bool is_lint(Code code);
[[nodiscard]] std::optional<Code> find_lint(std::string_view name);

struct Label {
  Span span;
  std::string text;  // may be empty
  bool primary = true;
};

// How likely a fix gives what was meant. A fix is never certain if it inserts a NOT, a sign or digits, removes
// one of them, or removes a comma from a number.
enum class Applicability : std::uint8_t { certain, likely, placeholder };

[[nodiscard]] std::string_view applicability_name(Applicability applicability);  // "certain"

struct Fix {  // replacing the span by the text makes the message go away
  Span span;
  std::string replacement;
  Applicability applicability = Applicability::certain;
};

struct Diagnostic {
  Code code{};
  Level level = Level::error;
  std::string message;  // one sentence, no full stop: what is wrong, in the user's words
  std::vector<Label> labels;
  std::vector<std::string> help;  // how to fix it
  std::vector<Fix> fixes;
  std::size_t repeated = 0;    // how many more places have the same message
  std::string unknown;         // the unknown name, if any; a module that is not used may have it
  bool in_verb_place = false;  // that name stands where a command has its verb

  // Chainable builders.
  Diagnostic& label(Span span, std::string text = {}, bool primary = true);
  Diagnostic& helps(std::string text);
  // "it appears in 3 more places", if that is more than none.
  Diagnostic& appears_in_more(std::size_t places);
  Diagnostic& fix(Span span, std::string replacement,
                  Applicability applicability = Applicability::certain);
};

class Diagnostics {
public:
  // Starts a diagnostic with its default level. Use the reference immediately: the next report
  // invalidates it.
  Diagnostic& report(Code code, std::string message);
  void add(Diagnostic diagnostic) { all_.push_back(std::move(diagnostic)); }
  std::size_t errors() const;
  bool has_errors() const;  // does not count them
  std::size_t warnings() const;
  const std::vector<Diagnostic>& all() const { return all_; }
  // Points the errors reported since there were `before` diagnostics at `use`, the place in another file that asked for
  // the faulty text. Errors that already have a label in that file stay as they are.
  void found_from(Span use, const std::string& why, std::size_t before);
  // The time to find the nearest name is proportional to the number of names. True while all searches
  // together are short, so that the time for a text full of mistakes stays proportional to its length.
  // Call it before each search; `names` is how many names the search looks at.
  [[nodiscard]] bool may_search(std::size_t names);
  // If the region has more than one error, the first guess may be wrong: makes no fix in it certain.
  void doubt(Span region);
  // Makes the fix of an unknown name or text uncertain when the other one may be misspelt: when that one is used nowhere else,
  // or the unknown one is used again.
  void doubt_names(const SourceMap& sources);
  // Sorts by file and place, drops exact repetitions, and merges messages with one cause into one with all its places.
  // Call once before printing.
  void finish();

private:
  void merge_repeated();

  std::vector<Diagnostic> all_;
  std::size_t may_be_searched_ = 200'000;  // names; more than the mistakes of any program need
};

}  // namespace robosync::compiler
