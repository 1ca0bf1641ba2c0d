// See trace_file.hpp. The file is not trusted.
#include "rsc/trace/trace_file.hpp"

#include <algorithm>
#include <fstream>
#include <iostream>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {
namespace {

constexpr std::uint64_t kLatestUs = std::uint64_t{1} << 53;  // 285 years; sums cannot overflow

[[noreturn]] void fail(const std::string& file, std::size_t line, const std::string& why) {
  throw Failure(
      Exit::program,
      fmt::format("{}:{}: {}; `rsc run --trace` and `rsc monitor --format json` write traces", file,
                  line, why));
}

// A device may never end.
bool next_line(std::ifstream& stream, std::string& text, const std::string& file,
               std::size_t number) {
  constexpr std::size_t kLongest = std::size_t{1024} * 1024;  // an image of 64 KB takes 128 KB
  text.clear();
  for (char c = 0; stream.get(c);) {
    if (c == '\n') return true;
    if (text.size() == kLongest) fail(file, number, "this line has more than a million characters");
    text += c;
  }
  return !text.empty();
}

// Assigns programs and times to the lines.
class Counting {
public:
  explicit Counting(const std::string& file) : file_(file) {}

  void place(TraceLine& line) {
    if (line.event["event"] == "activated" && has_begun_) {
      begin_us_ = at_us_;
      ++program_;
    }
    if (const auto time = line.event.find("t_us"); time != line.event.end()) {
      if (!time->is_number_unsigned() || time->get<std::uint64_t>() > kLatestUs - begin_us_)
        fail(file_, line.number, "`t_us` is not a program time");
      at_us_ = std::max(at_us_, begin_us_ + time->get<std::uint64_t>());
      has_begun_ = true;
    }
    line.program = program_;
    line.at_us = at_us_;
  }

private:
  const std::string& file_;
  std::size_t program_ = 1;
  bool has_begun_ = false;      // an event of a program has been seen
  std::uint64_t begin_us_ = 0;  // of the current program
  std::uint64_t at_us_ = 0;
};

}  // namespace

std::string TraceLine::text(const char* key) const {
  const auto found = event.find(key);
  if (found == event.end() || found->is_null()) return {};
  return found->is_string() ? found->get<std::string>() : json_text(*found);
}

void read_trace(const std::string& file, const std::function<void(const TraceLine&)>& see) {
  std::ifstream stream(file);
  if (!stream)
    throw Failure(Exit::outside,
                  fmt::format("{}: there is no such file, or it cannot be read", file));
  Counting counting(file);
  TraceLine line;
  for (std::string text; next_line(stream, text, file, line.number + 1);) {
    ++line.number;
    const bool is_cut = stream.eof();  // every complete line ends with a newline
    line.event = read_json(text);
    if (is_cut && line.event.is_discarded()) {
      std::cerr << fmt::format("note: {}:{}: this line is incomplete, and is left out\n", file,
                               line.number);
      return;
    }
    if (!line.event.is_object() || !line.event.contains("event") ||
        !line.event["event"].is_string())
      fail(file, line.number, "this is not a line of a trace");
    counting.place(line);
    see(line);
  }
  if (stream.bad() || line.number == 0)
    throw Failure(Exit::outside, fmt::format("{}: it is empty, or cannot be read", file));
}

}  // namespace robosync::tool
