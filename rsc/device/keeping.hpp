// Which programs a board keeps through a reset: in `rsc info`, after `rsc upload`, and for `rsc rollback`.
#pragma once

#include <cstdint>
#include <string>

#include "link/messages.hpp"
#include "rsc/device/client.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {

// Whether the running program is kept ("kept: the robot starts with it"), or why not.
[[nodiscard]] std::string keeping_text(const link::Kept& kept);
// The same for the uploaded program, which may no longer be running.
[[nodiscard]] std::string keeping_text(const link::Kept& kept, const link::ProgramHash& uploaded);
// The kept program is running again instead of it.
[[nodiscard]] bool has_gone_back(const link::Kept& kept, const link::ProgramHash& uploaded);
// One of its threads faulted, or a SAFETY rule tripped.
[[nodiscard]] bool has_failed_trial(const link::Kept& kept, const link::ProgramHash& uploaded);
// The program that `rsc rollback` returns to, or why there is none.
[[nodiscard]] std::string rollback_text(const link::Kept& kept);
[[nodiscard]] Json keeping_json(const link::Kept& kept);

// Waits until the trial of the running program is over.
[[nodiscard]] link::Kept after_trial(Client& client);
// Waits until the running program's SAFETY rules have been evaluated for the first time, if it can go back and does not
// wait long for its sensors (`safety_start_ms`).
[[nodiscard]] link::Kept after_first_look(Client& client, std::uint32_t safety_start_ms);
// Throws Failure (program) if the board keeps no program to return to after a trial.
void expect_kept_program(Client& client);

// Returns to the program before the running one; the result is the board's hello with it running. Throws Failure
// (program) if there is none, or it cannot be started.
link::HelloReply roll_back(Client& client);

}  // namespace robosync::tool
