// What the compiler says, as the protocol writes it.
#pragma once

#include <map>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "rsc/lsp/workspace.hpp"

namespace robosync::tool::lsp {

using Json = nlohmann::json;

// What the editor can do, as it said in `initialize`.
struct Client {
  bool related_information = false;
  bool markdown = false;
  bool watches_files = false;
  bool nested_symbols = false;
};

// Throws what nlohmann throws when it is none.
[[nodiscard]] Place place_in(const Json& position);

[[nodiscard]] Json position_json(Place place);
[[nodiscard]] Json range_json(const compiler::SourceFile& source, std::uint32_t begin,
                              std::uint32_t end, Encoding encoding);
[[nodiscard]] Json range_json(const compiler::SourceMap& sources, compiler::Span span,
                              Encoding encoding);
// The name in a span: strings of robot.json without their quotes.
[[nodiscard]] compiler::Span without_quotes(const compiler::SourceMap& sources,
                                            compiler::Span span);

// The address of a file of a compilation, as the editor writes it; nothing when there is no such file.
[[nodiscard]] std::optional<std::string> address_of(const std::string& name,
                                                    const Workspace& workspace);
// Null when it is in no file.
[[nodiscard]] Json location_json(const compiler::SourceMap& sources, compiler::Span span,
                                 const Workspace& workspace);

// What a program's compilation found, by the address of the file that each is shown in.
using Findings = std::map<std::string, std::vector<Json>>;
void add_findings(const Checked& checked, const Workspace& workspace, const Client& client,
                  Findings& findings);
// One of them; nothing when no file shows it.
struct Finding {
  std::string uri;
  Json diagnostic;
};
[[nodiscard]] std::optional<Finding> finding_of(const compiler::Diagnostic& diagnostic,
                                                const Checked& checked, const Workspace& workspace,
                                                const Client& client);

}  // namespace robosync::tool::lsp
