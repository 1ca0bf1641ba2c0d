// See replay_file.hpp. The file is not trusted.
#include "rsc/trace/replay_file.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/json.hpp"
#include "rsc/trace/trace_file.hpp"

namespace robosync::tool {
namespace {

constexpr int kHex = 16;

std::vector<std::byte> bytes_of(const std::string& hex, const std::string& file, std::size_t line) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    std::uint8_t byte = 0;
    const char* const at = hex.data() + i;
    if (i + 2 > hex.size() || std::from_chars(at, at + 2, byte, kHex).ptr != at + 2)
      throw Failure(Exit::program, fmt::format("{}:{}: this is not an image", file, line));
    bytes.push_back(std::byte{byte});
  }
  return bytes;
}

class Reader {
public:
  explicit Reader(const std::string& file) : file_(file) {}

  void see(const TraceLine& line) {
    const std::string kind = line.text("event");
    if (kind == "image") {
      image_ = bytes_of(line.text("hex"), file_, line.number);
    } else if (kind == "whole") {
      whole_programs_ = run_.programs.size();
      whole_events_ = is_open_ ? run_.programs.back().events.size() : 0;
    } else if (kind == "gap") {
      close(line.text("why"));
    } else if (line.event.contains("t_us")) {
      if (kind == "activated") begin(line.number);
      if (is_open_)
        run_.programs.back().events.push_back({line.number, line.event});
      else
        ++run_.loose;
    }
  }

  [[nodiscard]] RecordedRun run() && { return std::move(run_); }

private:
  // Cancels at the end of the previous program come from the upload, not from the program.
  void begin(std::size_t line) {
    if (is_open_) {
      auto& events = run_.programs.back().events;
      while (events.back().event["event"] == "cancel")
        events.pop_back();
    }
    run_.programs.push_back({line, image_, {}, {}});
    is_open_ = true;
  }

  // Events since the last `whole` may lack their causes.
  void close(const std::string& why) {
    for (; run_.programs.size() > whole_programs_; run_.programs.pop_back())
      run_.loose += run_.programs.back().events.size();
    const bool was_open = is_open_ && !run_.programs.empty() && run_.programs.back().gap.empty();
    is_open_ = false;
    if (!was_open || whole_events_ == 0) return;
    RecordedProgram& last = run_.programs.back();
    const std::size_t good = std::min(whole_events_, last.events.size());
    run_.loose += last.events.size() - good;
    last.events.resize(good);
    last.gap = why;
  }

  const std::string& file_;
  std::vector<std::byte> image_;
  RecordedRun run_;
  bool is_open_ = false;  // the last program has no gap yet
  // At the last `whole`: the number of programs, and of events of the last one.
  std::size_t whole_programs_ = 0, whole_events_ = 0;
};

}  // namespace

std::string image_line(std::span<const std::byte> image) {
  std::string hex;
  for (const std::byte byte : image)
    hex += fmt::format("{:02x}", std::to_integer<unsigned>(byte));
  return json_text({{"event", "image"}, {"bytes", image.size()}, {"hex", hex}}) + "\n";
}

std::string whole_line() {
  return json_text({{"event", "whole"}}) + "\n";
}

std::string gap_line(const std::string& why) {
  return json_text({{"event", "gap"}, {"why", why}}) + "\n";
}

RecordedRun read_recording(const std::string& file) {
  Reader reader(file);
  read_trace(file, [&](const TraceLine& line) { reader.see(line); });
  return std::move(reader).run();
}

}  // namespace robosync::tool
