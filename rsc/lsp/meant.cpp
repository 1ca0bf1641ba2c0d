// See meant.hpp.
#include "rsc/lsp/meant.hpp"

#include <algorithm>

#include "rsc/lsp/uris.hpp"

namespace robosync::tool::lsp {

namespace query = compiler::query;
using compiler::kConfigurationFile;

std::optional<Meant> meant_by(const Asked& asked) {
  const query::Symbols& symbols = asked.checked->symbols();
  const query::Occurrence* const name = symbols.at(asked.file, asked.offset);
  if (name == nullptr) return std::nullopt;
  return Meant{asked, name, &symbols.all().at(name->symbol)};
}

std::vector<query::Occurrence> places_of(const Meant& meant) {
  return meant.asked.checked->symbols().of(meant.name->symbol);
}

std::vector<Meant> meant_here(Desk desk, const Json& params) {
  std::vector<Meant> result;
  const auto first = asked_at(desk, params);
  const auto path = path_of(address_in(params));
  if (!first || !path) return result;
  for (const Checked* const checked : desk.workspace.users_of(*path)) {
    const auto meant = meant_by({checked, checked->file(*path).value(), first->offset});
    if (meant) result.push_back(*meant);
  }
  return result;
}

namespace {

// The first place of the name in robot.json; nothing if it is not there.
std::optional<compiler::Span> place_in_robot(const Meant& meant) {
  for (const query::Occurrence& one : places_of(meant))
    if (one.span.file == kConfigurationFile) return one.span;
  return std::nullopt;
}

bool has(const std::vector<Meant>& all, const Checked& checked) {
  return std::ranges::any_of(all, [&](const Meant& one) { return one.asked.checked == &checked; });
}

}  // namespace

std::vector<Meant> meant_everywhere(Desk desk, const Json& params) {
  std::vector<Meant> result = meant_here(desk, params);
  const std::vector<Meant> here = result;
  for (const Meant& meant : here) {
    const auto place = place_in_robot(meant);
    if (!place) continue;
    const std::string& robot = sources_of(meant.asked).file(kConfigurationFile).name();
    for (const std::string& program : desk.workspace.users_of_configuration(robot)) {
      const Checked& checked = desk.workspace.checked(program);
      if (has(result, checked) || checked.file(robot) != kConfigurationFile) continue;
      const auto other = meant_by({&checked, kConfigurationFile, place->begin + 1});
      if (other) result.push_back(*other);
    }
  }
  return result;
}

}  // namespace robosync::tool::lsp
