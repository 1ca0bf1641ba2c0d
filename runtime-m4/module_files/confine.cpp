#include "runtime-m4/module_files/confine.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

namespace robosync::module_files {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kMachine = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kMachine = 0;  // of no call: everything is forbidden
#endif

// What a loader needs, besides openat() for reading. AddressSanitizer needs the last ones.
constexpr long kLoading[] = {
    SYS_read,         SYS_pread64,        SYS_write,        SYS_close,       SYS_fstat,
    SYS_newfstatat,   SYS_mmap,           SYS_munmap,       SYS_mprotect,    SYS_brk,
    SYS_exit,         SYS_exit_group,     SYS_futex,        SYS_prctl,       SYS_seccomp,
    SYS_rt_sigaction, SYS_rt_sigprocmask, SYS_rt_sigreturn, SYS_sigaltstack, SYS_lseek,
    SYS_madvise,      SYS_getpid,         SYS_gettid,       SYS_prlimit64,   SYS_readlinkat,
};
constexpr long kAnswers[] = {SYS_read, SYS_write, SYS_exit, SYS_exit_group, SYS_rt_sigreturn};

constexpr sock_filter kAllow = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
constexpr sock_filter kEnd = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS);

constexpr sock_filter load(std::size_t offset) {
  return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
}
// Skips `skipped` statements if the value is not this one.
constexpr sock_filter is(long value, std::uint8_t skipped) {
  return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(value), 0, skipped);
}

// A program for the kernel. It uses no memory that would be freed once the calls for that are forbidden:
// AddressSanitizer makes such calls.
class Filter {
public:
  void push_back(sock_filter statement) { statements_[count_++] = statement; }
  sock_fprog program() { return {static_cast<unsigned short>(count_), statements_.data()}; }

private:
  std::array<sock_filter, 2 * std::size(kLoading) + 16> statements_;
  std::size_t count_ = 0;
};

// openat() whose flags (the lower half of the third argument: both machines are little-endian) ask for reading only.
// Opening for writing is refused without ending the process: libraries look for files that they may write.
void add_opening(Filter& filter) {
  constexpr std::uint32_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;
  filter.push_back(is(SYS_openat, 4));
  filter.push_back(load(offsetof(seccomp_data, args) + 2 * sizeof(std::uint64_t)));
  filter.push_back(BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, kWriting, 0, 1));
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EACCES));
  filter.push_back(kAllow);
}

bool allow(std::span<const long> calls, bool opening) {
  Filter filter;
  // Another machine's numbers mean other calls.
  filter.push_back(load(offsetof(seccomp_data, arch)));
  filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kMachine, 1, 0));
  filter.push_back(kEnd);
  filter.push_back(load(offsetof(seccomp_data, nr)));
  for (const long call : calls) {
    filter.push_back(is(call, 1));
    filter.push_back(kAllow);
  }
  if (opening) add_opening(filter);
  filter.push_back(kEnd);
  const sock_fprog program = filter.program();
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0) == 0;
}

}  // namespace

const int kForbidden = SIGSYS;

bool allow_loading() {
  return allow(kLoading, true);
}

bool allow_answers() {
  return allow(kAnswers, false);
}

}  // namespace robosync::module_files
