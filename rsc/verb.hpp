// The verbs of the tool: one list (verbs.def), one short file each (verbs/NAME.cpp).
#pragma once

#include <array>
#include <string_view>

#include "rsc/options.hpp"

namespace robosync::tool {

// Declares the verb's options and its action.
#define VERB(name, summary, example) void add_##name(Options& options);
#include "rsc/verbs.def"
#undef VERB

struct Verb {
  std::string_view name, summary, example;
  void (*add)(Options&);
};

inline constexpr std::array kVerbs = {
#define VERB(name, summary, example) Verb{#name, summary, example, add_##name},
#include "rsc/verbs.def"
#undef VERB
};

}  // namespace robosync::tool
