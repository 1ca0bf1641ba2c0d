// Decides which program the robot starts with after a reset, and restores that program and its KEPT numbers.
//
// A program that the host uploads is on trial while it is written into the store. It is kept once it has run for kTrial, or for
// as long as the host says, without a fault and without a SAFETY rule that trips, unless the same rule (safety/rule_key.hpp) had
// tripped in the program before, or no program ran before. If the trial fails, the kept program comes back immediately; a reset
// before the end of the trial also brings it back. KEPT numbers are saved once a second if they have changed; a new program begins
// with those of the one before. The link thread does all of this between the host's requests, one transfer at a time; an upload
// takes precedence.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "link/messages.hpp"
#include "link/receiver.hpp"
#include "runtime-m4/kernel/kernel.hpp"
#include "runtime-m4/runtime.hpp"
#include "runtime-m4/update/kept_numbers.hpp"
#include "runtime-m4/update/number_store.hpp"
#include "runtime-m4/update/program_store.hpp"

namespace robosync::update {

class Keeper {
public:
  static constexpr kernel::Duration kTrial = kernel::milliseconds(5000);
  static constexpr kernel::Duration kLook = kernel::milliseconds(1000);  // between looks at numbers
  static constexpr kernel::Duration kTripSeen =
      kernel::milliseconds(50);  // in a trial, at the latest
  // When no program runs and the host has sent nothing for this long, the kept one starts.
  static constexpr kernel::Duration kSilence = kernel::milliseconds(3000);
  // Tripped rules of the program before that are remembered. If there were more, those count as not tripped: that is the safe side.
  static constexpr std::size_t kMostTrips = 16;
  // Between two parts of an erase, each of which may stall the processor: everything else gets at least this much time.
  static constexpr kernel::Duration kRest = kernel::milliseconds(10);

  // An unfinished transfer to `receiver` is dropped when a program is read from the store: both need the room.
  Keeper(kernel::Kernel& kernel, Runtime& runtime, link::Receiver& receiver, boards::Store* store)
      : kernel_(kernel),
        runtime_(runtime),
        receiver_(receiver),
        store_(store),
        number_store_(store) {}

  // Only the link thread calls these, except fault().
  // Called once, before the others. `failed`: the board restarted because it had hung or faulted. Nothing moves then:
  // the kept program starts as if a person had said stop.
  void boot(bool failed);
  void activated(const link::Activate& how);  // the host's program now runs
  void ends();                                // the running program is about to end
  void host_sends();                          // the host is sending an image into the room
  // The host's image is about to run. `fresh`: its KEPT numbers begin with the program's initial values.
  void host_activates(bool fresh);
  // A person wants the program of that name back. If that is not the one before, nothing happens, so asking twice
  // does no more than asking once.
  void roll_back(const link::ProgramHash& hash);
  void fault() { fault_ = true; }  // a thread of the running program faulted  [any]

  // Does the next piece. False when there is none before due(), or fault().
  bool work();
  kernel::Time due() const { return due_; }

  kernel::Time heard() const { return heard_; }  // when the host last sent part of an image

  void fill(link::Kept& answer) const;

private:
  using Program = ProgramStore::Program;
  // What is being done with the store. No program runs while one is read. If the wanted one is damaged, the other
  // one is read.
  enum class Doing : std::uint8_t {
    nothing,
    opening,
    opening_numbers,
    starting_kept,
    starting_previous,
    giving_up_trial,
    rolling_back,
    writing,
    recording,
    writing_numbers
  };

  bool opens() const { return doing_ == Doing::opening || doing_ == Doing::opening_numbers; }
  bool reads_kept() const {
    return doing_ == Doing::starting_kept || doing_ == Doing::giving_up_trial;
  }
  bool reads_previous() const {
    return doing_ == Doing::starting_previous || doing_ == Doing::rolling_back;
  }
  bool reads() const { return reads_kept() || reads_previous(); }
  bool on_trial() const { return running_.bytes != 0 && running_ != store_.kept(); }
  bool fits() const { return running_.bytes <= store_.most_bytes(); }
  Program running_program() const;
  void write_running();
  void read(Doing why);
  void read_the_other(Doing instead_of);
  bool waits_for_a_gap();
  void ended();
  void start_what_was_read();
  void remember_trips();
  bool fails_trial() const;
  bool judge_trial();
  bool give_up_trial();
  void go_back();
  void opened();
  bool start_after_all();
  bool look_at_numbers();

  kernel::Kernel& kernel_;
  Runtime& runtime_;
  link::Receiver& receiver_;
  ProgramStore store_;
  NumberStore number_store_;
  Doing doing_ = Doing::nothing;
  Program running_{};
  kernel::Time trial_ends_ = 0;
  bool goes_back_ = false;    // after the trial, however well it went
  bool trips_count_ = false;  // a SAFETY rule that trips ends the trial, unless it is known
  std::array<std::uint32_t, kMostTrips> known_trips_{};  // of the program before
  std::size_t known_trips_count_ = 0;
  kernel::Time due_ = kernel::kForever;
  kernel::Time heard_ = 0;        // from the host
  link::ProgramHash given_up_{};  // the last program that failed its trial
  std::atomic<bool> fault_ = false;
  bool stalls_ = false;  // the next piece stalls the processor

  KeptNumbers numbers_;
  kernel::Time next_look_ = 0;
  bool failed_ = false;  // see boot(); until a program has started
};

}  // namespace robosync::update
