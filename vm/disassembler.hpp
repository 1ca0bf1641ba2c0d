// Writes bytecode as text, for rsc dump and the tests.
#pragma once

#include <cstddef>
#include <span>

#include "vm/image.hpp"

namespace robosync::vm {

// One instruction of `image` as text without a newline, names resolved from the image, into
// `buffer` (always NUL-terminated, cut if too long). Returns the length written. Freestanding: no
// heap.
std::size_t disassemble(const Image& image, Word word, std::span<char> buffer);

}  // namespace robosync::vm
