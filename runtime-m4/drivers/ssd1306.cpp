// Solomon Systech SSD1306, a display of 128 x 64 dots on I2C (data sheet Rev. 1.1): control bytes 8.1.5.2, commands table 9-1,
// addressing by pages 10.1.3; the order of the setup is that of its application note (charge pump regulator, 2.2).
//
// A byte of its memory is 8 dots of a column, the top one in bit 0; 128 bytes are a page, and 8 pages go from the top
// down. Here a light of a five by five picture is 12 x 12 dots. So in each page the 12 bytes of a light's columns are
// all alike: a tile. Each transfer sends one tile or two commands.
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "runtime-m4/drivers/drivers.hpp"
#include "runtime-m4/drivers/screen.hpp"
#include "runtime-m4/policy/costs.hpp"

namespace robosync::drivers {
namespace {

using Screen = guard::OutputGuard::Screen;

constexpr std::byte kCommand{0x80};  // one command follows, then another control byte
constexpr std::byte kData{0x40};     // only data follows
constexpr std::uint8_t kPage = 0xB0;
constexpr std::uint8_t kColumnHigh = 0x10;

// A command and its argument, or two commands.
constexpr std::array<std::array<std::uint8_t, 2>, 10> kCommands = {{
    {0x20, 0x02},  // addressing by pages
    {0xA8, 0x3F},  // 64 rows,
    {0xD3, 0x00},  // … none of them shifted,
    {0xDA, 0x12},  // … wired alternately
    {0x81, 0x7F},  // contrast
    {0xD5, 0x80},  // clock
    {0x8D, 0x14},  // charge pump: there is no other supply
    {0x40, 0xA1},  // memory from row 0; columns and
    {0xC8, 0xA4},  // … rows as modules are mounted; dots as in the memory
    {0xA6, 0xAF},  // not inverse; on
}};

constexpr unsigned kLights = 5;  // in a row, and rows
constexpr unsigned kSide = 12;   // dots
constexpr unsigned kPages = 8;
constexpr unsigned kPageRows = 8;
constexpr unsigned kColumns = 128;
constexpr unsigned kTilesEach = (kColumns + kSide - 1) / kSide;  // of a page
constexpr unsigned kLeft = 3;                                    // tiles
// The portions of a full refresh: the setup, all tiles, and switching on.
constexpr unsigned kFirstTile = kCommands.size() - 1;
constexpr unsigned kTurnOn = kFirstTile + kPages * kTilesEach;
constexpr unsigned kTriesEach = 2;

// The lights of a row, if there is such a row.
constexpr std::uint32_t row_of(std::uint32_t picture, unsigned row) {
  return picture >> kLights * row & ((1U << kLights) - 1);
}

// The tiles in which a change of these lights shows (Screen::stale).
std::uint64_t tiles_of(std::uint32_t lights) {
  std::uint64_t tiles = 0;
  for (unsigned page = 0; page < kPages; ++page) {
    const unsigned top = page * kPageRows;
    const std::uint32_t here =
        row_of(lights, top / kSide) | row_of(lights, (top + kPageRows - 1) / kSide);
    tiles |= std::uint64_t{here} << kLights * page;
  }
  return tiles;
}

// It is dark outside the picture.
std::byte tile(std::uint32_t picture, unsigned page, unsigned column) {
  unsigned dots = 0;
  for (unsigned dot = 0; dot < kPageRows && column - kLeft < kLights; ++dot)
    dots |= (row_of(picture, (page * kPageRows + dot) / kSide) >> (column - kLeft) & 1) << dot;
  return static_cast<std::byte>(dots);
}

bool send_commands(const ServedBus& at, unsigned place) {
  const auto& two = kCommands[place];
  const std::array out{kCommand, std::byte{two[0]}, kCommand, std::byte{two[1]}};
  return exchange(at, out, {}, kTriesEach);
}

bool send_tile(const ServedBus& at, unsigned place, std::uint32_t picture) {
  const unsigned page = place / kTilesEach;
  const unsigned column = place % kTilesEach;
  const unsigned first = column * kSide;
  std::array<std::byte, 7 + kSide> out;
  out.fill(tile(picture, page, column));
  out[0] = out[2] = out[4] = kCommand;
  out[1] = static_cast<std::byte>(kPage | page);
  out[3] = static_cast<std::byte>(first & 0x0F);
  out[5] = static_cast<std::byte>(kColumnHigh | first >> 4);
  out[6] = kData;
  return exchange(at, std::span(out).first(7 + std::min(kSide, kColumns - first)), {}, kTriesEach);
}

bool send(const ServedBus& at, unsigned portion, std::uint32_t picture) {
  if (portion < kFirstTile) return send_commands(at, portion);
  if (portion == kTurnOn) return send_commands(at, kFirstTile);
  return send_tile(at, portion - kFirstTile, picture);
}

// Sends an outdated tile, or the next portion of the refresh.
bool send_next(const ServedBus& at, Screen& screen) {
  if (screen.whole && screen.stale != 0) {
    const auto first = static_cast<unsigned>(std::countr_zero(screen.stale));
    const unsigned place = first / kLights * kTilesEach + kLeft + first % kLights;
    screen.stale &= screen.stale - 1;
    return send_tile(at, place, screen.picture);
  }
  if (!send(at, screen.portion, screen.picture)) return false;
  screen.whole = screen.whole || screen.portion == kTurnOn;
  screen.portion = screen.portion == kTurnOn ? 0 : static_cast<std::uint8_t>(screen.portion + 1);
  return true;
}

}  // namespace

bool serve_ssd1306(const ServedBus& at, guard::OutputGuard& outputs, unsigned sensor) {
  Screen* const kept = outputs.screen_of(sensor);
  if (kept == nullptr) return true;
  Screen& screen = *kept;
  const std::uint32_t picture = outputs.picture_on(sensor);
  screen.stale |= tiles_of(screen.picture ^ picture);
  screen.picture = picture;
  for (unsigned sent = 0; sent < policy::kDisplayPortions; ++sent) {
    if (screen.whole && screen.stale == 0 && sent != 0) break;
    if (send_next(at, screen)) continue;
    screen = {};
    return false;
  }
  return true;
}

namespace ssd1306 {

// It has no channels (the verifier checks this), so none is ever read.
bool read(boards::Board&, const vm::Sensor&, const vm::Channel&, std::int32_t&) {
  return false;
}

}  // namespace ssd1306
}  // namespace robosync::drivers
