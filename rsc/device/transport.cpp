// Which kind of line a port name means.
#include "rsc/device/transport.hpp"

#include <filesystem>
#include <system_error>

#include "rsc/device/file_transport.hpp"
#include "rsc/device/serial_transport.hpp"

namespace robosync::tool {
namespace {

// A link to a pty counts as one.
bool is_pty(const std::string& port) {
  std::error_code error;
  const auto real = std::filesystem::canonical(port, error);
  return !error && real.string().starts_with("/dev/pts/");
}

}  // namespace

std::unique_ptr<Transport> open_port(const std::string& port, Sharing sharing) {
  if (port.starts_with("unix:")) return open_unix_socket(port.substr(5));
  if (port.starts_with("tcp:")) return open_tcp_socket(port.substr(4));
  if (is_pty(port)) return open_pty(port, sharing);
  return open_serial(port, sharing);
}

}  // namespace robosync::tool
