// Completion scripts for bash, fish and zsh. They offer the words of an option ("human|json") or of a verb ("convert"), serial ports
// after --port, files where an option takes one, and nothing for a number or a name.
#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "rsc/escaped.hpp"
#include "rsc/usage.hpp"

namespace robosync::tool {
namespace {

constexpr std::string_view kPort = "--port";
constexpr std::string_view kListPorts =
    "ls -d /dev/ttyACM* /dev/ttyUSB* /dev/pts/[0-9]* 2>/dev/null";

// "FILE", "DEV|FILE", "FOLDER", "S.json".
bool is_path(const OptionUsage& option) {
  return option.value.find("FILE") != std::string::npos || option.value == "FOLDER" ||
         option.value.find('.') != std::string::npos;
}

// "human|json" as "human json"; empty if the value is not a choice of words, but stands for something: "TIME".
std::string words_of(const OptionUsage& option) {
  std::string words = option.value;
  if (std::ranges::any_of(words, [](char c) { return c >= 'A' && c <= 'Z'; })) return {};
  std::ranges::replace(words, '|', ' ');
  return words;
}

// The words that may follow the verb itself: "bash fish zsh". Empty: it takes none.
std::string words_after(const VerbUsage& verb) {
  for (const OptionUsage& option : verb.options)
    if (option.names.empty()) return words_of(option);
  return {};
}

std::string case_of(const VerbUsage& verb, const OptionUsage& option) {
  if (option.names.empty() || option.value.empty()) return {};
  std::string patterns;
  for (const std::string& name : option.names)
    patterns += fmt::format("{}{},{}", patterns.empty() ? "" : "|", verb.name, name);
  const std::string offer = option.names.front() == kPort ? "_rsc_ports"
                            : is_path(option)             ? "_rsc_files"
                                              : fmt::format("_rsc_words \"{}\"", words_of(option));
  return fmt::format("    {}) {}; return ;;\n", patterns, offer);
}

std::string names_of(const VerbUsage& verb) {
  std::string names;
  for (const OptionUsage& option : verb.options)
    for (const std::string& name : option.names)
      names += (names.empty() ? "" : " ") + name;
  return names;
}

// As fish quotes within '…'.
std::string in_fish(std::string_view text) {
  return "'" + escaped(text, {{'\'', "\\'"}, {'\\', "\\\\"}}) + "'";
}

std::string fish_option(const VerbUsage& verb, const OptionUsage& option) {
  std::string line = fmt::format("complete -c rsc -n '__fish_seen_subcommand_from {}'", verb.name);
  for (const std::string& name : option.names)
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (option.names.front() == kPort)
    line += fmt::format(" -x -a '({})'", kListPorts);
  else if (is_path(option))
    line += " -r";
  else if (const std::string words = words_of(option); !words.empty())
    line += fmt::format(" -x -a '{}'", words);
  else if (!option.value.empty())
    line += " -x";
  return fmt::format("{} -d {}\n", line, in_fish(option.description));
}

// As zsh quotes within '…'; `_arguments` and `_describe` have special characters of their own.
std::string in_zsh(std::string_view text) {
  return escaped(text, {{'\'', "'\\''"}, {'\\', "\\\\"}, {':', "\\:"}, {'[', "\\["}, {']', "\\]"}});
}

std::string zsh_offer(const OptionUsage& option) {
  if (!option.names.empty() && option.names.front() == kPort) return "_rsc_ports";
  if (is_path(option)) return "_files";
  const std::string words = words_of(option);
  return words.empty() ? " " : "(" + words + ")";
}

// `--name[description]:VALUE:offer`.
std::string zsh_option(const OptionUsage& option) {
  std::string lines;
  for (const std::string& name : option.names) {
    const std::string value =
        option.value.empty() ? "" : fmt::format(":{}:{}", in_zsh(option.value), zsh_offer(option));
    lines += fmt::format("        '*{}[{}]{}' \\\n", name, in_zsh(option.description), value);
  }
  return lines;
}

// The options; then the word after the verb, and files, once however many arguments take one.
std::string zsh_arguments(const VerbUsage& verb) {
  std::string lines, files;
  for (const OptionUsage& option : verb.options) {
    lines += zsh_option(option);
    if (option.names.empty() && words_of(option).empty())
      files = fmt::format("        '*:{}:_files' \\\n", in_zsh(option.value));
  }
  if (const std::string words = words_after(verb); !words.empty())
    lines += fmt::format("        '1:{}:({})' \\\n", words, words);
  return lines + files;
}

}  // namespace

std::string bash_completion(const std::vector<VerbUsage>& verbs) {
  std::string names, values, after, options;
  for (const VerbUsage& verb : verbs) {
    names += (names.empty() ? "" : " ") + verb.name;
    for (const OptionUsage& option : verb.options)
      values += case_of(verb, option);
    if (const std::string words = words_after(verb); !words.empty())
      after += fmt::format("      {},2) _rsc_words \"{}\" ;;\n", verb.name, words);
    options += fmt::format("    {}) _rsc_words \"{}\" ;;\n", verb.name, names_of(verb));
  }
  return fmt::format(R"(# Completion of rsc for bash, printed by `rsc completion bash`.
_rsc_words() {{ COMPREPLY=($(compgen -W "$1" -- "$word")); }}
_rsc_files() {{
  local IFS=$'\n'
  compopt -o filenames 2>/dev/null
  COMPREPLY=($(compgen -f -- "$word"))
}}
_rsc_ports() {{
  local lines=$({})
  _rsc_words "$lines"
}}
_rsc() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} verb=${{COMP_WORDS[1]}}
  if [ "$COMP_CWORD" = 1 ]; then
    _rsc_words "{}"
    return
  fi
  case $verb,$before in
{}  esac
  if [ "${{word#-}}" = "$word" ]; then
    case $verb,$COMP_CWORD in
      help,2) _rsc_words "{}" ;;
{}      *) _rsc_files ;;
    esac
    return
  fi
  case $verb in
{}  esac
}}
complete -F _rsc rsc
)",
                     kListPorts, names, values, names, after, options);
}

