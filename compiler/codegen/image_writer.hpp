// Writes a resolved program as an image (vm/image.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compiler/config/robot.hpp"
#include "compiler/sema/program.hpp"

namespace robosync::compiler {

using ProgramHash = std::array<std::uint8_t, 8>;

struct ImageOptions {
  bool source_lines = true;  // keep the debug section
  bool optimize = false;
};

// Same input, same bytes: the seed of the random numbers is a part of the program's hash, so that a
// program draws the same numbers each time, and another program others.
// Empty when the program is too large for the format or for a board
// (vm::Limits), which is reported.
[[nodiscard]] std::vector<std::byte> write_image(const Program& program, const Robot& robot,
                                                 const ProgramHash& hash, ImageOptions options,
                                                 Diagnostics& diagnostics);

}  // namespace robosync::compiler
