// See report.hpp.
#include "runtime-m4/layers/report.hpp"

namespace robosync::layers {

[[gnu::noinline]] void report_text(Trace& trace, vm::Output said, const vm::Params& params,
                                   Stamp stamp) {
  if (!trace.listening()) return;
  const bool is_log = said.kind == vm::OutputKind::log;
  link::Event event;
  Trace::begin(event, is_log ? link::EventKind::log : link::EventKind::alert, stamp, said.text, 0);
  each_bit(said.given, [&](unsigned p) { event.values[event.value_count++] = params[p]; });
  trace.emit(event);
}

}  // namespace robosync::layers
