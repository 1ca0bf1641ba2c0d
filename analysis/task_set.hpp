// The task set of a program (response_time.hpp): its sensors with their periods, ranks and steps,
// what is due on its own, and what outranks both.
#pragma once

#include "analysis/response_time.hpp"
#include "runtime-m4/policy/costs.hpp"
#include "vm/image.hpp"

namespace robosync::analysis {

// The most instructions that one call of an algorithm's module takes, as the firmware declares.
using ModuleCost = Instructions (*)(const vm::Image& image, const vm::Sensor& algorithm);

// For a verified image whose algorithms the firmware has. `cap`: the highest priority that an adapted behaviour can reach; 0:
// priorities stay as written.
[[nodiscard]] TaskSet task_set_of(const vm::Image& image, const policy::BoardCosts& board,
                                  ModuleCost module_cost, int cap = 0);

}  // namespace robosync::analysis
