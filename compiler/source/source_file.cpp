// See source_file.hpp.
#include "compiler/source/source_file.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "compiler/source/utf8.hpp"

namespace robosync::compiler {

namespace {

// Bytes of a line between two milestones: the most that are read to find a column.
constexpr std::size_t kMilestone = 256;

}  // namespace

SourceFile::SourceFile(std::string name, std::string text)
    : name_(std::move(name)), text_(std::move(text)), line_starts_{0} {
  // A line ends with LF, CR LF, or a CR alone. The text is scanned once for each of the two characters.
  std::size_t lf = text_.find('\n'), cr = text_.find('\r');
  while (std::min(lf, cr) != std::string::npos) {
    const std::size_t end = cr + 1 == lf ? lf : std::min(lf, cr);
    add_milestones(line_starts_.back(), end);
    line_starts_.push_back(static_cast<std::uint32_t>(end + 1));
    if (lf <= end) lf = text_.find('\n', end + 1);
    if (cr <= end) cr = text_.find('\r', end + 1);
  }
  add_milestones(line_starts_.back(), text_.size());
}

void SourceFile::add_milestones(std::size_t begin, std::size_t end) {
  if (end - begin <= kMilestone) return;
  std::uint32_t column = 1;
  std::size_t next = begin + kMilestone;
  for (std::size_t i = begin; i < end; ++column) {
    if (i >= next) {
      milestones_.push_back({static_cast<std::uint32_t>(i), column});
      next = i + kMilestone;
    }
    i += utf8::decode(text_, i).size;
  }
}

std::string_view SourceFile::text(Span span) const {
  const std::size_t begin = std::min<std::size_t>(span.begin, text_.size());
  const std::size_t end = std::clamp<std::size_t>(span.end, begin, text_.size());
  return std::string_view(text_).substr(begin, end - begin);
}

std::uint32_t SourceFile::line_of(std::uint32_t offset) const {
  const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  return static_cast<std::uint32_t>(next - line_starts_.begin());
}

Position SourceFile::position(std::uint32_t offset) const {
  const std::uint32_t line = line_of(offset);
  const std::size_t end = std::min<std::size_t>(offset, text_.size());
  Milestone from{line_starts_[line - 1], 1};
  const auto beyond = std::upper_bound(
      milestones_.begin(), milestones_.end(), offset,
      [](std::uint32_t place, const Milestone& one) { return place < one.offset; });
  if (beyond != milestones_.begin() && std::prev(beyond)->offset > from.offset)
    from = *std::prev(beyond);
  for (std::size_t i = from.offset; i < end; ++from.column)
    i += utf8::decode(text_, i).size;
  return {line, from.column};
}

std::string_view SourceFile::line(std::uint32_t number) const {
  if (number == 0 || number > line_starts_.size()) return {};
  const std::size_t begin = line_starts_[number - 1];
  std::size_t end = number < line_starts_.size() ? line_starts_[number] : text_.size();
  while (end > begin && (text_[end - 1] == '\n' || text_[end - 1] == '\r'))
    --end;
  return std::string_view(text_).substr(begin, end - begin);
}

std::uint32_t SourceFile::line_start(std::uint32_t number) const {
  const std::size_t index = std::clamp<std::size_t>(number, 1, line_starts_.size());
  return line_starts_[index - 1];
}

FileId SourceMap::add(std::string name, std::string text) {
  files_.emplace_back(std::move(name), std::move(text));
  return static_cast<FileId>(files_.size() - 1);
}

}  // namespace robosync::compiler
