// Source text and places in it. A place is a byte offset; lines and columns are computed only
// when a message is printed. A text may hold any bytes; places past its end count as its end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace robosync::compiler {

using FileId = std::uint16_t;

// The first two files of a compilation; the modules that the program uses follow.
inline constexpr FileId kProgramFile = 0;
inline constexpr FileId kConfigurationFile = 1;

// The bytes begin … end-1 of one file.
struct Span {
  FileId file = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

struct Position {
  std::uint32_t line = 1;    // from 1
  std::uint32_t column = 1;  // from 1, in Unicode code points
};

class SourceFile {
public:
  SourceFile(std::string name, std::string text);
  const std::string& name() const { return name_; }
  std::string_view text() const { return text_; }
  std::string_view text(Span span) const;
  Position position(std::uint32_t offset) const;
  std::string_view line(std::uint32_t number) const;  // without its ending; empty if there is none
  std::uint32_t line_start(std::uint32_t number) const;
  std::uint32_t line_of(std::uint32_t offset) const;  // from 1
  std::uint32_t lines() const { return static_cast<std::uint32_t>(line_starts_.size()); }

private:
  // A known column in a long line, so that a lookup does not read the line from its start.
  struct Milestone {
    std::uint32_t offset, column;
  };
  void add_milestones(std::size_t begin, std::size_t end);  // for one line

  std::string name_;
  std::string text_;
  std::vector<std::uint32_t> line_starts_;
  std::vector<Milestone> milestones_;  // in text order
};

// Every file of one compilation. FileId is the index in this list. References to files and views of
// their text stay valid as long as the list exists, even if it is moved.
class SourceMap {
public:
  SourceMap() = default;
  SourceMap(SourceMap&&) = default;
  SourceMap& operator=(SourceMap&&) = default;

  FileId add(std::string name, std::string text);
  const SourceFile& file(FileId id) const { return files_[id]; }
  std::size_t size() const { return files_.size(); }
  std::string_view text(Span span) const { return files_[span.file].text(span); }

private:
  std::deque<SourceFile> files_;
};

}  // namespace robosync::compiler
