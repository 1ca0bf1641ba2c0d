// rsc(1), generated from the same texts as `rsc help`.
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "rsc/escaped.hpp"
#include "rsc/usage.hpp"

namespace robosync::tool {
namespace {

// A minus that can be copied, and no line that roff reads as a request.
std::string in_roff(std::string_view text) {
  const bool request = text.starts_with('.') || text.starts_with('\'');
  return (request ? "\\&" : "") + escaped(text, {{'\\', "\\e"}, {'-', "\\-"}});
}

std::string option_text(const OptionUsage& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", in_roff(name));
  const std::string space = names.empty() || option.value.empty() ? "" : " ";
  const std::string value =
      option.value.empty() ? "" : fmt::format("\\fI{}\\fR", in_roff(option.value));
  return fmt::format(".TP\n{}{}{}\n{}\n", names, space, value, in_roff(option.description));
}

}  // namespace

std::string manual_page(const std::vector<VerbUsage>& verbs) {
  std::string text = fmt::format(
      ".TH RSC 1 \"\" \"RoboSync {}\"\n"
      ".SH NAME\n"
      "rsc \\- gives a small robot its behaviour\n"
      ".SH SYNOPSIS\n"
      ".B rsc\n"
      ".I VERB\n"
      "[\\fIOPTIONS\\fR]\n"
      ".SH DESCRIPTION\n"
      "Checks, compiles, runs and uploads programs in RSL, the language that tells a robot what to "
      "do and when. \\fBrsc help\\fR \\fIVERB\\fR shows the part of this page about one verb.\n"
      ".SH VERBS\n",
      ROBOSYNC_VERSION);
  for (const VerbUsage& verb : verbs) {
    text += fmt::format(".SS rsc {}\n{}\n", in_roff(verb.name), in_roff(verb.summary));
    for (const OptionUsage& option : verb.options)
      text += option_text(option);
    text += fmt::format(".PP\nExample: \\fB{}\\fR\n", in_roff(verb.example));
  }
  return text +
         ".SH EXIT STATUS\n.TP\n0\nfine\n.TP\n1\nthe program, its configuration or a test is "
         "wrong\n.TP\n2\nwrong usage\n.TP\n3\na file or a device is in trouble, or the robot "
         "refuses the program\n";
}

}  // namespace robosync::tool
