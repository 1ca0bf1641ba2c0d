// See embedded.hpp.
#include "compiler/source/embedded.hpp"

#include <stdexcept>

#include <zlib.h>

namespace robosync::compiler {

std::string unpacked(std::span<const unsigned char> packed, std::size_t size) {
  constexpr int kGzip = 16 + MAX_WBITS;
  std::string text(size, '\0');
  z_stream stream{};
  stream.next_in = const_cast<unsigned char*>(packed.data());  // zlib does not write to it
  stream.avail_in = static_cast<unsigned>(packed.size());
  stream.next_out = reinterpret_cast<unsigned char*>(text.data());
  stream.avail_out = static_cast<unsigned>(size);
  if (inflateInit2(&stream, kGzip) != Z_OK) throw std::bad_alloc();
  const int end = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  if (end != Z_STREAM_END || stream.avail_out != 0)
    throw std::logic_error("a text in this program is damaged");
  return text;
}

}  // namespace robosync::compiler
