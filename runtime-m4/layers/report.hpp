// LOG and ALERT: what a program says to people.
#pragma once

#include "runtime-m4/layers/trace.hpp"
#include "vm/output.hpp"

namespace robosync::layers {

// `said` is a text, and `params` are the values in it.
void report_text(Trace& trace, vm::Output said, const vm::Params& params, Stamp stamp);

}  // namespace robosync::layers
