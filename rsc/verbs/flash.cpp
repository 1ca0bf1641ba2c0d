// rsc flash --board NAME [FILE] [--drive FOLDER | --by drive|openocd|pyocd|dfu-util]
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "compiler/config/boards.hpp"
#include "compiler/diagnostics/nearest.hpp"
#include "rsc/device/drives.hpp"
#include "rsc/device/firmware_file.hpp"
#include "rsc/device/programmer.hpp"
#include "rsc/failure.hpp"
#include "rsc/files.hpp"
#include "rsc/output.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {
namespace {

namespace fs = std::filesystem;
using compiler::Board;

enum class Way : std::uint8_t { drive, openocd, pyocd, dfu_util };
const std::vector<std::string> kWays = {"drive", "openocd", "pyocd", "dfu-util"};

struct FlashOptions {
  std::string board, file, drive;
  std::optional<Way> by;
};

Board board_called(const std::string& name) {
  const std::vector<std::string_view> known = compiler::board_names();
  const std::vector<std::string> names(known.begin(), known.end());
  const auto found = std::ranges::find(names, name);
  if (found != names.end())
    return compiler::board_at(static_cast<std::size_t>(found - names.begin()));
  const auto near = compiler::nearest(name, names);
  throw Failure(Exit::usage, fmt::format("there is no board `{}`; {}", name,
                                         near ? fmt::format("did you mean `{}`?", *near)
                                              : fmt::format("boards: {}", fmt::join(names, ", "))));
}

// Emulated boards are not flashed.
std::string boards_to_flash(const char* between) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < compiler::board_names().size(); ++i)
    if (compiler::board_at(i).flash) names.push_back(compiler::board_names()[i]);
  return fmt::format("{}", fmt::join(names, between));
}

void say_what_next(const Board& board) {
  std::cout << fmt::format(
      "`rsc ports` shows the port of the {}, and `rsc info --port PORT` what runs there.\n",
      board.name);
}

void copy_to(const fs::path& drive, const FlashOptions& options, const Board& board) {
  std::error_code error;
  if (!fs::is_directory(drive, error))
    throw Failure(Exit::outside, drive.string() + ": there is no such folder");
  const fs::path file = find_firmware(options.file, board.name, {board.flash->drive_takes});
  const std::vector<std::byte> bytes = read_bytes(file);
  std::cout << fmt::format("copying {} ({} bytes) to the drive {}\n", file.string(), bytes.size(),
                           drive.string());
  write_in_place(drive / file.filename(), bytes);
  std::cout << "The board programs itself; its drive disappears and comes back. A FAIL.TXT on it "
               "then says why it could not.\n";
  say_what_next(board);
}

// Quotes a word for openocd's command language.
std::string braced(const fs::path& file) {
  return "{" + fs::absolute(file).string() + "}";
}

std::vector<std::string> command_of(Way way, const Board::Flash& flash, const fs::path& file) {
  if (way == Way::pyocd) return {"pyocd", "flash", "--target", flash.pyocd, file.string()};
  if (way == Way::dfu_util) {
    const std::size_t space = flash.dfu.find(' ');
    return {"dfu-util",
            "-d",
            flash.dfu.substr(0, space),
            "-a",
            "0",
            "-s",
            flash.dfu.substr(space + 1) + ":leave",
            "-D",
            file.string()};
  }
  std::vector<std::string> command = {"openocd"};
  std::istringstream scripts(flash.openocd);
  for (std::string script; scripts >> script;)
    command.insert(command.end(), {"-f", script});
  command.insert(command.end(), {"-c", fmt::format("program {} verify reset exit", braced(file))});
  return command;
}

void program_by(Way way, const FlashOptions& options, const Board& board) {
  const bool by_dfu = way == Way::dfu_util;
  const fs::path file = by_dfu ? find_firmware(options.file, board.name, {".bin"})
                               : find_firmware(options.file, board.name, {".elf", ".hex"});
  const std::vector<std::string> command = command_of(way, *board.flash, file);
  std::cout << fmt::format("running {}\n", fmt::join(command, " ")) << std::flush;
  if (const int code = run_program(command); code != 0) {
    const std::string question =
        by_dfu
            ? "is the chip's own USB connected, and its boot loader running (BOOT0 high at reset)?"
            : fmt::format("is the board connected by {}?", board.flash->socket);
    throw Failure(Exit::outside,
                  fmt::format("{} ended with {}: {}", command.front(), code, question));
  }
  say_what_next(board);
}

[[noreturn]] void not_found(const Board& board) {
  const Board::Flash& flash = *board.flash;
  throw Failure(
      Exit::outside,
      fmt::format(
          "no board found: no drive {} is mounted, and neither openocd nor pyocd is installed.\n"
          "  Connect {} of the {}, and open its drive {}, so that it is mounted; if it is mounted "
          "elsewhere, give --drive FOLDER.\n"
          "  Or install openocd (apt install openocd), which needs no drive.",
          flash.drive, flash.socket, board.name, flash.drive));
}

void flash(const FlashOptions& options) {
  if (options.board.empty())
    throw Failure(Exit::usage, "--board is required: which board is it? " + boards_to_flash(", "));
  const Board board = board_called(options.board);
  if (!board.flash) {
    throw Failure(Exit::usage, fmt::format("{} is an emulated board: there is nothing to flash, "
                                           "`scripts/robot` starts it with its "
                                           "firmware",
                                           board.name));
  }
  if (!options.drive.empty()) return copy_to(options.drive, options, board);
  const auto may = [&](Way way) { return options.by.value_or(way) == way; };
  if (may(Way::drive))
    if (const auto drive = mounted_drive(board.flash->drive))
      return copy_to(*drive, options, board);
  for (const Way way : {Way::openocd, Way::pyocd, Way::dfu_util}) {
    const std::string& tool = kWays[static_cast<std::size_t>(way)];
    if (way == Way::dfu_util && board.flash->dfu.empty()) {
      if (options.by != way) continue;
      throw Failure(Exit::usage, fmt::format("the {} has no DFU boot loader", board.name));
    }
    if (may(way) && is_installed(tool)) return program_by(way, options, board);
    if (options.by == way)
      throw Failure(Exit::outside, fmt::format("{} is not installed, or not on PATH", tool));
  }
  not_found(board);
}

}  // namespace

void add_flash(Options& options) {
  auto asked = std::make_shared<FlashOptions>();
  options.option("--board", boards_to_flash("|"), asked->board, "the board (required)");
  options.argument("FILE", asked->file,
                   "the firmware; else robosync-NAME here or in build/firmware",
                   Options::Need::optional);
  options.option("--drive", "FOLDER", asked->drive, "where its drive is mounted");
  options.choice(
      "--by", kWays, [asked](std::size_t way) { asked->by = static_cast<Way>(way); },
      "how; else by its drive, or with what is installed");
  options.runs([asked] { flash(*asked); });
}

}  // namespace robosync::tool
