// Messages of the Language Server Protocol in a stream of bytes: a header with their length, then so many bytes. Any bytes
// may come.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace robosync::tool::lsp {

// A file of 16 MiB, every byte of it escaped.
inline constexpr std::size_t kLargestMessage = std::size_t{64} * 1024 * 1024;
inline constexpr std::size_t kLargestHeader = 4096;

struct Frame {
  enum class What {
    incomplete,  // more bytes are needed
    message,
    too_large,  // it is left out, and the next one can be read
    broken      // nobody can say where the next message begins
  };
  What what = What::incomplete;
  std::string body{};  // of a message
};

class FrameReader {
public:
  explicit FrameReader(std::size_t largest = kLargestMessage) : largest_(largest) {}

  void feed(std::string_view bytes);
  // The next message. After `broken` all is.
  [[nodiscard]] Frame next();

private:
  Frame read_header();
  Frame read_body();

  std::size_t largest_;
  std::string bytes_;
  std::size_t taken_ = 0;     // of them
  std::size_t missing_ = 0;   // bytes of a body that has not come yet, all of it
  std::size_t left_out_ = 0;  // bytes of a body that is too large, to come
  bool in_body_ = false;
  bool broken_ = false;
};

// The message with its header.
[[nodiscard]] std::string framed(std::string_view body);

}  // namespace robosync::tool::lsp
