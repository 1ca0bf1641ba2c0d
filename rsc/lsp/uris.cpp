#include "rsc/lsp/uris.hpp"

#include <charconv>

namespace robosync::tool::lsp {
namespace {

constexpr std::string_view kScheme = "file://";
constexpr std::string_view kPlain =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
constexpr std::size_t kEscape = 3;  // "%20"

// The byte of an escape; nothing if it is not an escape.
std::optional<char> unescaped(std::string_view text) {
  if (text.size() < kEscape || text.front() != '%') return std::nullopt;
  unsigned value = 0;
  const auto [stop, error] = std::from_chars(text.data() + 1, text.data() + kEscape, value, 16);
  if (error != std::errc() || stop != text.data() + kEscape || value == 0) return std::nullopt;
  return static_cast<char>(value);
}

}  // namespace

std::optional<std::filesystem::path> path_of(std::string_view uri) {
  if (!uri.starts_with(kScheme)) return std::nullopt;
  uri.remove_prefix(kScheme.size());
  const std::size_t slash = uri.find('/');  // after the host name
  if (slash == std::string_view::npos) return std::nullopt;
  uri.remove_prefix(slash);
  std::string path;
  while (!uri.empty()) {
    const auto byte = unescaped(uri);
    path += byte.value_or(uri.front());
    uri.remove_prefix(byte ? kEscape : 1);
  }
  return std::filesystem::path(path).lexically_normal();
}

std::string uri_of(const std::filesystem::path& path) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string uri(kScheme);
  for (const char c : path.string()) {
    if (kPlain.find(c) != std::string_view::npos) {
      uri += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    uri += {'%', kDigits[byte / 16], kDigits[byte % 16]};
  }
  return uri;
}

}  // namespace robosync::tool::lsp
