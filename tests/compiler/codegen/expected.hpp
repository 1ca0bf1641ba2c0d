// What a response does by the reference interpreter (tests/oracles/rsl), told as Runner tells it: the
// other opinion on what its code does.
#pragma once

#include "tests/compiler/codegen/run.hpp"
#include "tests/oracles/rsl/evaluator.hpp"

namespace robosync::compiler::testing {

// The world as the reference interpreter sees it.
[[nodiscard]] oracle::Snapshot snapshot_of(const World& world);

// As Runner::respond: until the end, or until it has paused `pauses` times. It draws from `chance`.
Effects expected_effects(const ir::Block& block, const std::vector<ir::Variable>& variables,
                         World& world, unsigned pauses, oracle::Chance chance,
                         const std::function<void(World&)>& pass_time);

}  // namespace robosync::compiler::testing
