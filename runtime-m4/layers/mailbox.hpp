// Where the sensor layer leaves its readings: one latest-value mailbox for each channel.
//
// Sensor threads write, the step thread reads. Readings that belong together are posted one by one and
// announced together, so the step thread sees all of them or none.
#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/layers/memory.hpp"
#include "runtime-m4/layers/messages.hpp"
#include "vm/image.hpp"

namespace robosync::layers {

class Mailboxes {
public:
  explicit Mailboxes(kernel::Kernel& kernel) : kernel_(kernel) {}

  void start(Memory& memory);  // nothing is known

  // Keeps the reading if it is news: the channel was unknown, or the value differs by at least
  // channel.change. Returns the channel's bit if so, to be announced, else 0. The channel is fresh in either case.
  [[nodiscard, gnu::noinline]] ChannelMask post(const Reading& reading, const vm::Channel& channel);
  // For a caller that holds the kernel's lock.
  void announce(ChannelMask channels) { announced_ |= channels; }
  // Nothing measures the channel any more.
  void forget(unsigned channel);

  // --- for the step thread ---
  bool has_announced() const { return announced_ != 0; }
  [[gnu::always_inline]] ChannelMask take_announced() {
    const auto lock = kernel_.lock();
    return std::exchange(announced_, 0);
  }
  vm::Value value(unsigned channel) const { return boxes_[channel].value; }
  // For the safety thread, which does not wait for expire(). No thread that posts can preempt it, so it needs no lock.
  // All known values are good at this kernel::Kernel::tick(): each value() is its fresh_value(). Also false if that is
  // not certain.
  bool are_fresh(std::uint32_t tick) const {
    return static_cast<std::int32_t>(tick - expiry_tick_) < 0;
  }
  // Unknown as soon as it is too old.
  vm::Value fresh_value(unsigned channel, const vm::Channel& wiring, kernel::Time now) const {
    const Mailbox& box = boxes_[channel];
    if (has(forgotten_, channel)) return vm::kUnknown;
    return wiring.stale_ms == 0 || now < box.sampled_at() + life_of(wiring) ? box.value
                                                                            : vm::kUnknown;
  }
  // When its last reading was taken; 0: there was none.
  kernel::Time sampled_at(unsigned channel) const {
    const auto lock = kernel_.lock();
    return boxes_[channel].sampled_at();
  }
  // The channels, except `fresh` ones, whose last sample is older than channel.stale_ms or that were
  // forgotten; each is returned once. They are unknown from now on.
  [[nodiscard]] ChannelMask take_expired(const vm::Image& image, ChannelMask fresh,
                                         kernel::Time now) {
    return now < next_expiry_ ? 0 : expire_old(image.channels, fresh, now);
  }
  // No channel expires before this; kForever: none ever does. Readings that arrive later put expiry off,
  // so this may be too early.
  kernel::Time next_expiry() const { return next_expiry_; }

private:
  class Mailbox {
  public:
    bool is_known() const { return value != vm::kUnknown; }
    kernel::Time sampled_at() const { return kernel::Time{sampled_high_} << 32 | sampled_low_; }
    void sample_at(kernel::Time time) {
      sampled_low_ = static_cast<std::uint32_t>(time);
      sampled_high_ = static_cast<std::uint32_t>(time >> 32);
    }

    vm::Value value = vm::kUnknown;

  private:
    std::uint32_t sampled_low_ = 0;  // in halves, which need no padding
    std::uint32_t sampled_high_ = 0;
  };

  // How long a reading lasts if wiring.stale_ms is not 0: that long, plus a tick. 32 bits are enough.
  static kernel::Duration life_of(const vm::Channel& wiring) {
    const std::uint32_t life = (wiring.stale_ms + 1U) * static_cast<std::uint32_t>(kernel::kTick);
    return life;
  }
  [[nodiscard]] ChannelMask expire_old(std::span<const vm::Channel> channels, ChannelMask fresh,
                                       kernel::Time now);
  [[nodiscard]] bool expire(unsigned channel, const vm::Channel& wiring, kernel::Time now);
  // When expire() may first be true; kForever for never.
  kernel::Time expires_at(unsigned channel, const vm::Channel& wiring) const;

  // … of one that is known.
  [[gnu::always_inline]] kernel::Time expiry_of(unsigned channel, const vm::Channel& wiring) const {
    if (has(forgotten_, channel)) return 0;
    if (wiring.stale_ms == 0) return kernel::kForever;
    return boxes_[channel].sampled_at() + life_of(wiring);
  }
  void note_known(unsigned channel, const vm::Channel& wiring);
  void set_next_expiry(kernel::Time time);

  kernel::Kernel& kernel_;

  kernel::Time next_expiry_ = kernel::kForever;
  std::uint32_t expiry_tick_ = 0;  // the tick of next_expiry_, or an earlier one
  // The same for what was posted or forgotten during expire_old().
  kernel::Time expiry_of_news_ = kernel::kForever;
  std::span<Mailbox> boxes_;
  ChannelMask announced_ = 0;
  ChannelMask forgotten_ = 0;
};

}  // namespace robosync::layers
