// See keeping.hpp.
#include "rsc/device/keeping.hpp"

#include <array>
#include <chrono>
#include <string_view>
#include <thread>

#include <fmt/format.h>

#include "rsc/device/session.hpp"
#include "rsc/failure.hpp"
#include "runtime-m4/policy/rules.hpp"

namespace robosync::tool {
namespace {

using link::Keeping;
using std::chrono::milliseconds;

constexpr milliseconds kReading{10'000};  // a board needs one second for the largest program
constexpr milliseconds kLook{20};
// A program that waits longer for its sensors (`safety.start`) is not waited for: a person may be about to feed them.
constexpr std::uint32_t kLongestStartMs = 500;
constexpr milliseconds kBegins{1000};  // program time has begun by then, in a slow emulator, too
// Program time: by then the rules have been evaluated, and the board has seen whether one tripped.
constexpr std::uint64_t kEvaluatedUs = std::uint64_t{2} * policy::kSafetyPeriodMs * 1000;

constexpr std::array kKeepingStates = {
#define KEEPING(name, doc) std::string_view(#name),
#include "link/keeping.def"
#include "rsc/json.hpp"
#undef KEEPING
};

Json program(std::uint32_t bytes, const link::ProgramHash& hash) {
  if (bytes == 0) return nullptr;
  return {{"hash", text_of(hash)}, {"bytes", bytes}};
}

// The program that `rsc rollback` returns to.
struct RollbackTarget {
  std::uint32_t bytes = 0;  // 0: none
  link::ProgramHash hash{};
};

RollbackTarget rollback_target(const link::Kept& kept) {
  if (kept.state == Keeping::kept) return {kept.previous_bytes, kept.previous_hash};
  return {kept.kept_bytes, kept.kept_hash};
}

std::string why_none(const link::Kept& kept) {
  if (kept.state == Keeping::kept && kept.given_up_hash != link::ProgramHash{})
    return fmt::format(
        "the board went back on its own from program {}, which failed its trial, and keeps only "
        "the running one",
        text_of(kept.given_up_hash));
  return "the board has kept no program before this one";
}

link::Kept when_read(Client& client) {
  const auto give_up = client.now() + kReading;
  link::Kept kept = client.kept();
  while (kept.state == Keeping::reading && client.now() < give_up) {
    std::this_thread::sleep_for(kLook);
    kept = client.kept();
  }
  return kept;
}

}  // namespace

std::string keeping_text(const link::Kept& kept) {
  const std::string_view instead =
      kept.kept_bytes == 0 ? "has no program" : "starts with the program kept before";
  switch (kept.state) {
    case Keeping::no_store:
      return fmt::format("not kept: this board has no working store; after a reset the robot {}",
                         instead);
    case Keeping::no_program:
      return fmt::format("after a reset the robot {}",
                         kept.kept_bytes == 0 ? instead : "starts with the kept program");
    case Keeping::reading:
      return "the board is reading its store";
    case Keeping::kept:
      return "kept: the robot starts with it after a reset";
    case Keeping::on_trial:
      if (kept.goes_back != 0)
        return fmt::format("only on trial: the kept program comes back in {:.1f} s",
                           kept.trial_ms / 1000.0);
      if (kept.kept_bytes != 0)
        return fmt::format(
            "kept in {:.1f} s if it passes its trial: if a SAFETY rule trips or a thread faults "
            "before then, the robot returns to the program kept before; so it does after a reset",
            kept.trial_ms / 1000.0);
      return fmt::format(
          "kept in {:.1f} s if it passes its trial; after a reset before then, the robot {}",
          kept.trial_ms / 1000.0, instead);
    case Keeping::failed:
      return fmt::format("not kept: it failed its trial; after a reset the robot {}", instead);
    case Keeping::too_large:
      return fmt::format(
          "not kept: the board keeps programs of up to {} bytes; after a reset the robot {}",
          kept.most_bytes, instead);
  }
  return "?";
}

std::string rollback_text(const link::Kept& kept) {
  const auto [bytes, hash] = rollback_target(kept);
  return bytes == 0 ? "to none: " + why_none(kept)
                    : fmt::format("to program {} ({} bytes)", text_of(hash), bytes);
}

// If the board reports `kept`, the kept program is the one that runs.
bool has_gone_back(const link::Kept& kept, const link::ProgramHash& uploaded) {
  return kept.state == Keeping::kept && kept.kept_hash != uploaded;
}

// A program that failed its trial once may be uploaded again and pass.
bool has_failed_trial(const link::Kept& kept, const link::ProgramHash& uploaded) {
  return kept.given_up_hash == uploaded && kept.state != Keeping::on_trial &&
         !(kept.state == Keeping::kept && kept.kept_hash == uploaded);
}

std::string keeping_text(const link::Kept& kept, const link::ProgramHash& uploaded) {
  if (!has_gone_back(kept, uploaded)) return keeping_text(kept);
  return fmt::format(
      "not kept: {}; the program kept before runs again",
      has_failed_trial(kept, uploaded) ? "it failed its trial" : "its trial is over");
}

Json keeping_json(const link::Kept& kept) {
  const auto state = static_cast<std::size_t>(kept.state);
  Json object{{"state", state < kKeepingStates.size() ? kKeepingStates[state] : "?"},
              {"program", program(kept.kept_bytes, kept.kept_hash)},
              {"previous", program(kept.previous_bytes, kept.previous_hash)},
              {"most_bytes", kept.most_bytes},
              {"trial_ms", kept.trial_ms},
              {"goes_back", kept.goes_back != 0}};
  const bool none = kept.given_up_hash == link::ProgramHash{};
  object["given_up"] = none ? Json(nullptr) : Json(text_of(kept.given_up_hash));
  const auto [bytes, hash] = rollback_target(kept);
  object["rollback"] = program(bytes, hash);
  return object;
}

link::Kept after_trial(Client& client) {
  link::Kept kept = when_read(client);
  while (kept.state == Keeping::on_trial) {
    std::this_thread::sleep_for(kLook);
    kept = when_read(client);
  }
  return kept;
}

link::Kept after_first_look(Client& client, std::uint32_t safety_start_ms) {
  link::Kept kept = when_read(client);
  if (kept.state != Keeping::on_trial || kept.kept_bytes == 0 || safety_start_ms > kLongestStartMs)
    return kept;
  const auto give_up = client.now() + milliseconds(safety_start_ms) + kBegins;
  while (kept.state == Keeping::on_trial && client.now() < give_up &&
         client.status().program_us < kEvaluatedUs) {
    std::this_thread::sleep_for(kLook);
    kept = when_read(client);
  }
  return when_read(client);
}

void expect_kept_program(Client& client) {
  if (when_read(client).kept_bytes == 0)
    throw Failure(Exit::program,
                  "the robot keeps no program that could come back: upload without --no-confirm");
}

link::HelloReply roll_back(Client& client) {
  const link::Kept before = when_read(client);
  if (before.state == Keeping::no_store)
    throw Failure(Exit::program, "this board keeps no programs: there is none to go back to");
  const auto [bytes, hash] = rollback_target(before);
  if (bytes == 0) throw Failure(Exit::program, why_none(before) + ": upload the one you want");
  client.roll_back(hash);
  when_read(client);
  const link::HelloReply board = client.hello();
  if (board.running == 0 || board.program_hash != hash)
    throw Failure(Exit::program,
                  "the program before is damaged in the board's store: upload the one you want");
  return board;
}

}  // namespace robosync::tool
