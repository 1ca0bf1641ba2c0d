// See sensor.hpp.
#include "runtime-m4/layers/sensor.hpp"

#include <algorithm>

#include "runtime-m4/policy/rules.hpp"
#include "vm/drivers.hpp"

namespace robosync::layers {
namespace {

constexpr std::uint64_t kLatestFeed = std::uint64_t{1} << 62;  // so that times do not wrap

}  // namespace

bool SensorLayer::start(const LoadedProgram& program, Sampler& sampler, bool simulated,
                        Memory& memory, ProgramThreads& threads) {
  program_ = &program;
  sampler_ = &sampler;
  simulated_ = simulated;
  begun_ = false;
  awaited_ =
      program.image.has_safety() ? layers::channels_of(program.inputs[vm::kSafetyBehavior]) : 0;
  feed_thread_ = nullptr;
  sample_thread_ = nullptr;
  feeds_.start(memory);
  units_ = memory.take_zero<policy::Part::sensor_units, Unit>();
  for (unsigned s = 0; s < program.image.sensors.size(); ++s)
    if (policy::is_fed(program.image.sensors[s])) {
      if (simulated) awaited_ &= ~channels_of(s);
    } else if (!policy::is_algorithm(program.image.sensors[s]) && !start_sensor(s, threads)) {
      return false;
    }
  return !policy::has_fed_sensors(program.image) || start_feeds(threads);
}

bool SensorLayer::start_sensor(unsigned sensor, ProgramThreads& threads) {
  Unit& unit = units_[sensor];
  unit = {.layer = this, .thread = nullptr, .contact = {}};
  // For a sensor that SAFETY reads, a board waits until it has measured; a simulation begins with that done.
  const bool has_measured = simulated_ && (awaited_ & made_of(sensor)) != 0;
  if (!has_measured)
    unit.contact.discard(vm::first_samples_discarded(program_->image.sensors[sensor].driver));
  const auto entry = [](void* self) {
    const auto& mine = *static_cast<Unit*>(self);
    mine.layer->run_sensor(static_cast<unsigned>(&mine - mine.layer->units_.data()));
  };
  kernel::ThreadSpec spec;
  spec.name = name_of(program_->image, program_->image.sensors[sensor].name, "sensor");
  spec.category = kernel::Category::sensor;
  spec.entry = entry;
  spec.argument = &unit;
  unit.thread = threads.start(spec, sensor);
  return unit.thread != nullptr;
}

ChannelMask SensorLayer::channels_of(unsigned sensor) const {
  const vm::Sensor& wiring = program_->image.sensors[sensor];
  ChannelMask channels = 0;
  for (unsigned i = 0; i < wiring.channel_count; ++i)
    channels |= bit<ChannelMask>(wiring.first_channel + i);
  return channels;
}

// … and of the algorithms that read it.
ChannelMask SensorLayer::made_of(unsigned sensor) const {
  const vm::Image& image = program_->image;
  ChannelMask channels = channels_of(sensor);
  for (unsigned s = 0; s < image.sensors.size(); ++s)
    if (policy::is_algorithm(image.sensors[s]) &&
        policy::input_of(image, image.sensors[s]) == sensor)
      channels |= channels_of(s);
  return channels;
}

void SensorLayer::go() {
  signal_sensors(kGo);
  if (sample_thread_ != nullptr) kernel_.signal(*sample_thread_, kSampled);
}

void SensorLayer::begin(kernel::Time zero) {
  const auto lock = kernel_.lock();
  feeds_.shift(zero, trace_.activated_at());
  begun_ = true;
  signal_sensors(kBegin);
}

void SensorLayer::signal_sensors(kernel::Events events) {
  const auto lock = kernel_.lock();
  for (const Unit& unit : units_)
    if (unit.thread != nullptr) kernel_.signal(*unit.thread, events);
}

bool SensorLayer::start_feeds(ProgramThreads& threads) {
  kernel::ThreadSpec spec;
  spec.name = "feeds";
  spec.category = kernel::Category::sensor;
  spec.entry = [](void* self) { static_cast<SensorLayer*>(self)->run_feeds(); };
  spec.argument = this;
  feed_thread_ = threads.start(spec, policy::kFedSensors);
  return feed_thread_ != nullptr;
}

void SensorLayer::run_sensor(unsigned sensor) {
  kernel_.wait(kGo);
  await_begin(sensor);
  kernel::Time due = first_sample(sensor);
  while (true) {
    await_sample(sensor, due);
    sample(sensor);
    due = next_sample(sensor, due);
  }
}

// When the program begins, unless the sensor takes an echo's time to answer, or is already measuring: one that was asked for
// SAFETY at the last moment has its whole period, too.
kernel::Time SensorLayer::first_sample(unsigned sensor) const {
  const vm::Sensor& wiring = program_->image.sensors[sensor];
  const bool measures = vm::measures_when_told(wiring.driver) && !units_[sensor].contact.discards();
  const bool waits_for_echo = asks_ahead(sensor) >= kernel::milliseconds(policy::kEchoMs);
  const bool at_once = !waits_for_echo && !measures;
  return trace_.activated_at() + (at_once ? 0 : kernel::milliseconds(wiring.period_ms));
}

// A sensor that is asked ahead has its answer when the sample is due. If it was asked too late, this waits for the answer,
// but not for ever.
void SensorLayer::await_sample(unsigned sensor, kernel::Time due) {
  const kernel::Duration ahead = asks_ahead(sensor);
  if (ahead == 0) return kernel_.sleep_until(due);
  kernel_.sleep_until(std::max(due, ahead) - ahead);
  const kernel::Time late = kernel_.now() + ahead + policy::kBusTicks * kernel::kTick;
  ask(sensor);
  kernel_.sleep_until(due);
  while (kernel_.now() < late && sampler_->awaits())
    kernel_.sleep_until(kernel_.now() + kernel::kTick);
}

void SensorLayer::ask(unsigned sensor) {
  const vm::Sensor& wiring = program_->image.sensors[sensor];
  for (unsigned i = 0; i < wiring.channel_count; ++i)
    sampler_->ask(program_->image, static_cast<std::uint8_t>(wiring.first_channel + i));
}

// A sensor that SAFETY reads already measures.
void SensorLayer::await_begin(unsigned sensor) {
  const kernel::Duration period = kernel::milliseconds(program_->image.sensors[sensor].period_ms);
  const bool measures = (awaited_ & made_of(sensor)) != 0;
  while (!begun_) {
    if (const kernel::Duration ahead = asks_ahead(sensor); measures && ahead != 0)
      await_sample(sensor, kernel_.now() + ahead);
    if (measures) sample(sensor);
    if (measures && simulated_) note_tried(channels_of(sensor));
    kernel_.wait(kBegin, measures ? kernel_.now() + period : kernel::kForever);
  }
}

void SensorLayer::note_tried(ChannelMask channels) {
  {
    const auto lock = kernel_.lock();
    awaited_ &= ~channels;
  }
  alarm_.ring(channels);
}

// One period after the last; periods that have passed are skipped, never made up for.
kernel::Time SensorLayer::next_sample(unsigned sensor, kernel::Time last) {
  const kernel::Duration period = kernel::milliseconds(program_->image.sensors[sensor].period_ms);
  const kernel::Time now = kernel_.now();
  const kernel::Time next = last + period;
  if (now < next) return next;
  const auto late = static_cast<std::int32_t>(std::min<kernel::Duration>(now - next, INT32_MAX));
  kernel_.current().note_miss();
  trace_.emit(link::EventKind::deadline, trace_.now(), kernel_.current().rank(), 0, late);
  return next + ((now - next) / period + 1) * period;
}

void SensorLayer::sample(unsigned sensor) {
  const vm::Sensor& wiring = program_->image.sensors[sensor];
  if (vm::is_served(wiring.driver)) return serve_chip(sensor);
  ChannelMask news = 0;
  unsigned failed = 0;
  const unsigned end = wiring.first_channel + wiring.channel_count;
  for (unsigned c = wiring.first_channel; c != end; ++c) {
    const auto channel = static_cast<std::uint8_t>(c);
    vm::Value value = 0;
    if (sampler_->sample(program_->image, channel, value)) {
      if (!units_[sensor].contact.discards()) news |= publish(channel, value, kernel_.now());
    } else {
      ++failed;
    }
  }
  announce_all(news);
  if (sample_thread_ != nullptr) kernel_.signal(*sample_thread_, kSampled);
  note_contact(sensor, failed);
}

// The chip is lost in each frame in which it is silent: an order given meanwhile has no effect, and does not start it later.
[[gnu::noinline]] void SensorLayer::serve_chip(unsigned sensor) {
  note_contact(sensor, sampler_->serve_chip(program_->image, sensor) ? 0 : 1);
  if (units_[sensor].contact.silent()) sampler_->lose_chip(sensor);
}

// Simulated readings come from no device.
void SensorLayer::note_contact(unsigned sensor, unsigned failed) {
  Contact& contact = units_[sensor].contact;
  const Contact::News news = contact.note(failed);
  if (news == Contact::News::none || simulated_) return;
  const auto kind =
      news == Contact::News::silent ? link::EventKind::silent : link::EventKind::answers;
  trace_.emit(kind, trace_.now(), sensor, 0, contact.failed());
}

void SensorLayer::fill_devices(link::Devices& devices) const {
  for (std::size_t s = 0; s < std::min(units_.size(), devices.failed.size()); ++s) {
    const Contact& contact = units_[s].contact;
    if (contact.asked()) devices.asked |= std::uint32_t{1} << s;
    if (contact.silent()) devices.silent |= std::uint32_t{1} << s;
    devices.failed[s] = contact.failed();
  }
}

void SensorLayer::run_feeds() {
  while (true) {
    kernel::Time next = 0;
    {
      const auto lock = kernel_.lock();
      next = feeds_.next_due();
    }
    kernel_.wait(kFeed, next);
    deliver();
  }
}

// One tick's worth: at most as many as the queue holds. A thread that preempts this one goes on with the rest, so
// each entry that leaves the queue is announced, and rung for, under the same lock (announce_to_safety()).
void SensorLayer::deliver() {
  const kernel::Time now = kernel_.now();
  ChannelMask news = 0;
  for (unsigned i = 0; i < feeds_.places(); ++i) {
    const auto lock = kernel_.lock();
    FeedQueue::Entry entry;
    if (!feeds_.take_due(now, entry)) break;
    if (entry.value() == vm::kUnknown) continue;
    const ChannelMask mine = publish(entry.channel(), entry.value(), kernel_.now());
    announce_to_safety(mine);
    news |= mine;
  }
  if (news != 0) kernel_.signal(step_thread_, news_);
  if (awaited_ != 0 && sample_thread_ != nullptr) kernel_.signal(*sample_thread_, kSampled);
}

ChannelMask SensorLayer::publish(std::uint8_t channel, vm::Value value, kernel::Time time) {
  const vm::Channel& wiring = program_->image.channels[channel];
  const Reading reading(channel, std::clamp(value, wiring.min, wiring.max), time);
  if (awaited_ != 0) [[unlikely]] {
    const auto lock = kernel_.lock();
    awaited_ &= ~bit<ChannelMask>(channel);
  }
  return mailboxes_.post(reading, wiring);
}

// Safety first: its work is part of the step with the reading. A tick may make the step thread ready at any time. Under the
// lock it comes too early, when nothing is announced, or too late, when the safety thread, which outranks the step thread, is
// ready too. In between, a step would begin with a reading that SAFETY has not seen.
[[gnu::always_inline]] inline void SensorLayer::announce_to_safety(ChannelMask channels) {
  const auto lock = kernel_.lock();
  mailboxes_.announce(channels);
  alarm_.ring(channels);
}

[[gnu::always_inline]] inline void SensorLayer::announce_all(ChannelMask channels) {
  if (channels == 0) return;
  announce_to_safety(channels);
  kernel_.signal(step_thread_, news_);
}

void SensorLayer::announce(ChannelMask channels) {
  announce_all(channels);
}

link::FeedError SensorLayer::check(const link::Feed& feed) const {
  if (feed.channel >= program_->image.channels.size()) return link::FeedError::no_channel;
  if (!policy::is_fed(program_->image.sensors[program_->image.channels[feed.channel].sensor]))
    return link::FeedError::not_virtual;
  if (feed.at_us != 0 && feed.at_us < trace_.program_time()) return link::FeedError::in_the_past;
  return link::FeedError::none;
}

// The thread that serves the feeds outranks the caller, and would publish the reading before feed() returns. So, where no other
// reading comes first, the caller can do it.
link::FeedResult SensorLayer::feed(const link::Feed& feed) {
  if (feed.at_us != 0 || are_fed() || awaited_ != 0) return enqueue(feed);
  const link::FeedResult result{check(feed), static_cast<std::uint8_t>(feeds_.free_places())};
  if (result.error == link::FeedError::none && feed.value != vm::kUnknown)
    announce_all(publish(static_cast<std::uint8_t>(feed.channel), feed.value, kernel_.now()));
  return result;
}

link::FeedResult SensorLayer::enqueue(const link::Feed& feed) {
  link::FeedResult result{check(feed), 0};
  {
    const auto lock = kernel_.lock();
    const kernel::Time due =
        feed.at_us == 0 ? kernel_.now() : trace_.activated_at() + std::min(feed.at_us, kLatestFeed);
    const FeedQueue::Entry entry(due, static_cast<std::uint8_t>(feed.channel), feed.value);
    if (result.error == link::FeedError::none && !feeds_.insert(entry))
      result.error = link::FeedError::queue_full;
    result.free_places = static_cast<std::uint8_t>(feeds_.free_places());
  }
  if (result.error == link::FeedError::none) kernel_.signal(*feed_thread_, kFeed);
  return result;
}

void SensorLayer::retire(unsigned member_index) {
  for (unsigned s = 0; s < program_->image.sensors.size(); ++s) {
    const vm::Sensor& wiring = program_->image.sensors[s];
    if (policy::thread_of(program_->image, s) != member_index) continue;
    if (vm::is_servo_chip(wiring.driver)) sampler_->lose_chip(s);
    for (unsigned i = 0; i < wiring.channel_count; ++i)
      mailboxes_.forget(wiring.first_channel + i);
  }
}

}  // namespace robosync::layers
