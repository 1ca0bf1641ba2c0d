// Converts the compiler's results to the protocol's JSON.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "rsc/json.hpp"
#include "rsc/lsp/workspace.hpp"

namespace robosync::tool::lsp {

// The editor's capabilities from `initialize`.
struct Client {
  bool related_information = false;
  bool markdown = false;
  bool watches_files = false;
  bool nested_symbols = false;
};

// Throws what nlohmann throws if it is malformed.
[[nodiscard]] Place place_in(const Json& position);

[[nodiscard]] Json position_json(Place place);
[[nodiscard]] Json range_json(const compiler::SourceFile& source, std::uint32_t begin,
                              std::uint32_t end, Encoding encoding);
[[nodiscard]] Json range_json(const compiler::SourceMap& sources, compiler::Span span,
                              Encoding encoding);
// The name in a span: strings of robot.json without their quotes.
[[nodiscard]] compiler::Span without_quotes(const compiler::SourceMap& sources,
                                            compiler::Span span);

// The URI of a file of a compilation, as the editor writes it; nothing if there is no such file.
[[nodiscard]] std::optional<std::string> address_of(const std::string& name,
                                                    const Workspace& workspace);
// Null if it is in no file.
[[nodiscard]] Json location_json(const compiler::SourceMap& sources, compiler::Span span,
                                 const Workspace& workspace);

// A program's diagnostics, by the URI of the file in which each is shown.
using Findings = std::map<std::string, std::vector<Json>>;
void add_findings(const Checked& checked, const Workspace& workspace, const Client& client,
                  Findings& findings);
// One of them; nothing if no file shows it.
struct Finding {
  std::string uri;
  Json diagnostic;
};
[[nodiscard]] std::optional<Finding> finding_of(const compiler::Diagnostic& diagnostic,
                                                const Checked& checked, const Workspace& workspace,
                                                const Client& client);

}  // namespace robosync::tool::lsp
