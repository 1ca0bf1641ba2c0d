// See order_gate.hpp. Cheap checks come before the signature's: verifying one takes millions of instructions.
#include "runtime-m4/update/order_gate.hpp"

#include <algorithm>
#include <cstring>

#include "link/order.hpp"
#include "link/wire.hpp"
#include "runtime-m4/update/signatures.hpp"

namespace robosync::update {

using link::Denial;
using link::MessageType;
using link::Pairing;

void OrderGate::open(bool switched_on) {
  switched_on_ = switched_on;
  store_.open();
  busy_ = true;
  while (busy_)
    if (!work()) kernel_.sleep_until(due_);
  if (paired()) write(true, store_.record().owner);
}

bool OrderGate::work() {
  due_ = kernel::kForever;
  switch (store_.work()) {
    case Work::some:
      return true;
    case Work::waits:
    case Work::
        rests:  // only flash that stalls; no such board has owners yet. It would have to wait for a gap, as the keeper does
      due_ = kernel_.now() + kernel::kTick;
      return false;
    case Work::ended:
      written();
      break;
    case Work::none:
      break;
  }
  busy_ = false;
  return true;
}

void OrderGate::write(bool paired, const link::Pair& owner) {
  granted_ = {};
  store_.write(paired, owner);
  busy_ = true;
}

// The record's number differs at each start, and without the seed nobody can predict the next start's boot id.
void OrderGate::written() {
  if (!store_.written()) return;
  std::array<std::byte, sizeof(link::Pair::seed) + sizeof(KeyStore::Record::number)> bytes{};
  const KeyStore::Record& record = store_.record();
  const auto end =
      std::ranges::copy(std::as_bytes(std::span(record.owner.seed)), bytes.begin()).out;
  std::ranges::copy(link::wire_bytes(record.number), end);
  std::copy_n(hash_of(bytes).begin(), boot_.size(), boot_.begin());
  next_ = 1;
}

bool OrderGate::deny(Denial why) {
  denial_ = why;
  return false;
}

bool OrderGate::takes(link::Frame& frame) {
  denial_ = Denial::none;
  if (frame.type != MessageType::signed_order) {
    const bool free = !paired() || !link::is_order(frame.type) || goes_on(frame);
    return free || deny(Denial::unsigned_order);
  }
  link::SignedOrder order{};
  const auto type = [&] { return static_cast<MessageType>(order.type); };
  const bool good = link::read_prefix(frame.payload, order) && link::is_order(type()) &&
                    order.reserved == decltype(order.reserved){};
  if (!good) return deny(Denial::bad_signature);
  const auto payload = frame.payload.subspan(sizeof order);
  if (!verify(order, payload)) return false;
  next_ = order.number + 1;
  granted_.open = false;
  frame.type = type();
  frame.payload = payload;
  return frame.type != MessageType::begin || grant(frame);
}

bool OrderGate::verify(const link::SignedOrder& order, std::span<const std::byte> payload) {
  if (!paired()) return deny(Denial::no_owner);
  if (!store_.written()) {
    if (!busy_) write(true, store_.record().owner);
    return deny(Denial::starting);
  }
  if (order.boot != boot_ || order.number < next_ || order.number - next_ > kMostAhead)
    return deny(Denial::stale);
  if (kernel_.now() < looks_again_) return deny(Denial::too_soon);
  std::array<std::byte, link::kMaxOrderText> text{};
  if (is_signed(link::order_text(order, payload, text), order.signature,
                store_.record().owner.key)) {
    bad_ = 0;
    return true;
  }
  looks_again_ = kernel_.now() + std::min(kPause << std::min(bad_, 16U), kMostPause);
  ++bad_;
  return deny(Denial::bad_signature);
}

bool OrderGate::grant(link::Frame& begin) {
  link::Grant what{};
  if (begin.payload.size() < sizeof what) return deny(Denial::bad_signature);
  const std::size_t bytes = begin.payload.size() - sizeof what;
  (void)link::read_payload(begin.payload.subspan(bytes), what);
  begin.payload = begin.payload.first(bytes);
  granted_ = {.open = true, .until = kernel_.now() + kGrant, .what = what};
  granted_.begin_bytes = std::min(bytes, granted_.begin.size());
  std::copy_n(begin.payload.begin(), granted_.begin_bytes, granted_.begin.begin());
  return true;
}

// A host repeats `begin` when the line has lost something.
bool OrderGate::goes_on(const link::Frame& begin) const {
  const auto granted = std::span(granted_.begin).first(granted_.begin_bytes);
  return begin.type == MessageType::begin && granted_.open && kernel_.now() < granted_.until &&
         std::ranges::equal(begin.payload, granted);
}

bool OrderGate::grants(std::span<const std::byte> image, const link::Activate& how) {
  if (!paired()) return true;
  const bool open = granted_.open && kernel_.now() < granted_.until;
  granted_.open = false;
  const link::Grant& what = granted_.what;
  return open && how.fresh == what.fresh && how.goes_back == what.goes_back &&
         how.trial_ms == what.trial_ms && hash_of(image) == what.image;
}

void OrderGate::pair(const link::Pair& owner) {
  denial_ = Denial::none;
  if (!store_.there()) {
    denial_ = Denial::no_store;
  } else if (busy_) {
    denial_ = Denial::starting;
  } else if (paired()) {
    const bool again = store_.record().owner.key == owner.key;
    if (!again) denial_ = Denial::has_owner;
  } else if (window_ms() == 0) {
    denial_ = Denial::nobody_there;
  } else {
    denial_ = Denial::starting;
    write(true, owner);
  }
}

void OrderGate::unpair() {
  if (!paired()) return;
  denial_ = Denial::starting;
  write(false, {});
}

Pairing OrderGate::pairing() const {
  if (!store_.there()) return Pairing::impossible;
  return paired() ? Pairing::paired : Pairing::unpaired;
}

std::uint32_t OrderGate::window_ms() const {
  const kernel::Time now = kernel_.now();
  if (!switched_on_ || now >= kWindow) return 0;
  return static_cast<std::uint32_t>((kWindow - now) / 1000);
}

void OrderGate::fill(link::Authority& answer) const {
  const kernel::Time now = kernel_.now();
  answer.pairing = pairing();
  answer.denial = denial_;
  answer.window_ms = window_ms();
  if (now < looks_again_)
    answer.wait_ms = static_cast<std::uint32_t>((looks_again_ - now) / 1000 + 1);
  if (!paired()) return;
  answer.key = store_.record().owner.key;
  answer.boot = boot_;
  answer.next = next_;
}

}  // namespace robosync::update
