// See line_recorder.hpp. Promises that events are on disk shortly after they were
// seen, however this program ends.
#include "rsc/device/line_recorder.hpp"

#include <fmt/format.h>

#include "rsc/failure.hpp"
#include "rsc/trace/replay_file.hpp"

namespace robosync::tool {

LineRecorder::LineRecorder(const std::string& file)
    : file_(file), stream_(file, std::ios::binary | std::ios::trunc) {
  work(nullptr);
}

void LineRecorder::program(const TraceNames&, std::span<const std::byte> image) {
  stream_ << image_line(image);
}

void LineRecorder::event(const link::Event& event, const TraceNames& names) {
  stream_ << trace_json(event, names) << '\n';
}

// The losses in a status were counted before it was sent.
void LineRecorder::status(const link::Status&) {
  if (!missed_) stream_ << whole_line();
  missed_ = false;
}

void LineRecorder::missed(const std::string& why) {
  missed_ = true;
  stream_ << gap_line(why);
}

bool LineRecorder::work(Session*) {
  stream_.flush();
  if (!stream_) throw Failure(Exit::outside, fmt::format("cannot write {}", file_));
  return true;
}

}  // namespace robosync::tool
