// See json_format.hpp. read() limits how deeply values are nested, so the functions here may call themselves.
#include "compiler/config/json_format.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>

namespace robosync::compiler::json {
namespace {

constexpr std::size_t kWidth = 130;     // columns
constexpr std::size_t kJsonIndent = 2;  // of the keys of the robot; its parts have twice that

bool is_container(const Value& value) {
  return value.kind == Kind::object || value.kind == Kind::array;
}

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

// What stands between the brackets of a value: items, which have no key, or members.
struct Entry {
  const Span* key;
  const Value* value;
};

std::vector<Entry> entries_of(const Value& value) {
  std::vector<Entry> entries;
  for (const Value& item : value.items)
    entries.push_back({nullptr, &item});
  for (const Member& member : value.members)
    entries.push_back({&member.key_span, &member.value});
  return entries;
}

class JsonWriter {
public:
  JsonWriter(const SourceMap& sources, FileId file)
      : sources_(sources), text_(sources.file(file).text()) {}

  std::string write(const Value& root) {
    if (root.kind == Kind::object && !root.members.empty())
      one_a_line(root, kJsonIndent);
    else
      fill(root, 0);
    return out_ + "\n";
  }

private:
  // Each entry in a line of its own.
  void one_a_line(const Value& value, std::size_t indent) {
    const std::vector<Entry> entries = entries_of(value);
    const std::vector<std::size_t> columns = columns_of(value, indent);
    open(value);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const Entry& entry = entries[i];
      if (i > 0 && is_blank_line_before(entry)) out_ += '\n';
      out_ += '\n' + std::string(indent, ' ');
      write_key(entry);
      const bool last = i + 1 == entries.size();
      if (!columns.empty())
        out_ += row(*entry.value, columns);
      else if (indent == kJsonIndent && is_in_lines(*entry.value))
        one_a_line(*entry.value, indent + kJsonIndent);
      else
        fill(*entry.value, last ? 0 : 1);
      if (!last) out_ += ',';
    }
    out_ += '\n' + std::string(indent - kJsonIndent, ' ');
    close(value);
  }

  // Parts with the same keys form a table: the widths of its columns. Empty if they do not, or if it is too wide.
  std::vector<std::size_t> columns_of(const Value& list, std::size_t indent) const {
    std::vector<std::size_t> columns;
    if (list.items.size() < 2 || list.items.front().members.empty()) return columns;
    columns.resize(list.items.front().members.size());
    for (const Value& item : list.items) {
      if (!std::ranges::equal(item.members, list.items.front().members, {}, &Member::key,
                              &Member::key))
        return {};
      for (std::size_t i = 0; i < columns.size(); ++i)
        columns[i] = std::max(columns[i], width_of(cell(item, i)));
    }
    const std::size_t width = std::accumulate(columns.begin(), columns.end(), columns.size());
    return indent + width + 2 > kWidth ? std::vector<std::size_t>()
                                       : columns;  // a bracket and a comma
  }

  std::string row(const Value& item, const std::vector<std::size_t>& columns) const {
    std::string line = "{";
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string text = cell(item, i);
      line += text;
      if (i + 1 < columns.size()) line.append(columns[i] + 1 - width_of(text), ' ');
    }
    return line + "}";
  }

  // `"pin": 3,`
  std::string cell(const Value& item, std::size_t number) const {
    const Member& member = item.members[number];
    return key_of({&member.key_span, &member.value}) + in_one_line(member.value) +
           (number + 1 < item.members.size() ? "," : "");
  }

  // As many entries in a line as fit. `behind`: columns for what follows the value.
  void fill(const Value& value, std::size_t behind) {
    const std::string whole = in_one_line(value);
    if (!is_container(value) || column() + width_of(whole) + behind <= kWidth) {
      out_ += whole;
      return;
    }
    open(value);
    const std::size_t indent = column();
    const std::vector<Entry> entries = entries_of(value);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const std::size_t more = i + 1 == entries.size() ? behind + 1 : 1;  // a bracket or a comma
      const std::size_t width =
          width_of(key_of(entries[i]) + in_one_line(*entries[i].value)) + more;
      if (i > 0 && column() + 1 + width > kWidth)
        out_ += '\n' + std::string(indent, ' ');
      else if (i > 0)
        out_ += ' ';
      write_key(entries[i]);
      fill(*entries[i].value, more);
      if (i + 1 < entries.size()) out_ += ',';
    }
    close(value);
  }

  std::string in_one_line(const Value& value) const {
    if (!is_container(value)) return std::string(sources_.text(value.span));
    std::string line;
    for (const Entry& entry : entries_of(value))
      line += (line.empty() ? "" : ", ") + key_of(entry) + in_one_line(*entry.value);
    return value.kind == Kind::object ? "{" + line + "}" : "[" + line + "]";
  }

  std::string key_of(const Entry& entry) const {
    return entry.key == nullptr ? "" : std::string(sources_.text(*entry.key)) + ": ";
  }
  void write_key(const Entry& entry) { out_ += key_of(entry); }
  void open(const Value& value) { out_ += value.kind == Kind::object ? '{' : '['; }
  void close(const Value& value) { out_ += value.kind == Kind::object ? '}' : ']'; }

  // A list of parts, or an object that is too long for a line. Its key has been written.
  bool is_in_lines(const Value& value) const {
    if (value.kind == Kind::object)
      return !value.members.empty() && column() + width_of(in_one_line(value)) + 1 > kWidth;
    return value.kind == Kind::array && !value.items.empty() &&
           std::ranges::all_of(value.items, [](const Value& item) { return is_container(item); });
  }

  bool is_blank_line_before(const Entry& entry) const {
    const std::size_t begin = (entry.key != nullptr ? *entry.key : entry.value->span).begin;
    const std::size_t last = text_.find_last_not_of(" \t\r\n,", begin - 1);
    return std::ranges::count(text_.substr(last, begin - last), '\n') > 1;
  }

  std::size_t column() const {
    const std::size_t line = out_.rfind('\n');
    return width_of(std::string_view(out_).substr(line == std::string::npos ? 0 : line + 1));
  }

  const SourceMap& sources_;
  std::string_view text_;
  std::string out_;
};

}  // namespace

std::string formatted(const SourceMap& sources, FileId file, const Value& root) {
  return JsonWriter(sources, file).write(root);
}

}  // namespace robosync::compiler::json
