// Diagnostics as data. Collected while compiling, printed once at the end (render.hpp).
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

// Every code once, with its level and title: diagnostics.def.
enum class Code : std::uint16_t {
#define DIAGNOSTIC(code, level, title) code,
#include "compiler/diagnostics/diagnostics.def"
#undef DIAGNOSTIC
};

[[nodiscard]] std::span<const Code> all_codes();
[[nodiscard]] std::string_view code_name(Code code);  // "E0501"
[[nodiscard]] std::string_view code_title(Code code);
[[nodiscard]] Level default_level(Code code);
// May its level be chosen?
[[nodiscard]] bool is_lint(Code code);
[[nodiscard]] std::optional<Code> find_lint(std::string_view name);

struct Label {
  Span span;
  std::string text;  // may be empty
  bool primary = true;
};

// How sure it is that a fix gives what was meant. What would put in a NOT, a sign or digits, or take
// one of them or a comma out of a number, is never certain.
enum class Applicability : std::uint8_t { certain, likely, placeholder };

[[nodiscard]] std::string_view applicability_name(Applicability applicability);  // "certain"

struct Fix {  // replace the span by the text and the message goes away
  Span span;
  std::string replacement;
  Applicability applicability = Applicability::certain;
};

struct Diagnostic {
  Code code{};
  Level level = Level::error;
  std::string message;  // one sentence, no full stop: what is wrong, in the user's words
  std::vector<Label> labels;
  std::vector<std::string> help;  // how to mend it
  std::vector<Fix> fixes;
  std::size_t repeated = 0;  // how often it was said again elsewhere
  std::string unknown;       // what nothing here is called; a module that is not used may have it

  // Chainable builders.
  Diagnostic& label(Span span, std::string text = {}, bool primary = true);
  Diagnostic& helps(std::string text);
  Diagnostic& fix(Span span, std::string replacement,
                  Applicability applicability = Applicability::certain);
};

class Diagnostics {
public:
  // Starts a diagnostic with its default level; build on the reference at once: the next report
  // makes it invalid.
  Diagnostic& report(Code code, std::string message);
  void add(Diagnostic diagnostic) { all_.push_back(std::move(diagnostic)); }
  std::size_t errors() const;
  std::size_t warnings() const;
  const std::vector<Diagnostic>& all() const { return all_; }
  // `use`, in another file, is where somebody asked for what has the errors that were reported since
  // there were `before`: so that is where they are shown first. What they say of that file stays.
  void found_from(Span use, const std::string& why, std::size_t before);
  // To look for the name that a misspelt one is nearest to takes as long as there are names. True
  // while all such searches together are short, so that a text full of mistakes is read in a time
  // that goes with its length; ask before each. `names`: how many it looks at.
  [[nodiscard]] bool may_search(std::size_t names);
  // Where more than one mistake is, the first guess may have been wrong: no fix of an error in there is certain.
  void doubt(Span region);
  // No fix of a name that nothing has is certain when the other name may be the misspelt one: when it is used nowhere
  // else, or this one is used again.
  void doubt_names(const SourceMap& sources);
  // Sorted by file and place. Exact repetitions are dropped, and what has one cause is said once, with all its places.
  // Call once before printing.
  void finish();

private:
  void merge_repeated();

  std::vector<Diagnostic> all_;
  std::size_t may_be_searched_ = 200'000;  // names, more than any program's mistakes need
};

}  // namespace robosync::compiler
