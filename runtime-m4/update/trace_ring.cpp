// Assumes one reader. Guarantees that a message is in the ring completely or not at all, and that the
// kernel is locked only while its words are copied.
#include "runtime-m4/update/trace_ring.hpp"

#include <algorithm>
#include <cstring>

namespace robosync::update {
namespace {

// The first word of a message: its type, and how many values or bytes it has. For an event also
// its subject.
constexpr std::uint32_t head(link::MessageType type, std::size_t count, std::uint16_t subject = 0) {
  return static_cast<std::uint32_t>(type) | static_cast<std::uint32_t>(count) << 8 |
         std::uint32_t{subject} << 16;
}
constexpr std::size_t count_of(std::uint32_t head) {
  return head >> 8 & 0xFF;
}

// Calls put() with each word of an event, including its first `values` values.
template <class Put>
[[gnu::always_inline]] inline void each_word(const link::Event& event, std::size_t values,
                                             Put put) {
  put(head(link::MessageType::event, values, event.subject));
  put(static_cast<std::uint32_t>(event.kind) | std::uint32_t{event.object} << 16);
  put(event.step);
  put(static_cast<std::uint32_t>(event.time_us));
  put(static_cast<std::uint32_t>(event.time_us >> 32));
  for (std::size_t v = 0; v < values; ++v)
    put(static_cast<std::uint32_t>(event.values[v]));
}

}  // namespace

void TraceRing::listen(bool on) {
  const auto lock = kernel_.lock();
  if (!on) taken_ = put_;
  set_listening(on);
}

// Call it with the kernel locked. True: the caller puts a message of this many words now. Otherwise it is lost.
bool TraceRing::make_room(std::size_t words) {
  if (!listening()) return false;
  if (words > kWords - (put_ - taken_)) {
    ++lost_;
    return false;
  }
  if (put_ == taken_ && reader_ != nullptr) kernel_.signal(*reader_, news_);
  return true;
}

void TraceRing::emit(const link::Event& event) {
  const std::size_t values = std::min<std::size_t>(event.value_count, link::kMaxEventValues);
  const auto lock = kernel_.lock();
  if (!make_room(kEventHead + values)) return;
  const std::size_t at = put_ % kWords;
  if (at + kEventHead + values > kWords) [[unlikely]]
    return each_word(event, values, [this](Word word) { put(word); });
  Word* end = &ring_[at];
  each_word(
      event, values, [&end](Word word) __attribute__((always_inline)) { *end++ = word; });
  put_ += kEventHead + values;
}

void TraceRing::log(std::string_view line) {
  if (line.empty()) return;
  const std::string_view cut = line.substr(0, link::kMaxPayload);
  const auto lock = kernel_.lock();
  if (!make_room(1 + (cut.size() + sizeof(Word) - 1) / sizeof(Word))) return;
  put(head(link::MessageType::log, cut.size()));
  for (std::size_t at = 0; at < cut.size(); at += sizeof(Word)) {
    Word word = 0;
    std::memcpy(&word, cut.data() + at, std::min(sizeof word, cut.size() - at));
    put(word);
  }
}

void TraceRing::take_event(Word head, link::Event& event) {
  const Word kind = take();
  event.kind = static_cast<link::EventKind>(kind & 0xFF);
  event.object = static_cast<std::uint16_t>(kind >> 16);
  event.subject = static_cast<std::uint16_t>(head >> 16);
  event.step = take();
  const Word low = take();
  event.time_us = std::uint64_t{take()} << 32 | low;
  event.value_count = static_cast<std::uint8_t>(count_of(head));
  for (std::size_t v = 0; v < event.value_count; ++v)
    event.values[v] = static_cast<std::int32_t>(take());
}

std::size_t TraceRing::take(link::MessageType& type,
                            std::span<std::byte, link::kMaxPayload> payload) {
  const auto lock = kernel_.lock();
  if (put_ == taken_) return 0;
  const Word first = take();
  type = static_cast<link::MessageType>(first & 0xFF);
  if (type == link::MessageType::event) {
    link::Event event;
    take_event(first, event);
    return link::encode_event(event, payload.first<link::kMaxEncodedEvent>());
  }
  const std::size_t length = count_of(first);
  for (std::size_t at = 0; at < length; at += sizeof(Word)) {
    const Word word = take();
    std::memcpy(payload.data() + at, &word, std::min(sizeof word, length - at));
  }
  return length;
}

}  // namespace robosync::update
