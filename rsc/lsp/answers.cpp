#include "rsc/lsp/answers.hpp"

#include "rsc/lsp/uris.hpp"

namespace robosync::tool::lsp {

using compiler::SourceFile;

std::string address_in(const Json& params) {
  return params.at("textDocument").at("uri").get<std::string>();
}

std::optional<Asked> asked_at(Desk desk, const Json& params) {
  const Place place = place_in(params.at("position"));
  const auto path = path_of(address_in(params));
  if (!path) return std::nullopt;
  const auto users = desk.workspace.users_of(*path);
  if (users.empty()) return std::nullopt;
  const Checked& checked = *users.front();
  const compiler::FileId file = checked.file(*path).value();
  const SourceFile& source = checked.result().sources.file(file);
  return Asked{&checked, file, offset_of(source, place, desk.workspace.encoding())};
}

}  // namespace robosync::tool::lsp
