#include "rsc/lsp/framing.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "compiler/source/ascii.hpp"

namespace robosync::tool::lsp {
namespace {

constexpr std::string_view kEndOfLine = "\r\n";
constexpr std::string_view kEndOfHeader = "\r\n\r\n";
constexpr std::string_view kBlanks = " \t";

// The value of `Content-Length`; nothing if it is not there exactly once, or is not a number.
std::optional<std::size_t> content_length(std::string_view header) {
  std::optional<std::size_t> length;
  while (!header.empty()) {
    const std::size_t end = std::min(header.find(kEndOfLine), header.size());
    const std::string_view line = header.substr(0, end);
    header.remove_prefix(std::min(end + kEndOfLine.size(), header.size()));
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) return std::nullopt;
    if (!compiler::ascii::same(line.substr(0, colon), "Content-Length")) continue;
    std::string_view value = line.substr(colon + 1);
    value.remove_prefix(std::min(value.find_first_not_of(kBlanks), value.size()));
    value = value.substr(0, value.find_last_not_of(kBlanks) + 1);
    std::size_t number = 0;
    const auto [stop, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    const bool whole = error == std::errc() && stop == value.data() + value.size();
    if (!whole || length) return std::nullopt;
    length = number;
  }
  return length;
}

}  // namespace

void FrameReader::feed(std::string_view bytes) {
  const std::size_t gone = std::min(left_out_, bytes.size());
  left_out_ -= gone;
  bytes.remove_prefix(gone);
  bytes_.erase(0, taken_);
  taken_ = 0;
  if (!broken_) bytes_.append(bytes);
}

Frame FrameReader::next() {
  if (broken_) return {Frame::What::broken};
  return in_body_ ? read_body() : read_header();
}

Frame FrameReader::read_header() {
  const std::string_view rest = std::string_view(bytes_).substr(taken_);
  const std::size_t end = rest.substr(0, kLargestHeader).find(kEndOfHeader);
  if (end == std::string_view::npos) {
    broken_ = rest.size() >= kLargestHeader;
    return {broken_ ? Frame::What::broken : Frame::What::incomplete};
  }
  const auto length = content_length(rest.substr(0, end));
  broken_ = !length.has_value();
  if (broken_) return {Frame::What::broken};
  taken_ += end + kEndOfHeader.size();
  if (*length > largest_) {
    const std::size_t here = std::min(*length, bytes_.size() - taken_);
    taken_ += here;
    left_out_ = *length - here;
    return {Frame::What::too_large};
  }
  missing_ = *length;
  in_body_ = true;
  return read_body();
}

Frame FrameReader::read_body() {
  if (bytes_.size() - taken_ < missing_) return {Frame::What::incomplete};
  Frame frame{Frame::What::message, bytes_.substr(taken_, missing_)};
  taken_ += missing_;
  in_body_ = false;
  return frame;
}

std::string framed(std::string_view body) {
  return "Content-Length: " + std::to_string(body.size()) + std::string(kEndOfHeader) +
         std::string(body);
}

}  // namespace robosync::tool::lsp
