// flash and ports: with a folder for a drive, and programs on PATH that only say what they were told.
#include <filesystem>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "rsc/device/drives.hpp"
#include "rsc/device/seen_boards.hpp"
#include "tests/rsc/process.hpp"

using namespace robosync;
using Catch::Contains;
using test::Folder;
using test::Outcome;

namespace {

const std::string kBoard = "b-l475e-iot01a";
const std::string kFirmware = std::string("\x00\x40\x01\x20 RoboSync ", 14) + kBoard + " 0.1.0";

// As objcopy -O ihex writes it, without sums that are right.
std::string hex_of(const std::string& bytes) {
  std::string text = ":020000040800F2\n";
  for (std::size_t at = 0; at < bytes.size(); at += 16) {
    const std::string part = bytes.substr(at, 16);
    text += fmt::format(":{:02X}{:04X}00", part.size(), at);
    for (const char c : part)
      text += fmt::format("{:02X}", static_cast<unsigned char>(c));
    text += "00\n";
  }
  return text + ":00000001FF\n";
}

// A computer with the firmware's files, a drive, and nothing on PATH.
struct Computer : Folder {
  Computer() {
    for (const char* const folder : {"drive", "bin"})
      std::filesystem::create_directory(path(folder));
  }
  // It writes down what it is told, a word a line.
  void install(const std::string& tool, int exit = 0) const {
    const std::string file =
        write("bin/" + tool, fmt::format("#!/bin/sh\nprintf '%s\\n' \"$@\" > '{}'\nexit {}\n",
                                         path(tool + ".told"), exit));
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  Outcome flash(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"flash", "--board", kBoard});
    return test::rsc(std::move(arguments), {"PATH=" + path("bin")});
  }
  std::string bin = write("robosync-" + kBoard + ".bin", kFirmware);
  std::string hex = write("robosync-" + kBoard + ".hex", hex_of(kFirmware));
};

}  // namespace

TEST_CASE("flash copies the file that the board's drive takes, and says so") {
  const Computer computer;
  for (const std::string& file : {computer.bin, computer.hex}) {  // of the .hex, the .bin beside it
    std::filesystem::remove(computer.path("drive/robosync-" + kBoard + ".bin"));
    const Outcome outcome = computer.flash({file, "--drive", computer.path("drive")});
    CAPTURE(outcome.err);
    CHECK(outcome.exit == 0);
    CHECK(computer.read("drive/robosync-" + kBoard + ".bin") == kFirmware);
    CHECK_THAT(outcome.out,
               Contains(fmt::format("copying {} ({} bytes) to the drive {}", computer.bin,
                                    kFirmware.size(), computer.path("drive"))) &&
                   Contains("rsc info"));
  }
}

TEST_CASE("flash calls openocd, else pyocd, and says with which words") {
  const Computer computer;
  computer.install("pyocd");
  Outcome outcome = computer.flash({computer.hex});
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  CHECK(computer.read("pyocd.told") == "flash\n--target\nstm32l475xg\n" + computer.hex + "\n");
  CHECK_THAT(outcome.out, Contains("running pyocd flash --target stm32l475xg " + computer.hex));

  computer.install("openocd");
  outcome = computer.flash({computer.bin});  // the .hex beside it, which says where it belongs
  CHECK(outcome.exit == 0);
  CHECK(computer.read("openocd.told") ==
        "-f\nboard/stm32l4discovery.cfg\n-c\nprogram {" + computer.hex + "} verify reset exit\n");
  std::filesystem::remove(computer.path("pyocd.told"));
  CHECK(computer.flash({computer.hex, "--by", "pyocd"}).exit == 0);
  CHECK(computer.has("pyocd.told"));
}

TEST_CASE("flash calls dfu-util for a chip with a DFU boot loader, and for no other") {
  const Computer computer;
  computer.install("dfu-util");
  const Outcome outcome = computer.flash({computer.hex});  // the .bin beside it
  CAPTURE(outcome.err);
  CHECK(outcome.exit == 0);
  CHECK(computer.read("dfu-util.told") ==
        "-d\n0483:df11\n-a\n0\n-s\n0x08000000:leave\n-D\n" + computer.bin + "\n");
  computer.install("dfu-util", 74);
  const Outcome failed = computer.flash({computer.bin, "--by", "dfu-util"});
  CHECK(failed.exit == 3);
  CHECK_THAT(failed.err, Contains("dfu-util ended with 74") && Contains("BOOT0"));
  const Outcome refused = test::rsc({"flash", "--board", "microbit-v2", "--by", "dfu-util"});
  CHECK(refused.exit == 2);
  CHECK_THAT(refused.err, Contains("the microbit-v2 has no DFU boot loader"));
}

