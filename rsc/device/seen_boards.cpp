// See seen_boards.hpp.
#include "rsc/device/seen_boards.hpp"

#include <chrono>

#include "compiler/config/boards.hpp"
#include "rsc/device/drives.hpp"
#include "rsc/device/session.hpp"
#include "rsc/failure.hpp"

namespace robosync::tool {
namespace {

std::vector<compiler::Board> boards_to_flash() {
  std::vector<compiler::Board> boards;
  for (std::size_t i = 0; i < compiler::board_names().size(); ++i)
    if (compiler::Board board = compiler::board_at(i); board.flash)
      boards.push_back(std::move(board));
  return boards;
}

}  // namespace

std::optional<Answer> ask_board(const std::string& port) {
  constexpr std::chrono::milliseconds kPatience{600};
  try {
    const Session session(port, kPatience);
    return Answer{text_of(session.board.board), text_of(session.board.firmware)};
  } catch (const Failure&) {
    return std::nullopt;
  }
}

std::vector<SeenPort> look_at_ports(const std::vector<SerialPort>& ports, const Ask& ask) {
  const std::vector<compiler::Board> boards = boards_to_flash();
  std::vector<SeenPort> seen;
  for (const SerialPort& port : ports) {
    SeenPort one{port, {}, {}};
    for (const compiler::Board& board : boards)
      if (board.flash->usb == port.usb) one.may_be.push_back(board.name);
    if (!one.may_be.empty()) one.answer = ask(port.name);
    seen.push_back(std::move(one));
  }
  return seen;
}

std::vector<SeenDrive> look_at_drives() {
  std::vector<SeenDrive> seen;
  for (const compiler::Board& board : boards_to_flash())
    if (const auto place = mounted_drive(board.flash->drive)) seen.push_back({*place, board.name});
  return seen;
}

}  // namespace robosync::tool
