// Splits a byte stream into messages of the Language Server Protocol: a header with the length, then that many bytes. The
// input is not trusted.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace robosync::tool::lsp {

// A file of 16 MiB with every byte escaped.
inline constexpr std::size_t kLargestMessage = std::size_t{64} * 1024 * 1024;
inline constexpr std::size_t kLargestHeader = 4096;

struct Frame {
  enum class What {
    incomplete,  // more bytes are needed
    message,
    too_large,  // skipped; the next message can be read
    broken      // the start of the next message is unknown
  };
  What what = What::incomplete;
  std::string body{};  // of a message
};

class FrameReader {
public:
  explicit FrameReader(std::size_t largest = kLargestMessage) : largest_(largest) {}

  void feed(std::string_view bytes);
  // The next message. `broken` is final.
  [[nodiscard]] Frame next();

private:
  Frame read_header();
  Frame read_body();

  std::size_t largest_;
  std::string bytes_;
  std::size_t taken_ = 0;     // of them
  std::size_t missing_ = 0;   // length of a body that has not all come yet
  std::size_t left_out_ = 0;  // bytes still to skip of a body that is too large
  bool in_body_ = false;
  bool broken_ = false;
};

// The body with its header.
[[nodiscard]] std::string framed(std::string_view body);

}  // namespace robosync::tool::lsp
