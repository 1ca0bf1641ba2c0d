// See mailbox.hpp. Locks the kernel for one mailbox at a time.
#include "runtime-m4/layers/mailbox.hpp"

#include <algorithm>

namespace robosync::layers {
namespace {

// They differ, and by at least `least`, which is not negative.
bool differs(vm::Value a, vm::Value b, vm::Value least) {
  if (a == b) return false;
  const auto up = static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b);
  const std::uint32_t difference = a < b ? -up : up;
  return difference >= static_cast<std::uint32_t>(least);
}

}  // namespace

void Mailboxes::start(Memory& memory) {
  boxes_ = memory.take<policy::Part::mailboxes, Mailbox>();
  announced_ = 0;
  forgotten_ = 0;
  set_next_expiry(kernel::kForever);
  expiry_of_news_ = kernel::kForever;
}

ChannelMask Mailboxes::post(const Reading& reading, const vm::Channel& channel) {
  const auto lock = kernel_.lock();
  const unsigned number = reading.channel();
  Mailbox& box = boxes_[number];
  box.sample_at(reading.time());
  const bool was_known = box.is_known();
  if (was_known && !differs(reading.value(), box.value, channel.change)) return 0;
  box.value = reading.value();
  if (!was_known) note_known(number, channel);
  return bit<ChannelMask>(number);
}

[[gnu::always_inline]] inline void Mailboxes::note_known(unsigned channel,
                                                         const vm::Channel& wiring) {
  const kernel::Time time = expiry_of(channel, wiring);
  if (time < next_expiry_) set_next_expiry(time);
  expiry_of_news_ = std::min(expiry_of_news_, time);
}

void Mailboxes::forget(unsigned channel) {
  const auto lock = kernel_.lock();
  forgotten_ |= bit<ChannelMask>(channel);
  set_next_expiry(0);
  expiry_of_news_ = 0;
}

// Ticks wrap, so kForever is taken as half of their range from now: after that nothing is certain to be fresh.
void Mailboxes::set_next_expiry(kernel::Time time) {
  constexpr auto kTick = static_cast<std::uint32_t>(kernel::kTick);
  const auto lock = kernel_.lock();
  const kernel::Time now = kernel_.time();
  const kernel::Duration left = time > now ? time - now : 0;
  const auto ticks =
      static_cast<std::uint32_t>(std::min<kernel::Duration>(left, INT32_MAX)) / kTick;
  next_expiry_ = time;
  expiry_tick_ = kernel_.tick() + (time == kernel::kForever ? INT32_MAX : ticks);
}

// The lock covers one channel at a time. Other threads may post and forget in between, and the safety thread may look:
// until all channels are done, nothing counts as fresh.
ChannelMask Mailboxes::expire_old(std::span<const vm::Channel> channels, ChannelMask fresh,
                                  kernel::Time now) {
  ChannelMask expired = 0;
  kernel::Time next = kernel::kForever;
  {
    const auto lock = kernel_.lock();
    set_next_expiry(0);
    expiry_of_news_ = kernel::kForever;
  }
  for (unsigned c = 0; c < channels.size(); ++c) {
    const auto lock = kernel_.lock();
    if (!has(fresh, c) && expire(c, channels[c], now)) expired |= bit<ChannelMask>(c);
    next = std::min(next, expires_at(c, channels[c]));
  }
  const auto lock = kernel_.lock();
  set_next_expiry(std::min(next, expiry_of_news_));
  return expired;
}

bool Mailboxes::expire(unsigned channel, const vm::Channel& wiring, kernel::Time now) {
  const auto lock = kernel_.lock();
  if (now < expires_at(channel, wiring)) return false;
  boxes_[channel].value = vm::kUnknown;
  return true;
}

kernel::Time Mailboxes::expires_at(unsigned channel, const vm::Channel& wiring) const {
  const auto lock = kernel_.lock();
  return boxes_[channel].is_known() ? expiry_of(channel, wiring) : kernel::kForever;
}

}  // namespace robosync::layers
