// memcpy, memmove, memset and strlen for a board with little flash: the C library's own are written
// for speed and take 900 bytes. memcpy copies words if both addresses are aligned; the rest is bytes.
#include <cstddef>
#include <cstdint>

namespace {

constexpr std::uintptr_t kWord = sizeof(std::uint32_t);

bool aligned(const void* a, const void* b) {
  return ((reinterpret_cast<std::uintptr_t>(a) | reinterpret_cast<std::uintptr_t>(b)) % kWord) == 0;
}

}  // namespace

extern "C" {

void* memcpy(void* __restrict to, const void* __restrict from, std::size_t bytes) {
  auto* out = static_cast<unsigned char*>(to);
  const auto* in = static_cast<const unsigned char*>(from);
  if (aligned(to, from)) {
    for (; bytes >= kWord; bytes -= kWord, out += kWord, in += kWord)
      *reinterpret_cast<std::uint32_t*>(out) = *reinterpret_cast<const std::uint32_t*>(in);
  }
  for (; bytes > 0; --bytes)
    *out++ = *in++;
  return to;
}

void* memmove(void* to, const void* from, std::size_t bytes) {
  auto* out = static_cast<unsigned char*>(to);
  const auto* in = static_cast<const unsigned char*>(from);
  if (out <= in) {
    for (std::size_t i = 0; i < bytes; ++i)
      out[i] = in[i];
  } else {
    for (std::size_t i = bytes; i > 0; --i)
      out[i - 1] = in[i - 1];
  }
  return to;
}

void* memset(void* to, int value, std::size_t bytes) {
  auto* out = static_cast<unsigned char*>(to);
  for (; bytes > 0; --bytes)
    *out++ = static_cast<unsigned char>(value);
  return to;
}

std::size_t strlen(const char* text) {
  std::size_t length = 0;
  while (text[length] != '\0')
    ++length;
  return length;
}

}  // extern "C"
