// Messages to the host that nobody asked for (trace events, log lines), waiting for the line.
//
// Written by any thread, read by the link thread. A bounded ring: when the host does not read, what
// is new is dropped and counted, and nobody ever waits. Nothing is kept while no host listens.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "link/messages.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/event_sink.hpp"

namespace robosync::update {

class TraceRing final : public EventSink {
public:
  explicit TraceRing(kernel::Kernel& kernel) : kernel_(kernel) {}

  // From now on `news` of `reader` are signalled when a message comes into the empty ring: who has
  // taken all of them waits for that. Before Kernel::run().
  void wake(kernel::Thread& reader, kernel::Events news) {
    reader_ = &reader;
    news_ = news;
  }

  // Starts or stops keeping messages. Stopping forgets what waits.  [any]
  void listen(bool on);
  bool listening() const { return listening_; }

  void emit(const link::Event& event) override;  // [any]
  // One line of text without its end; cut at kMaxPayload.  [any]
  void log(std::string_view line);

  // The oldest message: its type and, in `payload`, its bytes. Returns their number; 0 when none
  // waits.  [link thread]
  std::size_t take(link::MessageType& type, std::span<std::byte, link::kMaxPayload> payload);

  std::uint32_t lost() const { return lost_; }  // since start-up

private:
  static constexpr std::size_t kCapacity = 1024;  // about 40 events
  static constexpr std::size_t kHead = 2;         // type, length

  // A message of two pieces: nobody has to put it together first, on a short stack.
  void put(link::MessageType type, std::span<const std::byte> begin,
           std::span<const std::byte> end);
  void copy_in(std::span<const std::byte> bytes);
  void copy_out(std::span<std::byte> bytes);

  kernel::Kernel& kernel_;
  std::array<std::byte, kCapacity> ring_{};
  // Bytes ever put and taken; they wrap around together with the ring.
  std::size_t put_ = 0;
  std::size_t taken_ = 0;
  std::uint32_t lost_ = 0;
  bool listening_ = false;
  kernel::Thread* reader_ = nullptr;
  kernel::Events news_ = 0;
  static_assert((kCapacity & (kCapacity - 1)) == 0, "positions are taken modulo the capacity");
};

}  // namespace robosync::update
