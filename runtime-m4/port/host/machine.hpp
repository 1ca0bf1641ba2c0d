// The host as a machine for the kernel: threads are fibers (ucontext), time is virtual.
//
// A switch happens where the firmware would take PendSV: at the end of the outermost Lock, so
// signalling a thread of higher rank runs it immediately. Nothing preempts between kernel calls. Time
// stands still while a thread runs, and jumps to the next deadline when all threads are blocked. So a
// run depends on its inputs only. One process may have several machines; each belongs to the OS thread
// that runs it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <ucontext.h>

namespace robosync::kernel {
class Kernel;
class Thread;
struct ThreadSpec;
}  // namespace robosync::kernel

namespace robosync::port {

inline constexpr bool kTimeFlows = false;
// Of Machine::clock(), which stands still.
inline constexpr std::uint32_t kCyclesPerCount = 1;
inline constexpr std::size_t kStackAlignment = 8;
inline constexpr std::size_t kMinStack = 0;     // a fiber has its own host-sized stack
inline constexpr std::size_t kArenaScale = 16;  // for larger pointers and the fibers' state
inline constexpr std::size_t kUnprivilegedStackAlignment = 64;  // as on the board
inline constexpr std::size_t kMaxUnprivilegedStack = 576;

// The host closes no memory.
struct Areas {
  std::span<const std::byte> readable;
  std::span<std::byte> writable;
};

// The memory of a fiber's stack. A stack that is given back is kept for the next fiber, since a fresh one costs a page fault per page.
struct ReturnStack {
  void operator()(std::byte* stack) const noexcept;
};
using FiberStack = std::unique_ptr<std::byte[], ReturnStack>;

struct Context {
  union {
    ucontext_t begin{};              // until it first runs
    std::array<void*, 5> registers;  // saved when it is switched out
  };
  bool has_run = false;
  FiberStack stack;
  void (*entry)(void*) = nullptr;
  void* argument = nullptr;
  // For AddressSanitizer, which must know which stack is in use.
  void* sanitizer_stack = nullptr;
  const void* stack_bottom = nullptr;
  std::size_t stack_bytes = 0;
};

struct RunClock {};

// An ordinary call.
class Sandbox {
public:
  using Function = std::int32_t (*)(void*, const void*, void*);

  void set(std::span<std::byte> /*window*/, std::byte* /*stack_top*/, Function function) {
    function_ = function;
  }
  std::int32_t call(void* first, const void* second, void* third) const {
    return function_(first, second, third);
  }

private:
  Function function_ = nullptr;
};

class CallFrame {
public:
  CallFrame(std::uint32_t number, std::uint32_t argument) : number_(number), argument_(argument) {}
  std::uint32_t number() const { return number_; }
  std::uint32_t argument() const { return argument_; }
  void give(std::uint32_t result) { result_ = result; }
  void repeat() { repeats_ = true; }
  bool repeats() const { return repeats_; }
  std::uint32_t result() const { return result_; }

private:
  std::uint32_t number_;
  std::uint32_t argument_;
  std::uint32_t result_ = 0;
  bool repeats_ = false;
};

enum class Mode : std::uint8_t { init, thread, handler };  // there are no handlers
enum class Held : std::uint8_t { none, switch_lock, lock };
[[noreturn]] void panic(const char* service, const char* why);

class Machine {
public:
  explicit Machine(kernel::Kernel& kernel) : kernel_(kernel) {}
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  void prepare(Context& context, const kernel::ThreadSpec& spec, std::span<std::byte> stack);
  Mode mode() const { return on_fiber_ ? Mode::thread : Mode::init; }
  Held held() const {
    if (interrupt_locks_ != 0) return Held::lock;
    return lock_depth_ != 0 ? Held::switch_lock : Held::none;
  }
  static bool may_call() { return true; }
  static std::uint32_t clock() { return 0; }
  static std::uint32_t run_time(const Context&, const RunClock&, bool) { return 0; }
  static void refuse_call() {}
  void request_switch() { switch_requested_ = true; }
  void run();
  static std::span<std::byte> usable(const kernel::ThreadSpec& spec);
  static bool can_run(const kernel::ThreadSpec&) { return true; }
  static void grant(const Areas&) {}
  static std::span<std::byte> prepare_idle(Context&) { return {}; }  // it is the caller

  // Runs threads until all are blocked and the next deadline is after `until` (kernel::Time). Then
  // now() is `until`, rounded down to a tick. Call it again to continue; if `until` is in the past, it
  // runs only the ready threads. With kForever: until no thread has a deadline. Not from a thread.
  void run_until(std::uint64_t until);
  // Makes run_until() return as soon as all threads are blocked, without advancing the time.
  // [from a thread; between two calls of run_until() it has no effect]
  void stop() { stop_requested_ = true; }

private:
  friend class SwitchLock;
  friend class Lock;

  static void fiber_main();
  void enter_fiber();
  void switch_now();

  kernel::Kernel& kernel_;
  Context* from_ = nullptr;  // what switched to the running fiber
  unsigned lock_depth_ = 0;  // of both kinds of lock
  unsigned interrupt_locks_ = 0;
  bool switch_requested_ = false;
  bool on_fiber_ = false;
  bool stop_requested_ = false;
};

inline std::uint32_t fetch_and_clear(std::uint32_t& word, std::uint32_t mask) {
  const std::uint32_t before = word;
  word &= ~mask;
  return before;
}

class SwitchLock {
public:
  explicit SwitchLock(const Machine& machine) : machine_(const_cast<Machine&>(machine)) {
    ++machine_.lock_depth_;
  }
  ~SwitchLock() {
    if (--machine_.lock_depth_ == 0 && machine_.switch_requested_ && machine_.on_fiber_) {
      machine_.switch_now();
    }
  }
  SwitchLock(const SwitchLock&) = delete;
  SwitchLock& operator=(const SwitchLock&) = delete;

protected:
  Machine& machine_;
};

// There are no interrupts: Lock differs from SwitchLock for the assertions only.
class Lock : private SwitchLock {
public:
  explicit Lock(const Machine& machine) : SwitchLock(machine) { ++machine_.interrupt_locks_; }
  ~Lock() { --machine_.interrupt_locks_; }
};

// Calls the kernel directly: the host has no privileges.
std::uint32_t call(kernel::Kernel& kernel, std::uint32_t number, std::uint32_t argument);
void stop_overrun(kernel::Kernel& kernel, kernel::Thread& thread);
using OnlyLock = Lock;

}  // namespace robosync::port
