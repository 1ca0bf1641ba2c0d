// LOG and ALERT: what a program says to people.
#pragma once

#include "runtime-m4/layers/trace.hpp"
#include "vm/output.hpp"

namespace robosync::layers {

// `said` is a text.
void report_text(Trace& trace, const vm::Output& said, Stamp stamp);

}  // namespace robosync::layers
