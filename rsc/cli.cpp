// Builds the parser from the list of verbs, so that help, dispatch and suggestions have one source. The only file
// that includes CLI11, which takes longer to compile than all the verbs together.
#include "rsc/cli.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "rsc/algorithm_modules.hpp"
#include "rsc/failure.hpp"
#include "rsc/options.hpp"
#include "rsc/suggestions.hpp"
#include "rsc/usage.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {

void Options::argument(const std::string& name, std::string& value, const std::string& description,
                       Need need) {
  app_.add_option(name, value, description)->required(need == Need::required)->option_text(" ");
}

void Options::arguments(const std::string& name, std::vector<std::string>& values,
                        const std::string& description, Need need) {
  app_.add_option(name, values, description)->required(need == Need::required)->option_text("...");
}

namespace {

// CLI11 expects its own type of exception.
void take_word(const Options::Take& take, const std::string& word) {
  try {
    take(word);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError(error.what());
  }
}

// Else a forgotten value would take the next option: --duration --trace x.
Options::Take unless_option(const CLI::App& app, const std::string& names, const std::string& text,
                            const Options::Take& take) {
  return [&app, names, text, take](const std::string& word) {
    const std::string name = word.substr(0, word.find('='));
    if (name.starts_with("-") && app.get_option_no_throw(name) != nullptr)
      throw CLI::ValidationError(
          fmt::format("{} needs {} after it", names.substr(names.rfind(',') + 1), text));
    take_word(take, word);
  };
}

CLI::Option* add_named(CLI::App& app, const std::string& names, const std::string& text,
                       const Options::Take& take, const std::string& description) {
  return app
      .add_option_function<std::string>(names, unless_option(app, names, text, take), description)
      ->type_name(text)
      ->option_text(text);
}

}  // namespace

// An unset shell variable gives an empty word: without this check the run would not be recorded.
void Options::option(const std::string& names, const std::string& text, std::string& value,
                     const std::string& description, Need need) {
  const auto take = [&value, name = names.substr(names.rfind(',') + 1)](const std::string& word) {
    if (word.empty())
      throw std::invalid_argument(name + ": it is empty; name a file or leave it out");
    value = word;
  };
  add_named(app_, names, text, take, description)->required(need == Need::required);
}

void Options::option(const std::string& names, const std::string& text, const Take& take,
                     const std::string& description) {
  add_named(app_, names, text, take, description);
}

void Options::options(const std::string& names, const std::string& text, const Take& take,
                      const std::string& description, Need need) {
  const auto take_all =
      [take = unless_option(app_, names, text, take)](const std::vector<std::string>& words) {
        std::ranges::for_each(words, take);
      };
  app_.add_option_function<std::vector<std::string>>(names, take_all, description)
      ->required(need == Need::required)
      ->allow_extra_args(false)
      ->type_name(text)
      ->option_text(text);
}

void Options::flag(const std::string& name, bool& value, const std::string& description) {
  app_.add_flag(name, value, description);
}

void Options::choice(const std::string& name, const std::vector<std::string>& words,
                     const std::function<void(std::size_t)>& take, const std::string& description) {
  const auto find = [name, words, take](const std::string& word) {
    const auto at = std::ranges::find(words, word);
    if (at == words.end()) {
      throw std::invalid_argument(
          fmt::format("{} is {}, not `{}`", name, fmt::join(words, " or "), word));
    }
    take(static_cast<std::size_t>(at - words.begin()));
  };
  option(name, fmt::format("{}", fmt::join(words, "|")), find, description);
}

void Options::runs(std::function<void()> verb) {
  app_.callback(std::move(verb));
}

namespace {

constexpr std::string_view kEpilogue =
    "Exit: 0 fine, 1 the program, its configuration or a test is wrong, 2 wrong usage, 3 file or "
    "device "
    "trouble.\n"
    "`rsc help VERB` explains a verb.";

// For all verbs, or only for `only`: building the options of the others takes as long as a short compilation.
std::unique_ptr<CLI::App> make_parser(const Verb* only = nullptr) {
  auto app = std::make_unique<CLI::App>("RoboSync: programs for social robots.", "rsc");
  app->set_version_flag("--version", std::string("rsc ") + ROBOSYNC_VERSION);
  app->footer(std::string(kEpilogue));
  app->require_subcommand(1);
  app->get_formatter()->label("SUBCOMMAND", "VERB");
  app->get_formatter()->label("Subcommands", "Verbs");
  for (const Verb& verb : kVerbs) {
    if (only != nullptr && &verb != only) continue;
    CLI::App* sub = app->add_subcommand(std::string(verb.name), std::string(verb.summary));
    sub->footer(fmt::format("Example:\n  {}", verb.example));
    Options options(*sub);
    verb.add(options);
  }
  return app;
}

const Verb* find_verb(std::string_view name) {
  const auto* verb = std::ranges::find(kVerbs, name, &Verb::name);
  return verb == kVerbs.end() ? nullptr : verb;
}

[[noreturn]] void unknown_verb(std::string_view word) {
  throw Failure(Exit::usage, fmt::format("there is no verb `{}`{}\n`rsc help` lists them", word,
                                         instead_of_verb(word)));
}

// "--seed: At Most 1 required but received 2", "--config: 1 required FILE missing". Empty: another error.
std::string mismatch(const CLI::ParseError& error) {
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr) return {};
  const std::string_view said = error.what();
  const std::string_view name = said.substr(0, said.find(':'));
  constexpr std::string_view kRequired = "required ", kMissing = " missing";
  const std::size_t required = said.rfind(kRequired);
  if (said.find("At Most") != std::string_view::npos)
    return fmt::format("{} may be given only once", name);
  if (required == std::string_view::npos || !said.ends_with(kMissing)) return {};
  const std::size_t begin = required + kRequired.size();
  return fmt::format("{} needs {} after it", name,
                     said.substr(begin, said.size() - kMissing.size() - begin));
}

