// See host_name.hpp. May assume Linux. The last five bytes of the name are a number of 40 bits: 18 of a hash of the computer, and
// 22 of the process, which is the most that Linux gives. A host that gives only its name has zeros there, or further letters of a
// long name: hardly ever this computer's hash.
#include "rsc/device/host_name.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <system_error>

#include <unistd.h>

#include "vm/image.hpp"

namespace robosync::tool {
namespace {

constexpr std::size_t kTag = 5;
constexpr std::size_t kText = link::kNameLength - kTag;
constexpr unsigned kProcessBits = 22, kMachineBits = 18;

// This start of this computer, and the space in which its processes are numbered: those of another container are not seen
// here. 0: unknown.
std::uint64_t machine() {
  std::string boot;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
  std::error_code error;
  const auto space = std::filesystem::read_symlink("/proc/self/ns/pid", error);
  if (boot.empty() || error) return 0;
  const std::string both = boot + space.string();
  return vm::crc32(std::as_bytes(std::span(both))) >> (32 - kMachineBits);
}

std::uint64_t tag_of(const link::Name& host) {
  std::uint64_t tag = 0;
  for (const char byte : std::span(host).last<kTag>())
    tag = tag << 8 | static_cast<unsigned char>(byte);
  return tag;
}

}  // namespace

link::Name host_name(pid_t process) {
  link::Name host{};
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0 || name.front() == '\0') name.front() = '?';
  const auto end = std::ranges::find(name, '\0');
  std::copy_n(name.begin(), std::min<std::ptrdiff_t>(end - name.begin(), kText), host.begin());
  const auto number = static_cast<std::uint64_t>(process);
  std::uint64_t tag = number >> kProcessBits == 0 ? machine() << kProcessBits | number : 0;
  for (std::size_t i = host.size(); i-- > kText; tag >>= 8)
    host[i] = static_cast<char>(static_cast<unsigned char>(tag & 0xFF));
  return host;
}

std::string host_text(const link::Name& host) {
  const auto text = std::span(host).first<kText>();
  return {text.begin(), std::ranges::find(text, '\0')};
}

bool is_gone(const link::Name& host) {
  const std::uint64_t tag = tag_of(host);
  const auto process = static_cast<pid_t>(tag & ((1U << kProcessBits) - 1));
  const std::uint64_t here = machine();
  if (here == 0 || process == 0 || tag >> kProcessBits != here) return false;
  return process == getpid() || (kill(process, 0) != 0 && errno == ESRCH);
}

}  // namespace robosync::tool
