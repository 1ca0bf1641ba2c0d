// Reads JSON text into a tree that knows where every value stands.
//
// nlohmann's parser does the reading; its SAX events arrive in the order of the text, so a cursor
// that walks along finds each token's place. Numbers stay as written: nothing is rounded here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/source/source_file.hpp"

namespace robosync::compiler::json {

enum class Kind : std::uint8_t { null, boolean, number, string, array, object };

struct Member;

struct Value {
  Kind kind = Kind::null;
  Span span;
  std::string text;  // of a string: its contents; of a number: its digits as written
  bool truth = false;
  std::vector<Value> items;     // of an array
  std::vector<Member> members;  // of an object, in the order of the text, repeated keys included
};

struct Member {
  std::string key;
  Span key_span;
  Value value;
};

inline constexpr std::size_t kMaxDepth = 32;

// Nothing when the text is not JSON or nested deeper than kMaxDepth; that has then been reported.
[[nodiscard]] std::optional<Value> read(const SourceMap& sources, FileId file,
                                        Diagnostics& diagnostics);

[[nodiscard]] std::string_view kind_phrase(Kind kind);  // "a string"

}  // namespace robosync::compiler::json
