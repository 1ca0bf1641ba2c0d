// Memory of a board that keeps what is in it without power: an EEPROM, or pages of flash.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace robosync::boards {

class Store {
public:
  enum class Outcome : std::uint8_t {
    done,
    taken,  // somebody with a higher rank needed the bus: nothing is certain to have happened; at once again
    busy,  // it does not answer: it is writing, which takes a few milliseconds, or it is not there
    goes_on,  // the next part of it lets all others wait, for kStall ticks at most: again where nobody is due before
    at_work,  // it goes on by itself, and lets nobody wait: again after a tick, and not for ever
    spent     // it cannot be written there, or does not hold it
  };
  // Most bytes of one read or write: so few that a thread of the lowest rank gets them done between others.
  static constexpr std::size_t kPiece = 16;
  static constexpr std::uint32_t kStall = 3;

  virtual std::uint32_t size() const = 0;  // bytes
  // Bytes that a cut of the power while one of them is written may spoil, on a boundary of that many; a
  // multiple of kPiece.
  virtual std::uint32_t page() const = 0;
  // Flash: a write to the beginning of a page erases it, and what stands behind that is written once, from the front on. Then a
  // cut of the power spoils a page that is being erased, or else only the piece that is being written.
  virtual bool is_flash() const { return false; }

  // Both: at most kPiece bytes, on a boundary of kPiece, inside of size().  [the thread with the lowest rank]
  // Nobody may measure with sensors meanwhile.
  virtual Outcome read(std::uint32_t at, std::span<std::byte> bytes) = 0;
  // They may, and take the bus away.
  virtual Outcome write(std::uint32_t at, std::span<const std::byte> bytes) = 0;

protected:
  ~Store() = default;
};

}  // namespace robosync::boards
