// The verbs of the tool: one list (verbs.def), one short file each (verbs/NAME.cpp).
#pragma once

#include <array>
#include <string_view>

#include <CLI/CLI.hpp>

namespace robosync::tool {

// Adds the verb's options to `app` and sets what runs when it is called. That throws Failure when
// it cannot do its work.
#define VERB(name, summary, example) void add_##name(CLI::App& app);
#include "rsc/verbs.def"
#undef VERB

struct Verb {
  std::string_view name, summary, example;
  void (*add)(CLI::App&);
};

inline constexpr std::array kVerbs = {
#define VERB(name, summary, example) Verb{#name, summary, example, add_##name},
#include "rsc/verbs.def"
#undef VERB
};

}  // namespace robosync::tool
