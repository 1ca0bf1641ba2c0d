// Selects the kind of line by the port's name.
#include "rsc/device/transport.hpp"

#include <filesystem>
#include <string_view>
#include <system_error>

#include "rsc/device/file_transport.hpp"
#include "rsc/device/serial_transport.hpp"

namespace robosync::tool {
namespace {

constexpr std::string_view kUnix = "unix:", kTcp = "tcp:";

// A link to a pty counts as one.
bool is_pty(const std::string& port) {
  std::error_code error;
  const auto real = std::filesystem::canonical(port, error);
  return !error && real.string().starts_with("/dev/pts/");
}

}  // namespace

std::string real_name_of(const std::string& port) {
  if (port.starts_with(kTcp)) return port;
  const std::string kind(port.starts_with(kUnix) ? kUnix : "");
  std::error_code error;
  const auto real = std::filesystem::weakly_canonical(port.substr(kind.size()), error);
  return error ? port : kind + real.string();
}

std::unique_ptr<Transport> open_port(const std::string& port, Sharing sharing) {
  if (port.starts_with(kUnix)) return open_unix_socket(port.substr(kUnix.size()));
  if (port.starts_with(kTcp)) return open_tcp_socket(port.substr(kTcp.size()));
  if (is_pty(port)) return open_pty(port, sharing);
  return open_serial(port, sharing);
}

}  // namespace robosync::tool
