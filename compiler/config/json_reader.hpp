// Reads JSON text into a tree in which every value has its source position.
//
// nlohmann's parser does the reading. Its SAX events arrive in the order of the text, so a cursor that moves along finds each
// token's place. Numbers keep their digits: nothing is rounded here.
#pragma once

#include <optional>
#include <string>
#include <string_view>
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

// nullopt if the text is not JSON or is nested deeper than kMaxDepth; either is reported.
[[nodiscard]] std::optional<Value> read(const SourceMap& sources, FileId file,
                                        Diagnostics& diagnostics);

// The first value with this key; null: there is none, or it is no object.
[[nodiscard]] const Value* find(const Value& object, std::string_view key);

[[nodiscard]] std::string_view kind_phrase(Kind kind);  // "a string"

}  // namespace robosync::compiler::json
