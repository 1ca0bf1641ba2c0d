// Unsolicited messages to the host (trace events, log lines), waiting for the line.
//
// Any thread writes, the link thread reads. The ring is bounded: when the host does not read, new messages
// are dropped and counted, and no writer ever waits. Nothing is stored while no host listens.
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
  explicit TraceRing(kernel::Kernel& kernel) : EventSink(false), kernel_(kernel) {}

  // From now on `reader` gets the events `news` when a message enters the empty ring. The reader waits for
  // them once it has taken every message. Call it before Kernel::run().
  void wake(kernel::Thread& reader, kernel::Events news) {
    reader_ = &reader;
    news_ = news;
  }

  // Starts or stops storing messages. Stopping drops those in the ring.  [any]
  void listen(bool on);

  void emit(const link::Event& event) override;  // [any]
  // One line of text without its line end; cut at kMaxPayload.  [any]
  void log(std::string_view line);

  // Takes the oldest message: its type and, in `payload`, its bytes. Returns their number; 0 if the ring is
  // empty.  [link thread]
  std::size_t take(link::MessageType& type, std::span<std::byte, link::kMaxPayload> payload);

  std::uint32_t lost() const { return lost_; }  // since start-up

private:
  using Word = std::uint32_t;
  static constexpr std::size_t kWords = 256;    // about 40 events
  static constexpr std::size_t kEventHead = 5;  // words before its values
  static_assert((kWords & (kWords - 1)) == 0, "positions are taken modulo the capacity");

  bool make_room(std::size_t words);
  void put(Word word) { ring_[put_++ % kWords] = word; }
  Word take() { return ring_[taken_++ % kWords]; }
  void take_event(Word head, link::Event& event);

  kernel::Kernel& kernel_;
  // Messages in words: an event's numbers, which are encoded as bytes only when the line is ready for
  // them, or a line's bytes. The first word says which, and how many.
  std::array<Word, kWords> ring_{};
  // Words ever put and taken; they wrap around together with the ring.
  std::size_t put_ = 0;
  std::size_t taken_ = 0;
  std::uint32_t lost_ = 0;
  kernel::Thread* reader_ = nullptr;
  kernel::Events news_ = 0;
};

}  // namespace robosync::update
