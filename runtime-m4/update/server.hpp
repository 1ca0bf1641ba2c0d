// The board's end of the link: answers the host, receives programs, has the runtime activate them, and
// sends trace events, log lines and fault records. It is one thread of category `system`, the lowest
// rank, so the running program and the safety thread always come first.
//
// A program is received into unused memory. The runtime switches to it only when it is complete,
// verified and accepted; until then, and if anything fails, the old program keeps running.
// The server never waits for the line: a reply stays until it is written, and further requests stay
// in the UART's receive buffer meanwhile; events that find the ring full are dropped and counted.
// Protocol: docs/link.md.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "link/frame.hpp"
#include "link/receiver.hpp"
#include "runtime-m4/boards/board.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/runtime.hpp"
#include "runtime-m4/update/keeper.hpp"
#include "runtime-m4/update/line_writer.hpp"
#include "runtime-m4/update/open_gate.hpp"
#include "runtime-m4/update/order_gate.hpp"
#include "runtime-m4/update/session.hpp"
#include "runtime-m4/update/trace_ring.hpp"
#include "vm/identity.hpp"

namespace robosync::update {

#ifdef ROBOSYNC_AUTHENTICATION
inline constexpr bool kAuthentication = true;
#else
inline constexpr bool kAuthentication = false;
#endif

class Server {
public:
  // `ring` is the sink that `runtime` was made with.
  Server(kernel::Kernel& kernel, boards::Board& board, Runtime& runtime, TraceRing& ring)
      : kernel_(kernel),
        board_(board),
        runtime_(runtime),
        ring_(ring),
        writer_(board),
        gate_(kernel, board.store()),
        keeper_(kernel, runtime, receiver_, board.store()) {}

  // Creates the link thread and starts the line. Call it once, before Kernel::run(). False if the kernel has
  // no room.
  [[nodiscard]] bool start();

  // A thread was stopped. The first faults are kept until a host listens; later ones are only counted
  // (Runtime::fill_status()), since the first is the cause.  [any]
  void report(const link::Fault& fault);

private:
  // The link thread waits for the line, and for something to report. Nothing else wakes it.
  static constexpr kernel::Events kLine = 1;
  static constexpr kernel::Events kNews = 2;
  static constexpr std::size_t kKeptFaults = 2;
  // Verifying and loading programs needs the most, or verifying signatures, where the firmware does that.
  static constexpr std::size_t kStack = kAuthentication ? 5696 : 1952;

  void run();
  bool work();  // does one thing that is due; false if there is none, or the line is full
  bool read_line();
  bool send_unasked();
  bool send_next_thread();
  bool send_fault();

  void handle(const link::Frame& received);
  void answer(const link::Frame& frame);
  void inform(const link::Frame& frame);  // answers what changes nothing
  void busy(std::uint8_t sequence);
  void authority(std::uint8_t sequence);
  void pair(const link::Frame& frame);
  void hello(const link::Frame& frame);
  void begin(const link::Frame& frame);
  void data(const link::Frame& frame);
  void activate(const link::Frame& frame);
  void feed(const link::Frame& frame);
  void stop(std::uint8_t sequence);
  void resume(const link::Frame& frame);
  bool resume_unless_stopped();
  void status(std::uint8_t sequence);
  void last_fault(std::uint8_t sequence);
  void devices(std::uint8_t sequence);
  void state(const link::Frame& frame);
  void probe(const link::Frame& frame);
  void list_threads(std::uint8_t sequence);
  void read_image(const link::Frame& frame);
  void clear(const link::Frame& frame);
  void trace_on(const link::Frame& frame);
  void kept(std::uint8_t sequence);
  void roll_back(const link::Frame& frame);

  bool in_transfer() const;
  void received(std::uint8_t sequence, link::TransferStatus answer);
  link::ActivateResult activate_received();
  std::span<const std::byte> running_image() const;
  void send(link::MessageType type, std::uint8_t sequence, std::span<const std::byte> payload) {
    writer_.send(type, sequence, payload);
  }

  kernel::Kernel& kernel_;
  boards::Board& board_;
  Runtime& runtime_;
  TraceRing& ring_;

  link::FrameDecoder decoder_;
  LineWriter writer_;
  std::array<std::byte, 32> input_{};  // read from the line, not yet decoded
  std::uint8_t input_begin_ = 0;
  std::uint8_t input_end_ = 0;
  std::atomic<std::uint32_t> stops_seen_ = 0;  // by the line's interrupt
  std::uint32_t stops_read_ = 0;               // of stops_seen_, by the link thread
  std::uint32_t bad_requests_ = 0;             // good frames with a payload of the wrong length
  std::uint8_t unasked_sequence_ = 0;          // of events, logs, faults

  LineSession session_;
  link::Receiver receiver_;
  vm::Identity identity_;               // of the received image
  link::ActivateResult last_result_{};  // repeated when the host asks again
  link::ProgramHash last_activated_{};  // the program that last_result_ is about
  bool have_result_ = false;
  std::conditional_t<kAuthentication, OrderGate, OpenGate> gate_;
  Keeper keeper_;

  bool listing_threads_ = false;
  std::uint8_t next_thread_ = 0;
  std::uint8_t threads_sequence_ = 0;

  std::array<link::Fault, kKeptFaults> faults_{};
  std::uint8_t fault_count_ = 0;
  std::uint8_t faults_sent_ = 0;

  kernel::Thread thread_;
  alignas(port::kStackAlignment) std::array<std::byte, kStack> stack_{};
};

}  // namespace robosync::update
