// Lines that are file descriptors: pseudo terminals and sockets.
#pragma once

#include <memory>
#include <string>

#include "rsc/device/transport.hpp"

namespace robosync::tool {

// All throw Failure as open_port() does.
[[nodiscard]] std::unique_ptr<Transport> open_pty(const std::string& path, Sharing sharing);
[[nodiscard]] std::unique_ptr<Transport> open_unix_socket(const std::string& path);
[[nodiscard]] std::unique_ptr<Transport> open_tcp_socket(const std::string& host_and_port);

}  // namespace robosync::tool
