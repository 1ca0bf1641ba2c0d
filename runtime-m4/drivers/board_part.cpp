// A part of the board that needs no wiring and no bus: the board measures it.
#include "runtime-m4/drivers/drivers.hpp"

namespace robosync::drivers::board_part {

bool read(boards::Board& board, const vm::Sensor&, const vm::Channel& channel, std::int32_t& raw) {
  return board.measure(static_cast<boards::Part>(channel.input), raw);
}

}  // namespace robosync::drivers::board_part
