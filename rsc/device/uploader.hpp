// Puts a program on the board: transfer with several frames under way, then activation; and says in words
// why it cannot be done.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "link/messages.hpp"
#include "rsc/device/client.hpp"
#include "rsc/device/session.hpp"
#include "rsc/program.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

struct UploadOptions {
  std::optional<std::chrono::milliseconds> timeout;  // for all of it; else patience()
  std::function<void(std::size_t sent, std::size_t total)> progress;  // may be empty
  bool replace = false;                // the running program is ended first, for its memory
  bool fresh = false;                  // its KEPT numbers begin as it says
  std::chrono::milliseconds trial{0};  // how long it is on trial; 0: as long as the board thinks
  bool confirm = true;                 // false: after the trial the kept program comes back
  std::span<const std::byte>
      base;  // what runs there, as far as anybody knows: that need not travel
};

// How long an upload may take when nobody says: ten times what the bytes take on the wire, and some
// seconds for a board that is busy.
[[nodiscard]] std::chrono::milliseconds patience(std::size_t image_bytes);

struct UploadResult {
  link::ActivateResult activation{};
  std::chrono::microseconds time{};  // from the first byte of the transfer to the board's answer
  std::size_t bytes = 0;             // of the image
  std::size_t frames_sent = 0;       // with pieces of it, repetitions included …
  std::size_t bytes_sent = 0;        // … and what they took on the line
};

// What keeps `image` from running on this board, one sentence each; empty when nothing does.
[[nodiscard]] std::vector<std::string> obstacles(const link::HelloReply& board,
                                                 const vm::Image& image);

// Transfers the image (its header names it) and activates it. `hello` is the board's answer.
// The result says whether it runs. Throws Failure: outside when the board does not answer in time,
// program when the image is too large for it.
[[nodiscard]] UploadResult upload(Client& client, const link::HelloReply& hello,
                                  std::span<const std::byte> image, const UploadOptions& options);

// Uploads `program` without its source lines; the board's answer to hello is not waited for before that begins. Throws Failure: as upload(), and (program) when the
// board cannot run it or refuses it.
UploadResult upload_program(Session& session, const Program& program, const UploadOptions& options);

}  // namespace robosync::tool
