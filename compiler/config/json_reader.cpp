// Turns JSON text into a tree with source positions. The text may be anything; every mistake becomes one E0201.
#include "compiler/config/json_reader.hpp"

#include <algorithm>
#include <string>

#include "compiler/config/json_mistakes.hpp"
#include "compiler/diagnostics/plain_text.hpp"
#include "compiler/source/json.hpp"
#include "compiler/source/utf8.hpp"

namespace robosync::compiler::json {
namespace {

// Receives nlohmann's events and builds the tree. nlohmann defines the method names and return values.
class Builder {
public:
  Builder(std::string_view text, FileId file, Diagnostics& diagnostics)
      : text_(text), file_(file), diagnostics_(diagnostics) {
    if (text_.starts_with(utf8::kByteOrderMark)) cursor_ = utf8::kByteOrderMark.size();
  }

  bool null() { return scalar(Kind::null); }
  bool boolean(bool truth) { return scalar(Kind::boolean, {}, truth); }
  bool number_integer(std::int64_t) { return number(); }
  bool number_unsigned(std::uint64_t) { return number(); }
  bool number_float(double, const std::string&) { return number(); }
  bool string(std::string& contents) { return scalar(Kind::string, contents); }
  bool binary(Json::binary_t&) { return false; }  // not in JSON text
  bool start_object(std::size_t) { return open(Kind::object); }
  bool start_array(std::size_t) { return open(Kind::array); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(std::string& contents) {
    keys_.back() = Member{contents, next_token(), {}};
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const Json::exception& reason) {
    report_mistake({text_, file_, cursor_, position, reason.what(),
                    open_.empty() ? std::nullopt : std::optional<Span>(open_.back().span)},
                   diagnostics_);
    return false;
  }

  std::optional<Value> take() { return std::move(root_); }

private:
  // The span of the current event's token. Moves the cursor past it.
  Span next_token() {
    while (cursor_ < text_.size() &&
           std::string_view(" \t\r\n,:").find(text_[cursor_]) != std::string_view::npos)
      ++cursor_;
    const std::size_t begin = cursor_;
    cursor_ = token_end(begin);
    return {file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(cursor_)};
  }

  std::size_t token_end(std::size_t begin) const {
    std::size_t end = begin + 1;
    if (text_[begin] == '"') {
      while (end < text_.size() && text_[end] != '"')
        end += text_[end] == '\\' ? 2 : 1;
      return end + 1;
    }
    const auto is_part = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
    };
    if (!is_part(text_[begin])) return end;
    while (end < text_.size() && is_part(text_[end]))
      ++end;
    return end;
  }

  bool number() {
    const Span span = next_token();
    add({Kind::number,
         span,
         std::string(text_.substr(span.begin, span.end - span.begin)),
         false,
         {},
         {}});
    return true;
  }

  bool scalar(Kind kind, std::string contents = {}, bool truth = false) {
    add({kind, next_token(), std::move(contents), truth, {}, {}});
    return true;
  }

  bool open(Kind kind) {
    const Span span = next_token();
    if (open_.size() == kMaxDepth) {
      diagnostics_
          .report(Code::E0201, "this is nested more than " + std::to_string(kMaxDepth) +
                                   " levels deep, the most that rsc reads")
          .label(span);
      return false;
    }
    open_.push_back({kind, span, {}, false, {}, {}});
    keys_.emplace_back();
    return true;
  }

  bool close() {
    Value done = std::move(open_.back());
    done.span.end = next_token().end;
    open_.pop_back();
    keys_.pop_back();
    add(std::move(done));
    return true;
  }

  void add(Value value) {
    if (open_.empty()) {
      root_ = std::move(value);
    } else if (Value& parent = open_.back(); parent.kind == Kind::array) {
      parent.items.push_back(std::move(value));
    } else {
      keys_.back().value = std::move(value);
      parent.members.push_back(std::move(keys_.back()));
    }
  }

  std::string_view text_;
  FileId file_;
  Diagnostics& diagnostics_;
  std::size_t cursor_ = 0;    // everything before it has been read
  std::vector<Value> open_;   // arrays and objects not yet closed, outermost first
  std::vector<Member> keys_;  // the key last read in each of them
  std::optional<Value> root_;
};

}  // namespace

std::optional<Value> read(const SourceMap& sources, FileId file, Diagnostics& diagnostics) {
  if (!is_plain_text(sources, file, Code::E0201, diagnostics)) return std::nullopt;
  const std::string_view text = sources.file(file).text();
  Builder builder(text, file, diagnostics);
  // Everything reads JSON from a std::string: for another type the library would make a parser of its own.
  if (!Json::sax_parse(std::string(text), &builder)) return std::nullopt;
  return builder.take();
}

const Value* find(const Value& object, std::string_view key) {
  const auto found = std::ranges::find(object.members, key, &Member::key);
  return found == object.members.end() ? nullptr : &found->value;
}

std::string_view kind_phrase(Kind kind) {
  switch (kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return "true or false";
    case Kind::number:
      return "a number";
    case Kind::string:
      return "a string";
    case Kind::array:
      return "a list";
    case Kind::object:
      return "an object";
  }
  return "";
}

}  // namespace robosync::compiler::json
