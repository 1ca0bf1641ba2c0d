// Writes bytecode as text, for rsc dump and the tests.
#pragma once

#include <cstddef>
#include <span>

#include "vm/image.hpp"

namespace robosync::vm {

// Writes one instruction of `image` to `buffer` as text without a newline, with names from the image
// (always NUL-terminated, truncated if too long). Returns the length written. Freestanding: no heap.
std::size_t disassemble(const Image& image, Word word, std::span<char> buffer);

}  // namespace robosync::vm
