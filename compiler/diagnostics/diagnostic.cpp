// See diagnostic.hpp.
#include "compiler/diagnostics/diagnostic.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

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

// Where a message belongs in the listing: at its first primary label.
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

Diagnostic& Diagnostic::label(Span span, std::string text, bool primary) {
  labels.push_back({span, std::move(text), primary});
  return *this;
}

Diagnostic& Diagnostic::helps(std::string text) {
  help.push_back(std::move(text));
  return *this;
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

void Diagnostics::finish() {
  std::stable_sort(all_.begin(), all_.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return sort_key(a) < sort_key(b);
  });
  all_.erase(std::unique(all_.begin(), all_.end(), same), all_.end());
}

}  // namespace robosync::compiler
