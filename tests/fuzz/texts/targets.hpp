// What reads a text, or bytes, that come from outside: one function each, for scripts/fuzz --texts and for the test that
// goes through what is kept. An input may be anything. Each ends by itself, and aborts when it has seen what must not be.
#pragma once

#include <string_view>

namespace robosync::fuzz {

// TARGET(name, what the bytes are)
#define TARGET(name, what) void name(std::string_view input);
#include "tests/fuzz/texts/targets.def"
#undef TARGET

}  // namespace robosync::fuzz
