// Answers to an editor's requests about a text. Each takes the `params` of the request and returns its `result`; null if
// there is nothing to say. They throw Refusal, or what nlohmann throws for a malformed request.
#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include "rsc/lsp/convert.hpp"

namespace robosync::tool::lsp {

// The request is valid, but cannot be carried out.
class Refusal : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

struct Desk {
  Workspace& workspace;
  const Client& client;
};

[[nodiscard]] Json formatting(Desk desk, const Json& params);
[[nodiscard]] Json code_actions(Desk desk, const Json& params);
[[nodiscard]] Json completion(Desk desk, const Json& params);
[[nodiscard]] Json hover(Desk desk, const Json& params);
[[nodiscard]] Json definition(Desk desk, const Json& params);
[[nodiscard]] Json references(Desk desk, const Json& params);
[[nodiscard]] Json highlights(Desk desk, const Json& params);
[[nodiscard]] Json prepare_rename(Desk desk, const Json& params);
[[nodiscard]] Json rename(Desk desk, const Json& params);
[[nodiscard]] Json document_symbols(Desk desk, const Json& params);
[[nodiscard]] Json semantic_tokens(Desk desk, const Json& params);
[[nodiscard]] Json colour_legend();  // the meaning of the numbers of semantic_tokens()
[[nodiscard]] Json folding_ranges(Desk desk, const Json& params);
[[nodiscard]] Json inlay_hints(Desk desk, const Json& params);
[[nodiscard]] Json signature_help(Desk desk, const Json& params);

// The worst-case cost of a file's rules in instructions, by the line on which each starts; nothing if the program has errors.
[[nodiscard]] std::map<std::uint32_t, std::uint32_t> costs_by_line(const compiler::Result& result,
                                                                   compiler::FileId file);

// A place in a text, and what is there.
struct Asked {
  const Checked* checked = nullptr;
  compiler::FileId file = 0;
  std::uint32_t offset = 0;
};
// Nothing if the text is not part of a program.
[[nodiscard]] std::optional<Asked> asked_at(Desk desk, const Json& params);
// The URI in `textDocument`.
[[nodiscard]] std::string address_in(const Json& params);

}  // namespace robosync::tool::lsp
