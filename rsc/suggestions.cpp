// See suggestions.hpp. The words of other tools first, then the nearest word of rsc.
#include "rsc/suggestions.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/diagnostics/nearest.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {
namespace {

struct Foreign {
  std::string_view word, write;
};

constexpr std::array kForeignVerbs = {
    Foreign{"-c", "rsc compile FILE"},
    Foreign{"-o", "rsc compile FILE -o OUT.rsb"},
    Foreign{"-v", "rsc --version"},
    Foreign{"-V", "rsc --version"},
    Foreign{"-version", "rsc --version"},
    Foreign{"version", "rsc --version"},
    Foreign{"build", "rsc compile FILE"},
    Foreign{"make", "rsc compile FILE"},
    Foreign{"lint", "rsc check FILE"},
    Foreign{"validate", "rsc check FILE"},
    Foreign{"verify", "rsc check FILE"},
    Foreign{"format", "rsc fmt FILE"},
    Foreign{"simulate", "rsc run FILE"},
    Foreign{"sim", "rsc run FILE"},
    Foreign{"start", "rsc run FILE"},
    Foreign{"watch", "rsc run FILE --watch"},
    Foreign{"init", "rsc new FOLDER"},
    Foreign{"create", "rsc new FOLDER"},
    Foreign{"deploy", "rsc upload FILE"},
    Foreign{"load", "rsc upload FILE"},
    Foreign{"disassemble", "rsc dump FILE"},
    Foreign{"objdump", "rsc dump FILE"},
    Foreign{"log", "rsc monitor"},
    Foreign{"logs", "rsc monitor"},
    Foreign{"devices", "rsc ports"},
    Foreign{"list", "rsc ports"},
    Foreign{"halt", "rsc stop"},
    Foreign{"undo", "rsc rollback"},
    Foreign{"describe", "rsc explain FILE"},
    Foreign{"convert", "rsc trace convert FILE"},
};

struct ForeignOption {
  std::string_view verb;  // empty: of any verb
  std::string_view word, answer;
};

constexpr std::array kForeignOptions = {
    ForeignOption{"compile", "-c", "write rsc compile FILE, without it"},
    ForeignOption{"compile", "-g", "leave it out: the lines are in the image, unless --strip"},
    ForeignOption{"fmt", "-w", "leave it out: rsc fmt rewrites the files"},
    ForeignOption{"fmt", "-i", "leave it out: rsc fmt rewrites the files"},
    ForeignOption{"fmt", "--write", "leave it out: rsc fmt rewrites the files"},
    ForeignOption{"fmt", "--diff", "write --check, which names the files that would change"},
    ForeignOption{"fmt", "--dry-run", "write --check"},
    ForeignOption{"run", "--time", "write --duration 10s"},
    ForeignOption{"run", "-t", "write --duration 10s"},
    ForeignOption{"run", "--record", "write --trace OUT.jsonl"},
    ForeignOption{"run", "-o", "write --trace OUT.jsonl, or --html OUT.html"},
    ForeignOption{"", "--json", "write --format json"},
    ForeignOption{"check", "--sarif", "write --format sarif"},
    ForeignOption{"", "--werror", "write --deny warnings"},
    ForeignOption{"", "-Werror", "write --deny warnings"},
    ForeignOption{"", "-Wall", "leave it out: all lints are on; --deny warnings makes them errors"},
    ForeignOption{"", "--no-color", "write --color never"},
};

bool has(const std::vector<std::string>& known, std::string_view option) {
  return std::ranges::find(known, option) != known.end();
}

// Every option that a suggestion names must be one of the verb.
bool fits(const ForeignOption& foreign, std::string_view verb,
          const std::vector<std::string>& known) {
  if (!foreign.verb.empty()) return foreign.verb == verb;
  const std::size_t at = foreign.answer.find("--");
  const std::string_view option = foreign.answer.substr(at, foreign.answer.find(' ', at) - at);
  return has(known, option);
}

// `-d`: `--duration`. `--dur`: the same.
std::vector<std::string> beginning_with(std::string_view word,
                                        const std::vector<std::string>& known) {
  const bool letter = word.size() == 2 && !word.starts_with("--");
  const std::string begin = letter ? "--" + std::string(word.substr(1)) : std::string(word);
  std::vector<std::string> found;
  for (const std::string& option : known)
    if (begin.size() > 2 && option.starts_with(begin) && option != "--help")
      found.push_back(option);
  return found;
}

}  // namespace

std::string instead_of_verb(std::string_view word) {
  const auto* const foreign = std::ranges::find(kForeignVerbs, word, &Foreign::word);
  if (foreign != kForeignVerbs.end()) return fmt::format("; write `{}`", foreign->write);
  if (word.ends_with(".rsl"))
    return fmt::format("; write `rsc check {0}` to look for mistakes, `rsc run {0}` to run it",
                       word);
  if (word.ends_with(".rsb")) return fmt::format("; write `rsc run {}`", word);
  std::vector<std::string> verbs;
  verbs.reserve(std::size(kVerbs));
  for (const Verb& verb : kVerbs)
    verbs.emplace_back(verb.name);
  const auto near = compiler::nearest(word, verbs);
  return near ? fmt::format("; did you mean `{}`?", *near) : "";
}

std::string instead_of_option(std::string_view verb, std::string_view word,
                              const std::vector<std::string>& known) {
  if (word.find('.') < word.find('='))
    return fmt::format("; a file of this name is written ./{}", word);
  word = word.substr(0, word.find('='));
  for (const ForeignOption& foreign : kForeignOptions)
    if (foreign.word == word && fits(foreign, verb, known))
      return fmt::format("; {}", foreign.answer);
  const std::vector<std::string> begun = beginning_with(word, known);
  if (!begun.empty()) return fmt::format("; did you mean `{}`?", fmt::join(begun, "` or `"));
  if (const auto near = compiler::nearest(word, known))
    return fmt::format("; did you mean `{}`?", *near);
  std::vector<std::string> own = known;
  std::erase_if(own,
                [](const std::string& option) { return option == "--help" || option == "-h"; });
  return own.empty() ? "" : fmt::format("; there are {}", fmt::join(own, ", "));
}

}  // namespace robosync::tool
