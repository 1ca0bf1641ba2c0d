// See bus_requests.hpp. This is on the way of each sample, so it is compiled for speed.
#include "runtime-m4/boards/common/bus_requests.hpp"

#include <algorithm>

namespace robosync::boards {
namespace {

using Word = BusRequest::Word;

[[gnu::noinline]] bool are_same(const std::byte* a, const std::byte* b, std::size_t bytes) {
  for (; bytes >= sizeof(Word); bytes -= sizeof(Word), a += sizeof(Word), b += sizeof(Word)) {
    Word in_a = 0;
    Word in_b = 0;
    std::memcpy(&in_a, a, sizeof in_a);
    std::memcpy(&in_b, b, sizeof in_b);
    if (in_a != in_b) return false;
  }
  return std::equal(a, a + bytes, b);
}

[[gnu::always_inline]] inline bool begins_as(const BusRequest& request, Word shape, Word head) {
  Word known = 0;
  std::memcpy(&known, request.bytes.data(), sizeof known);
  return std::bit_cast<Word>(request.shape) == shape && known == head;
}

bool is(const BusRequest& request, Word shape, Word head, const std::byte* out) {
  const Word more = BusRequest::written_of(shape) - 1;
  return begins_as(request, shape, head) &&
         (more == 0 || are_same(out + 1, request.bytes.data() + sizeof head, more));
}

}  // namespace

// Most requests write one byte, and are the one that is expected.
BusRequest* BusRequests::find(Word shape, Word head, const std::byte* out) {
  const std::uint8_t guess = guess_;
  BusRequest& request = requests_[guess];
  if (!begins_as(request, shape, head) || BusRequest::written_of(shape) != 1) [[unlikely]]
    return search(shape, head, out);
  latest_ = guess;
  guess_ = request.follower;
  return &request;
}

BusRequest* BusRequests::search(Word shape, Word head, const std::byte* out) {
  BusRequest* found = &requests_[guess_];
  if (!is(*found, shape, head, out)) {
    const auto all = used();
    const auto it = std::ranges::find_if(
        all, [&](const BusRequest& request) { return is(request, shape, head, out); });
    if (it == all.end()) return nullptr;
    found = &*it;
  }
  follow(*found);
  return found;
}

void BusRequests::follow(BusRequest& request) {
  const auto number = static_cast<std::uint8_t>(&request - requests_.data());
  requests_[latest_].follower = number;
  latest_ = number;
  guess_ = request.follower;
}

// The one that has not been asked for the longest time gives up its place.
BusRequest* BusRequests::place(Word shape, Word head, const std::byte* out) {
  BusRequest* found = nullptr;
  for (BusRequest& request : used()) {
    if (request.is_free()) {
      found = &request;
      break;
    }
    if (!request.under_way() && (found == nullptr || request.turn < found->turn)) found = &request;
  }
  if (used_ < requests_.size() && (found == nullptr || !found->is_free()))
    found = &requests_[used_++];
  if (found == nullptr) return nullptr;
  found->shape = std::bit_cast<BusRequest::Shape>(shape);
  std::memcpy(found->bytes.data(), &head, sizeof head);
  if (const Word more = BusRequest::written_of(shape) - 1; more != 0)
    copy_words(out + 1, found->bytes.data() + sizeof head, more);
  follow(*found);
  return found;
}

BusRequest& BusRequests::first_waiting() {
  BusRequest* first = requests_.data();
  for (BusRequest& request : used())
    if (request.state == State::waits &&
        (first->state != State::waits || request.turn < first->turn))
      first = &request;
  return *first;
}

void BusRequests::fail_waiting() {
  for (BusRequest& request : used())
    if (request.state == State::waits) request.state = State::failed;
}

}  // namespace robosync::boards
