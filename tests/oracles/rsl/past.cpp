#include "tests/oracles/rsl/past.hpp"

#include <cstdlib>
#include <optional>

namespace robosync::oracle {
namespace {

// When it became true: it was known not to be, or was never known. What it was before an unknown
// counts on.
std::vector<Moment> rises(const std::vector<Sample>& samples, Truth Sample::*which) {
  std::vector<Moment> result;
  Truth last;
  for (const Sample& sample : samples) {
    if (sample.*which == true && last != true) result.push_back(sample.when);
    if (sample.*which) last = sample.*which;
  }
  return result;
}

}  // namespace

void Past::add(const Sample& sample) {
  if (!samples_.empty()) {
    const Sample& last = samples_.back();
    if (last.first == sample.first && last.second == sample.second && last.number == sample.number)
      return;
  }
  samples_.push_back(sample);
}

Truth Past::truth(const TimeWord& word, Moment now) const {
  switch (word.kind) {
    case vm::TimerKind::held:
      return held(word.amount, now);
    case vm::TimerKind::counted:
      return counted(word.times, word.amount, now);
    case vm::TimerKind::sequence:
      return sequence(word.amount, now);
    case vm::TimerKind::latch:
      return latched();
    case vm::TimerKind::rose:
      return rose(now);
    default:
      return changed(word.amount, now);
  }
}

// "True once the condition has been true for the whole time."
Truth Past::held(Millis duration, Moment now) const {
  if (samples_.back().first != true) return samples_.back().first;
  return now.at - samples_.back().when.at >= duration;
}

// "True at the moment when the condition becomes true for the n-th time inside … Then the count
// starts again at 0."
Truth Past::counted(std::size_t times, Millis within, Moment now) const {
  std::vector<Moment> counts;
  bool result = false;
  for (const Moment& rise : rises(samples_, &Sample::first)) {
    counts.push_back(rise);
    if (counts.size() < times || rise.at - counts[counts.size() - times].at > within) continue;
    counts.clear();
    result = rise.step == now.step;
  }
  if (result) return true;
  if (!samples_.back().first) return std::nullopt;
  return false;
}

// "True at the moment when the second condition becomes true, at most so long after the first one
// became true. Both in the same step do not count."
Truth Past::sequence(Millis within, Moment now) const {
  const std::vector<Moment> firsts = rises(samples_, &Sample::first);
  std::int64_t used_to = -1;  // what came before this step was part of a sequence already
  bool result = false;
  for (const Moment& second : rises(samples_, &Sample::second)) {
    const Moment* first = nullptr;
    for (const Moment& rise : firsts)
      if (rise.step < second.step && rise.step >= used_to) first = &rise;
    if (first == nullptr || second.at - first->at > within) continue;
    used_to = second.step;
    result = second.step == now.step;
  }
  if (!samples_.back().second) return std::nullopt;
  return result;
}

// "The condition becomes true at the number you wrote and false only when the value is past it by
// the margin."
Truth Past::latched() const {
  Truth result = false;
  bool inside = false;
  for (const Sample& sample : samples_) {
    result = either(sample.first, both(inside, sample.second));
    inside = result.value_or(inside);
  }
  return result;
}

// "True in the one step in which the value becomes that word. The first value is no change."
Truth Past::rose(Moment now) const {
  if (!samples_.back().first) return std::nullopt;
  Truth last;
  for (const Sample& sample : samples_) {
    if (sample.when.step == now.step) return sample.first == true && last == false;
    if (sample.first) last = sample.first;
  }
  return false;
}

// "… when the value is another, CHANGES BY when it is so far from the value of the last such
// moment."
Truth Past::changed(std::int64_t least, Moment now) const {
  Number reference;
  bool result = false;
  for (const Sample& sample : samples_) {
    if (!sample.number) continue;
    if (!reference) reference = sample.number;
    const std::int64_t distance = std::abs(*sample.number - *reference);
    if (distance == 0 || distance < least) continue;
    reference = sample.number;
    result = sample.when.step == now.step;
  }
  if (!samples_.back().number) return std::nullopt;
  return result;
}

}  // namespace robosync::oracle
