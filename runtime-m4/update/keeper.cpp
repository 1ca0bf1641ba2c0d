// See keeper.hpp.
#include "runtime-m4/update/keeper.hpp"

#include <algorithm>
#include <cstring>

#include "vm/identity.hpp"

namespace robosync::update {

using link::Keeping;

void Keeper::boot(bool failed) {
  failed_ = failed;
  if (store_.open()) doing_ = Doing::opening;
}

Keeper::Program Keeper::running_program() const {
  if (!runtime_.running()) return {};
  const vm::ImageHeader& header = *runtime_.image().header;
  return {header.total_length, header.program_hash};
}

void Keeper::activated(const link::Activate& how) {
  running_ = running_program();
  if (given_up_ == running_.hash) given_up_ = {};  // it runs again, and may pass this time
  failed_ = false;
  trial_ends_ = kernel_.now() + (how.trial_ms != 0 ? kernel::milliseconds(how.trial_ms) : kTrial);
  goes_back_ = how.goes_back != 0;
  fault_ = false;
  next_look_ = kernel_.now() + kLook;
  write_running();
}

void Keeper::ends() {
  numbers_.learn(runtime_);
  heard_ = kernel_.now();
  running_ = {};
  if (doing_ != Doing::writing) return;
  store_.give_up();
  doing_ = Doing::nothing;
}

void Keeper::host_sends() {
  heard_ = kernel_.now();
  if (!reads()) return;
  store_.give_up();
  doing_ = Doing::nothing;
}

// Sensors are about to be measured. If the host was very quick, the store is still being read over the same bus: wait for
// that, a few milliseconds.
void Keeper::host_activates(bool fresh) {
  while (opens())
    if (!work()) kernel_.sleep_until(due_);
  numbers_.learn(runtime_);
  remember_trips();
  runtime_.begin_with(fresh ? std::span<const layers::KeptNumber>() : numbers_.all(), !fresh);
}

// The program to compare with is the one that comes back if the trial fails. So an upload during a trial changes nothing: a
// program that has tripped in its trial would otherwise excuse itself by coming twice.
void Keeper::remember_trips() {
  if (on_trial() && store_.kept().bytes != 0) return;
  trips_count_ = runtime_.running();
  known_trips_count_ = runtime_.fill_tripped(known_trips_);
}

void Keeper::roll_back(const link::ProgramHash& hash) {
  const bool trial = running_ != store_.kept();
  const Program target = trial ? store_.kept() : store_.previous();
  if (target.bytes == 0 || target.hash != hash || opens() || reads()) return;
  read(trial ? Doing::giving_up_trial : Doing::rolling_back);
}

// The store reads the running program's image in place: it does not move while the program runs.
void Keeper::write_running() {
  doing_ = Doing::nothing;
  store_.give_up();
  if (!on_trial() || !fits() || goes_back_) return;
  store_.write({reinterpret_cast<const std::byte*>(runtime_.image().header), running_.bytes},
               running_);
  doing_ = Doing::writing;
}

void Keeper::read(Doing why) {
  receiver_.reset();
  numbers_.learn(runtime_);
  runtime_.begin_with(numbers_.all());
  runtime_.clear();
  running_ = {};
  doing_ = why;
  reads_previous() ? store_.read_previous(runtime_.room()) : store_.read_kept(runtime_.room());
}

void Keeper::read_the_other(Doing instead_of) {
  if (instead_of == Doing::rolling_back) {
    read(Doing::starting_kept);
  } else if (instead_of != Doing::starting_previous && store_.previous().bytes != 0) {
    read(Doing::starting_previous);
  }
}

bool Keeper::work() {
  due_ = kernel::kForever;
  if (on_trial() && fails_trial() && (doing_ == Doing::nothing || doing_ == Doing::writing))
    return give_up_trial();
  if (waits_for_a_gap()) return false;
  const bool of_numbers = doing_ == Doing::opening_numbers || doing_ == Doing::writing_numbers;
  switch (of_numbers ? number_store_.work() : store_.work()) {
    case Work::some:
      return true;
    case Work::waits:
      due_ = kernel_.now() + kernel::kTick;
      return false;
    case Work::rests:
      stalls_ = true;
      due_ = kernel_.now() + kRest;
      return false;
    case Work::ended:
      ended();
      return true;
    case Work::none:
      break;
  }
  return judge_trial() || look_at_numbers() || start_after_all();
}

// No thread with a deadline, above all the safety thread, may find the processor stalled: a piece that stalls it starts
// only if no thread is due before it ends. The rest of the current tick does not count.
bool Keeper::waits_for_a_gap() {
  if (!stalls_) return false;
  if (kernel_.ticks_to_next_work() <= boards::Store::kStall) {
    due_ = kernel_.now() + kernel::kTick;
    return true;
  }
  stalls_ = false;
  return false;
}

void Keeper::ended() {
  if (store_.there() && doing_ == Doing::opening) {
    number_store_.open();
    doing_ = Doing::opening_numbers;
  } else if (store_.there() && doing_ == Doing::opening_numbers) {
    opened();
  } else if (store_.there() && reads()) {
    start_what_was_read();
  } else {
    doing_ = Doing::nothing;
  }
}

void Keeper::opened() {
  doing_ = Doing::nothing;
  numbers_.begin_with(number_store_.numbers());
  const bool host_has_the_room = receiver_.status().state != link::TransferState::idle;
  if (store_.kept().bytes != 0 && !host_has_the_room) read(Doing::starting_kept);
}

// A host that disappears during an upload must not leave the robot without a program.
bool Keeper::start_after_all() {
  if (doing_ != Doing::nothing || running_.bytes != 0 || store_.kept().bytes == 0) return false;
  if (const kernel::Time at = heard_ + kSilence; kernel_.now() < at) {
    due_ = at;
    return false;
  }
  heard_ = kernel_.now();  // if it is damaged, wait before the next attempt
  read(Doing::starting_kept);
  return true;
}

// True if there are numbers to write.
bool Keeper::look_at_numbers() {
  if (doing_ != Doing::nothing || !store_.there() || running_.bytes == 0) return false;
  const kernel::Time now = kernel_.now();
  if (now >= next_look_) {
    next_look_ = now + kLook;
    numbers_.learn(runtime_);
    if (numbers_.all().empty()) next_look_ = kernel::kForever;  // it will never have any
    if (!std::ranges::equal(numbers_.all(), number_store_.numbers())) {
      number_store_.write(numbers_.all());
      doing_ = Doing::writing_numbers;
      return true;
    }
  }
  due_ = std::min(due_, next_look_);
  return false;
}

void Keeper::start_what_was_read() {
  const Program wanted = reads_previous() ? store_.previous() : store_.kept();
  const std::span<const std::byte> image = store_.image();
  const Doing why = doing_;
  doing_ = Doing::nothing;
  if (failed_) runtime_.stop();
  failed_ = false;
  const bool whole = image.size() == wanted.bytes;
  if (whole && vm::stated_name(image) == wanted.hash && vm::is_named(image, {}) &&
      runtime_.activate(image).ok()) {
    running_ = wanted;
    next_look_ = kernel_.now() + kLook;
    fault_ = false;
    if (why == Doing::giving_up_trial || why == Doing::starting_kept) return;
    store_.swap();
    doing_ = Doing::recording;
  } else {
    read_the_other(why);
  }
}

bool Keeper::fails_trial() const {
  const auto known = std::span(known_trips_).first(known_trips_count_);
  return fault_ || (trips_count_ && runtime_.has_tripped_besides(known));
}

// If there is no program to go back to, it keeps running, but is not kept.
bool Keeper::give_up_trial() {
  fault_ = false;
  trips_count_ = false;
  given_up_ = running_.hash;
  go_back();
  return true;
}

void Keeper::go_back() {
  goes_back_ = false;
  trial_ends_ = kernel::kForever;
  store_.give_up();
  doing_ = Doing::nothing;
  if (store_.kept().bytes != 0) read(Doing::giving_up_trial);
}

// True if the trial is over and leaves something to do.
bool Keeper::judge_trial() {
  if (!on_trial() || doing_ != Doing::nothing) return false;
  if (!goes_back_ && store_.written() != running_) return false;
  if (const kernel::Time now = kernel_.now(); now < trial_ends_) {
    due_ = trips_count_ ? std::min(trial_ends_, now + kTripSeen) : trial_ends_;
    return false;
  }
  if (goes_back_) {
    go_back();
  } else {
    store_.keep_written();
    doing_ = Doing::recording;
  }
  return true;
}

void Keeper::fill(link::Kept& answer) const {
  answer.kept_bytes = store_.kept().bytes;
  answer.kept_hash = store_.kept().hash;
  answer.previous_bytes = store_.previous().bytes;
  answer.previous_hash = store_.previous().hash;
  answer.most_bytes = store_.most_bytes();
  answer.given_up_hash = given_up_;
  const kernel::Time now = kernel_.now();
  const bool swaps = doing_ == Doing::recording && running_ == store_.previous();
  if (opens() || reads() || swaps) {
    answer.state = Keeping::reading;
  } else if (!store_.there()) {
    answer.state = Keeping::no_store;
  } else if (running_.bytes == 0) {
    answer.state = Keeping::no_program;
  } else if (!on_trial()) {
    answer.state = Keeping::kept;
  } else if (!fits()) {
    answer.state = Keeping::too_large;
  } else if (trial_ends_ == kernel::kForever) {
    answer.state = Keeping::failed;
  } else {
    answer.state = Keeping::on_trial;
    answer.goes_back = static_cast<std::uint8_t>(goes_back_);
    answer.trial_ms =
        trial_ends_ <= now ? 0 : static_cast<std::uint32_t>((trial_ends_ - now) / 1000);
  }
}

}  // namespace robosync::update
