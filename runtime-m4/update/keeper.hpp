// Decides with which program the robot starts after a reset, and brings it and its KEPT numbers back.
//
// A program that the host has uploaded is on trial: it is written into the store meanwhile, and kept when it has run
// for kTrial, or as long as the host says, without a fault and without a SAFETY rule that tripped, unless one of the program
// before did so, too. Else the kept program comes back at once; a reset before the end brings it back by itself. KEPT
// numbers are written down once a second when they have changed; a program that comes begins with those of the one before. All
// of it in pieces of one transfer, by the link thread, between the host's requests; who uploads comes first.
#pragma once

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
  static constexpr kernel::Duration kLook = kernel::milliseconds(1000);  // at the numbers
  static constexpr kernel::Duration kTripSeen =
      kernel::milliseconds(50);  // in a trial, at the latest
  // Where no program runs and no host has sent anything for so long, the kept one begins.
  static constexpr kernel::Duration kSilence = kernel::milliseconds(3000);
  // Between two parts of an erasing, while each of which the processor may stand still: so much for all others, at least.
  static constexpr kernel::Duration kRest = kernel::milliseconds(10);

  // A transfer to `receiver` that has not come to its end is given up when a program is read from the store:
  // both need the room.
  Keeper(kernel::Kernel& kernel, Runtime& runtime, link::Receiver& receiver, boards::Store* store)
      : kernel_(kernel),
        runtime_(runtime),
        receiver_(receiver),
        store_(store),
        number_store_(store) {}

  // All but fault() by the link thread.
  // Once, first of all. `failed`: the board has started because it had hung or faulted. Then nothing moves by itself:
  // the kept program begins as if a person had said stop.
  void boot(bool failed);
  void activated(const link::Activate& how);  // a program of the host runs
  void ends();                                // the running one is about to
  void host_sends();                          // an image is coming into the room
  // … and is about to run; `fresh`: its KEPT numbers begin as it says.
  void host_activates(bool fresh);
  // A person's wish: back to the program of that name. When it is not the one before, nothing happens: so asking
  // twice does no more than asking once.
  void roll_back(const link::ProgramHash& hash);
  void fault() { fault_ = true; }  // of a thread of the running program  [any]

  // The next piece. False when there is none before due(), or fault().
  bool work();
  kernel::Time due() const { return due_; }

  kernel::Time heard() const { return heard_; }  // when the host sent something of an image last

  void fill(link::Kept& answer) const;

private:
  using Program = ProgramStore::Program;
  // What is being done with the store. While it is read, no program runs: where the one that is wanted is not whole,
  // the other one is.
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
  bool goes_back_ = false;    // when the trial is over, however well it went
  bool trips_count_ = false;  // a SAFETY rule that trips ends the trial
  kernel::Time due_ = kernel::kForever;
  kernel::Time heard_ = 0;        // from the host
  link::ProgramHash given_up_{};  // the last program that did not stand its trial
  std::atomic<bool> fault_ = false;
  bool stalls_ = false;  // the next piece does

  KeptNumbers numbers_;
  kernel::Time next_look_ = 0;
  bool failed_ = false;  // … and no program has begun since
};

}  // namespace robosync::update
