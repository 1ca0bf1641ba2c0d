// Non-volatile memory of a board: an EEPROM, or pages of flash.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::boards {

class Store {
public:
  enum class Outcome : std::uint8_t {
    done,
    taken,  // a thread with a higher rank took the bus; the effect is unknown: try again immediately
    busy,   // no answer: it is writing, which takes a few milliseconds, or it is not there
    goes_on,  // the next part stalls everything else for kStall ticks at most: call again when nothing is due in that time
    at_work,  // it continues on its own and stalls nothing: call again after a tick, but not for ever
    spent     // it cannot be written there, or does not hold the data
  };
  // Most bytes of one read or write: few enough that a thread of the lowest rank completes them between others.
  static constexpr std::size_t kPiece = 16;
  static constexpr std::uint32_t kStall = 3;

  virtual std::uint32_t size() const = 0;  // bytes
  // Bytes in an aligned block that a power cut may damage while any byte of the block is written; a multiple of
  // kPiece.
  virtual std::uint32_t page() const = 0;
  // Flash: a write to the beginning of a page erases the page; the rest is then written once, in ascending order. A power cut
  // damages the whole page only while it is being erased, otherwise only the piece that is being written.
  virtual bool is_flash() const { return false; }

  // Both: at most kPiece bytes, at a multiple of kPiece, within size().  [the thread with the lowest rank]
  // No sensor may be measured during a read.
  virtual Outcome read(std::uint32_t at, std::span<std::byte> bytes) = 0;
  // Sensors may be measured during a write: they take the bus away.
  virtual Outcome write(std::uint32_t at, std::span<const std::byte> bytes) = 0;

protected:
  ~Store() = default;
};

}  // namespace robosync::boards