// CLI11's message, with a suggestion for a misspelt option.
std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const CLI::App& at = chosen.empty() ? app : *chosen.front();
  std::string message = error.what();
  const std::vector<std::string> extras = at.remaining(true);
  const std::string word = extras.empty() ? std::string() : extras.front();
  // CLI11 would report the missing file instead of the misspelt option.
  if (word.starts_with("-") || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    std::vector<std::string> known;
    for (const CLI::Option* option : at.get_options()) {
      for (const std::string& name : option->get_lnames())
        known.push_back("--" + name);
      for (const std::string& name : option->get_snames())
        known.push_back("-" + name);
    }
    if (word.starts_with("-"))
      message = fmt::format("there is no option `{}`{}", word,
                            instead_of_option(at.get_name(), word, known));
    else if (word.starts_with("./-"))
      message = fmt::format(
          "`{}` is one argument too many; after `--` all are names of files, "
          "so options go before it",
          word.substr(2));
    else
      message = fmt::format("`{}` is one argument too many", word);
  }
  if (const std::string said = mismatch(error); !said.empty()) message = said;
  const std::string help = &at == &app ? "rsc help" : "rsc help " + at.get_name();
  return fmt::format("{}\n`{}` shows how it is used", message, help);
}

// After `--` all are names of files, also `-a.rsl`. In the order that CLI11 takes them.
std::vector<std::string> reversed_words(std::span<const char* const> arguments) {
  std::vector<std::string> words;
  bool only_files = false;
  for (const std::string_view word : arguments.subspan(1)) {
    const bool like_option = word.size() > 1 && word.starts_with("-");
    if (!only_files && word == "--")
      only_files = true;
    else
      words.push_back(std::string(only_files && like_option ? "./" : "") + std::string(word));
  }
  std::ranges::reverse(words);
  return words;
}

void parse(CLI::App& app, int count, const char* const* arguments) {
  const std::string_view first = count > 1 ? arguments[1] : "";
  if (first.empty()) throw Failure(Exit::usage, "say what to do\n" + app.help());
  constexpr std::array<std::string_view, 3> kWithoutVerb = {"-h", "--help", "--version"};
  if (first.starts_with("-") && std::ranges::find(kWithoutVerb, first) == kWithoutVerb.end())
    throw Failure(Exit::usage,
                  fmt::format("`{}` is not a verb: write rsc VERB, then its options{}\n"
                              "`rsc help` lists the verbs",
                              first, instead_of_verb(first)));
  if (!first.starts_with("-") && find_verb(first) == nullptr) unknown_verb(first);
  try {
    app.parse(reversed_words({arguments, static_cast<std::size_t>(count)}));
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    std::cout << (chosen.empty() ? app.help() : chosen.front()->help(app.get_name()));
  } catch (const CLI::CallForVersion& version) {
    std::cout << version.what() << '\n';
  } catch (const CLI::ParseError& error) {
    throw Failure(Exit::usage, explain(app, error));
  }
}

}  // namespace

void print_help(const char* verb) {
  const auto app = make_parser();
  if (*verb == '\0') {
    std::cout << app->help();
    return;
  }
  if (find_verb(verb) == nullptr) unknown_verb(verb);
  std::cout << app->get_subcommand(verb)->help(app->get_name());
}

std::vector<VerbUsage> all_usage() {
  const auto app = make_parser();
  std::vector<VerbUsage> all;
  for (const Verb& verb : kVerbs) {
    VerbUsage usage{
        std::string(verb.name), std::string(verb.summary), std::string(verb.example), {}};
    for (const CLI::Option* option : app->get_subcommand(usage.name)->get_options()) {
      const bool takes_value = option->get_items_expected_max() != 0;
      OptionUsage one{{}, takes_value ? option->get_type_name() : "", option->get_description()};
      for (const std::string& name : option->get_lnames())
        one.names.push_back("--" + name);
      for (const std::string& name : option->get_snames())
        one.names.push_back("-" + name);
      if (one.names.empty()) one.value = option->get_name(true);
      usage.options.push_back(std::move(one));
    }
    all.push_back(std::move(usage));
  }
  return all;
}

int run_command_line(int argument_count, const char* const* arguments) {
  const auto say = [](std::string_view message) {
    std::cout.flush();
    if (!message.empty()) std::cerr << "rsc: " << message << '\n';
  };
  try {
    const auto app = make_parser(argument_count > 1 ? find_verb(arguments[1]) : nullptr);
    parse(*app, argument_count, arguments);
    std::cout.flush();
    if (!std::cout) throw Failure(Exit::outside, "could not write to stdout");
    if (const std::string troubles = module_troubles(); !troubles.empty())
      throw Failure(Exit::program, troubles);
    return static_cast<int>(Exit::fine);
  } catch (const Failure& failure) {
    say(failure.what());
    if (const std::string troubles = module_troubles(); troubles != failure.what()) say(troubles);
    return static_cast<int>(failure.exit());
  } catch (const std::exception& error) {
    say(error.what());
    return static_cast<int>(Exit::outside);
  }
}

}  // namespace robosync::tool
