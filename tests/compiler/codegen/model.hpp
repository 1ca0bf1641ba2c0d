// What a response means, worked out from the program itself: the other opinion on what its code
// does. No RANDOM, PICK ONE or time words.
#pragma once

#include "tests/compiler/codegen/run.hpp"

namespace robosync::compiler::testing {

// As Runner::respond: until the end, or until it has paused more than `pauses` times.
Deeds expected_deeds(const ProgramBlock& block, const std::vector<ProgramVariable>& variables,
                     World& world, unsigned pauses, const std::function<void(World&)>& pass_time);

}  // namespace robosync::compiler::testing