std::string fish_completion(const std::vector<VerbUsage>& verbs) {
  std::string text = "# Completion of rsc for fish, printed by `rsc completion fish`.\n";
  for (const VerbUsage& verb : verbs)
    text += fmt::format("complete -c rsc -f -n __fish_use_subcommand -a {} -d {}\n", verb.name,
                        in_fish(verb.summary));
  for (const VerbUsage& verb : verbs) {
    for (const OptionUsage& option : verb.options)
      if (!option.names.empty()) text += fish_option(verb, option);
    if (const std::string words = words_after(verb); !words.empty())
      text += fmt::format(
          "complete -c rsc -f -n '__fish_seen_subcommand_from {}; and not "
          "__fish_seen_subcommand_from {}' -a '{}'\n",
          verb.name, words, words);
  }
  return text;
}

std::string zsh_completion(const std::vector<VerbUsage>& verbs) {
  std::string summaries, cases;
  for (const VerbUsage& verb : verbs) {
    summaries += fmt::format("    '{}:{}'\n", verb.name, in_zsh(verb.summary));
    const std::string names =
        verb.name == "help" ? "_describe verb verbs" : "_arguments -s \\\n" + zsh_arguments(verb);
    cases += fmt::format("    {})\n      {}\n      ;;\n", verb.name, names);
  }
  return fmt::format(R"zsh(#compdef rsc
# Completion of rsc for zsh, printed by `rsc completion zsh`.
_rsc_ports() {{
  local -a lines
  lines=(${{(f)"$({})"}})
  compadd -a lines
}}
_rsc() {{
  local -a verbs
  verbs=(
{}  )
  if (( CURRENT == 2 )); then
    _describe verb verbs
    return
  fi
  shift words
  (( CURRENT-- ))
  case $words[1] in
{}  esac
}}
compdef _rsc rsc
)zsh",
                     kListPorts, summaries, cases);
}

}  // namespace robosync::tool
