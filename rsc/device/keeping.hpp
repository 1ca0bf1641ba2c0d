// Which programs a board keeps through a reset: in `rsc info`, after `rsc upload`, and for `rsc rollback`.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "link/messages.hpp"
#include "rsc/device/client.hpp"

namespace robosync::tool {

// How it stands with the running program: "kept: the robot starts with it", or why not.
[[nodiscard]] std::string keeping_text(const link::Kept& kept);
// … and with the one that has been uploaded, which may run no more.
[[nodiscard]] std::string keeping_text(const link::Kept& kept, const link::ProgramHash& uploaded);
// The kept program runs again in its place.
[[nodiscard]] bool has_gone_back(const link::Kept& kept, const link::ProgramHash& uploaded);
// A thread of it faulted, or a SAFETY rule tripped.
[[nodiscard]] bool has_failed_trial(const link::Kept& kept, const link::ProgramHash& uploaded);
// Where `rsc rollback` goes, or why nowhere.
[[nodiscard]] std::string rollback_text(const link::Kept& kept);
[[nodiscard]] nlohmann::ordered_json keeping_json(const link::Kept& kept);

// Waits until the trial of the running program is over.
[[nodiscard]] link::Kept after_trial(Client& client);
// Throws Failure (program) when there is none that could come back after a trial.
void expect_kept_program(Client& client);

// Back to the program before the running one; what the board says of it when it runs. Throws Failure (program) when there
// is none, or it cannot be started.
link::HelloReply roll_back(Client& client);

}  // namespace robosync::tool
