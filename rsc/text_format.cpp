// See text_format.hpp.
#include "rsc/text_format.hpp"

#include <filesystem>
#include <string_view>

#include "compiler/config/json_format.hpp"
#include "compiler/config/json_reader.hpp"
#include "compiler/source/ascii.hpp"
#include "compiler/source/utf8.hpp"
#include "compiler/syntax/format.hpp"
#include "compiler/syntax/parser.hpp"

namespace robosync::tool {
namespace {

// The text of stdin has no name that tells. No program begins with a brace.
bool is_json(const compiler::SourceFile& file) {
  const std::string_view text = compiler::utf8::without_byte_order_mark(file.text());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return compiler::ascii::same(std::filesystem::path(file.name()).extension().string(), ".json") ||
         (first != std::string_view::npos && text[first] == '{');
}

}  // namespace

std::optional<std::string> formatted(const compiler::SourceMap& sources, compiler::FileId file,
                                     compiler::Diagnostics& diagnostics) {
  if (is_json(sources.file(file))) {
    const auto root = compiler::json::read(sources, file, diagnostics);
    if (!root || diagnostics.errors() > 0) return std::nullopt;
    return compiler::json::formatted(sources, file, *root);
  }
  const compiler::ast::Tree tree = compiler::parse(sources, file, diagnostics);
  if (diagnostics.errors() > 0) return std::nullopt;
  return compiler::formatted(sources, file, tree);
}

}  // namespace robosync::tool