TEST_CASE(
    "flash puts the .hex on a micro:bit's drive, and gives openocd both scripts that it takes") {
  const Computer computer;
  computer.install("openocd");
  const std::string firmware = "RoboSync microbit-v2 0.1.0";
  const std::string hex = computer.write("robosync-microbit-v2.hex", hex_of(firmware));
  computer.write("robosync-microbit-v2.bin", firmware);
  const auto flash = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"flash", "--board", "microbit-v2", hex});
    return test::rsc(std::move(arguments), {"PATH=" + computer.path("bin")});
  };
  CHECK(flash({"--drive", computer.path("drive")}).exit == 0);
  CHECK(computer.read("drive/robosync-microbit-v2.hex") == hex_of(firmware));
  CHECK(flash({"--by", "openocd"}).exit == 0);
  CHECK(computer.read("openocd.told") ==
        "-f\ninterface/cmsis-dap.cfg\n-f\ntarget/nrf52.cfg\n-c\nprogram {" + hex +
            "} verify reset exit\n");
  CHECK_THAT(flash({"--by", "drive"}).err, Contains("no drive MICROBIT is mounted"));
}

TEST_CASE("flash says what to do when a tool fails, and when there is no board") {
  const Computer computer;
  Outcome outcome = computer.flash({computer.hex});
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("no board found: no drive DIS_L4IOT is mounted, and neither "
                                   "openocd nor pyocd is installed") &&
                              Contains("Connect the USB socket marked ST-LINK (CN7)") &&
                              Contains("--drive FOLDER") && Contains("apt install openocd"));
  CHECK_THAT(computer.flash({computer.hex, "--by", "openocd"}).err,
             Contains("openocd is not installed"));
  computer.install("openocd", 1);
  outcome = computer.flash({computer.hex});
  CHECK(outcome.exit == 3);
  CHECK_THAT(
      outcome.err,
      Contains(
          "openocd ended with 1: is the board connected by the USB socket marked ST-LINK (CN7)?"));
  CHECK_THAT(computer.flash({computer.hex, "--drive", computer.path("none")}).err,
             Contains("there is no such folder"));
}

TEST_CASE("flash takes no firmware of another board, and no board that is none") {
  const Computer computer;
  computer.install("openocd");
  for (const auto& [name, text] : {std::pair{"other.bin", std::string("RoboSync mps2-an386")},
                                   std::pair{"other.hex", hex_of("RoboSync mps2-an386")}}) {
    const std::string other = computer.write(name, text);
    const bool to_drive = other.ends_with(".bin");
    const Outcome outcome = to_drive ? computer.flash({other, "--drive", computer.path("drive")})
                                     : computer.flash({other});
    CHECK(outcome.exit == 3);
    CHECK_THAT(outcome.err, Contains(other + " is not the firmware of " + kBoard));
  }
  CHECK(std::filesystem::is_empty(computer.path("drive")));
  CHECK_FALSE(computer.has("openocd.told"));
  CHECK_THAT(computer.flash({computer.path("none.hex")}).err, Contains("there is no such file"));
  const std::string alone = computer.write("alone.bin", kFirmware);
  CHECK_THAT(computer.flash({alone}).err, Contains("a .elf file is needed"));
  CHECK_THAT(computer.flash({}).err, Contains("scripts/firmware " + kBoard));

  Outcome outcome = test::rsc({"flash"});
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err, Contains("--board is required") &&
                              Contains("b-l475e-iot01a, microbit-v2") && !Contains("mps2"));
  outcome = test::rsc({"flash", "--board", "mps2-an386"});
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err, Contains("mps2-an386 is an emulated board"));
  outcome = test::rsc({"flash", "--board", "b-l475e-iot01"});
  CHECK(outcome.exit == 2);
  CHECK_THAT(outcome.err,
             Contains("there is no board `b-l475e-iot01`; did you mean `b-l475e-iot01a`?"));
}

TEST_CASE("a drive is found by its name among what is mounted") {
  const char* const mounts =
      "/dev/sda1 / ext4 rw 0 0\n/dev/sdb /media/a\\040b/DIS_L4IOT vfat rw 0 0\n/dev/sdc "
      "/media/X_DIS_L4IOT vfat rw 0 0\n";
  CHECK(tool::drive_among(mounts, "DIS_L4IOT") == std::filesystem::path("/media/a b/DIS_L4IOT"));
  CHECK_FALSE(tool::drive_among(mounts, "MICROBIT"));
}

TEST_CASE("only a port that may be a board is asked which one it is") {
  std::vector<std::string> asked;
  const tool::Ask ask = [&](const std::string& port) -> std::optional<tool::Answer> {
    asked.push_back(port);
    if (port == "/dev/ttyACM1") return std::nullopt;
    return tool::Answer{kBoard, "0.1.0"};
  };
  const auto seen = tool::look_at_ports({{"/dev/ttyS0", "", ""},
                                         {"/dev/ttyUSB0", "FTDI", "0403:6001"},
                                         {"/dev/ttyACM0", "ST-Link", "0483:374b"},
                                         {"/dev/ttyACM1", "ST-Link", "0483:374b"}},
                                        ask);
  CHECK(asked == std::vector<std::string>{"/dev/ttyACM0", "/dev/ttyACM1"});
  REQUIRE(seen.size() == 4);
  CHECK(seen[1].may_be.empty());
  CHECK(seen[2].answer->board == kBoard);
  CHECK_FALSE(seen[3].answer);
  CHECK(seen[3].may_be == std::vector<std::string>{kBoard, "nucleo-l476rg"});
}
