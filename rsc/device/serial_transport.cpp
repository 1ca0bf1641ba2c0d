// May assume libserialport. Promises 115,200 baud 8N1 without flow control, and messages that name
// the port and what to try.
#include "rsc/device/serial_transport.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <libserialport.h>
#include <sys/ioctl.h>

#include "rsc/device/line_lock.hpp"
#include "rsc/failure.hpp"

namespace robosync::tool {
namespace {

struct FreePort {
  void operator()(sp_port* port) const { sp_free_port(port); }
};
using Port = std::unique_ptr<sp_port, FreePort>;

std::string last_error() {
  const std::unique_ptr<char, decltype(&sp_free_error_message)> text(sp_last_error_message(),
                                                                     sp_free_error_message);
  return text ? text.get() : "unknown error";
}

void expect(sp_return result, const std::string& port) {
  if (result == SP_OK) return;
  const std::string why = result == SP_ERR_FAIL  ? last_error()
                          : result == SP_ERR_ARG ? "this is not a serial port"
                                                 : "this serial port cannot do that";
  throw Failure(Exit::outside, fmt::format("{}: {}", port, why));
}

class SerialTransport final : public Transport {
public:
  SerialTransport(std::string name, Port port, std::optional<LineLock> lock)
      : name_(std::move(name)), port_(std::move(port)), lock_(lock) {}
  ~SerialTransport() override { sp_close(port_.get()); }

  sp_return configure() {
    for (const sp_return result :
         {sp_set_baudrate(port_.get(), kBaudRate), sp_set_bits(port_.get(), 8),
          sp_set_parity(port_.get(), SP_PARITY_NONE), sp_set_stopbits(port_.get(), 1),
          sp_set_flowcontrol(port_.get(), SP_FLOWCONTROL_NONE)}) {
      if (result != SP_OK) return result;
    }
    return SP_OK;
  }

  std::size_t read(std::span<std::byte> bytes, std::chrono::milliseconds timeout) override {
    const auto limit = static_cast<unsigned>(std::max<std::int64_t>(timeout.count(), 1));
    const sp_return count = sp_blocking_read_next(port_.get(), bytes.data(), bytes.size(), limit);
    if (count < 0) expect(count, name_);
    return static_cast<std::size_t>(count);
  }

  void write(std::span<const std::byte> bytes) override {
    const sp_return count =
        sp_blocking_write(port_.get(), bytes.data(), bytes.size(), kWriteTimeoutMs);
    if (count < 0) expect(count, name_);
    if (static_cast<std::size_t>(count) < bytes.size()) {
      throw Failure(Exit::outside, name_ + ": the line takes no bytes");
    }
  }

  std::string name() const override { return name_; }
  bool wanted() const override { return lock_ && lock_->wanted(); }
  bool lend(const std::function<bool()>& waiting) override {
    return !lock_ || lock_->lend(waiting);
  }

private:
  std::string name_;
  Port port_;
  std::optional<LineLock> lock_;
};

Port find(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw Failure(
        Exit::outside,
        fmt::format("{}: there is no such port; `rsc ports` lists the serial ports", path));
  }
  sp_port* found = nullptr;
  expect(sp_get_port_by_name(path.c_str(), &found), path);
  return Port(found);
}

// The lock keeps other rsc processes away. Newer versions of libserialport open the port exclusively, which would also
// lock out `rsc stop`.
std::optional<LineLock> claim(const sp_port* port, const std::string& path, Sharing sharing) {
  int file = -1;
  if (sp_get_port_handle(port, &file) != SP_OK) return std::nullopt;
  ioctl(file, TIOCNXCL);
  return LineLock(file, path, sharing);
}

}  // namespace

std::unique_ptr<Transport> open_serial(const std::string& path, Sharing sharing) {
  Port port = find(path);
  expect(sp_open(port.get(), SP_MODE_READ_WRITE), path);
  const std::optional<LineLock> lock = claim(port.get(), path, sharing);
  auto transport = std::make_unique<SerialTransport>(path, std::move(port), lock);
  expect(transport->configure(), path);
  return transport;
}

std::vector<SerialPort> list_serial_ports() {
  sp_port** list = nullptr;
  if (sp_list_ports(&list) != SP_OK) throw Failure(Exit::outside, "ports: " + last_error());
  const std::unique_ptr<sp_port*, decltype(&sp_free_port_list)> ports(list, sp_free_port_list);
  std::vector<SerialPort> result;
  for (sp_port** at = list; *at != nullptr; ++at) {
    const char* const description = sp_get_port_description(*at);
    int vendor = 0, product = 0;
    const bool on_usb = sp_get_port_usb_vid_pid(*at, &vendor, &product) == SP_OK;
    result.push_back({sp_get_port_name(*at), description != nullptr ? description : "",
                      on_usb ? fmt::format("{:04x}:{:04x}", vendor, product) : ""});
  }
  return result;
}

}  // namespace robosync::tool
