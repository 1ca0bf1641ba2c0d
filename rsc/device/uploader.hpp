// Puts a program on the board: a transfer with several frames in flight, then activation. Explains why a board cannot take it.
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
  std::optional<std::chrono::milliseconds> timeout;  // for the whole upload; else patience()
  std::function<void(std::size_t sent, std::size_t total)> progress;  // may be empty
  bool replace = false;                // end the running program first, to free its memory
  bool fresh = false;                  // its variables start as the program says
  std::chrono::milliseconds trial{0};  // how long it is on trial; 0: the board's default
  bool confirm = true;                 // false: after the trial the kept program comes back
  bool to_any_robot = false;           // also to one with another name than the program's robot
  std::span<const std::byte> base;     // what probably runs there: only the difference is sent
};

// The time limit of an upload over a line that answers: ten times what the bytes take on the wire, plus some seconds for a busy
// board. A board that falls silent ends it earlier.
[[nodiscard]] std::chrono::milliseconds patience(std::size_t image_bytes);

struct UploadResult {
  link::ActivateResult activation{};
  std::chrono::microseconds time{};  // from the first byte of the transfer to the board's answer
  std::size_t bytes = 0;             // of the image
  std::size_t frames_sent = 0;       // with data, repetitions included …
  std::size_t bytes_sent = 0;        // … and what they took on the line
};

// Why `image` cannot run on this board, one sentence for each reason; empty if it can.
[[nodiscard]] std::vector<std::string> obstacles(const link::HelloReply& board,
                                                 const vm::Image& image);

// Transfers the image (its header names it) and activates it. `hello` is the board's answer. The result says whether the program
// runs. Throws Failure (outside) if the board does not answer in time, with what runs then, and Refused if the image is too large
// for it.
[[nodiscard]] UploadResult upload(Client& client, const link::HelloReply& hello,
                                  std::span<const std::byte> image, const UploadOptions& options);

// Uploads `program` without its source lines, starting before the board has answered hello. Throws what upload() throws, and
// Refused if the board cannot run it or refuses it.
UploadResult upload_program(Session& session, const Program& program, const UploadOptions& options);

}  // namespace robosync::tool
