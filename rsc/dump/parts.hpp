// The parts of rsc dump: each is a text of whole lines with names resolved. Images must be
// verified.
#pragma once

#include <cstdint>
#include <string>

#include "rsc/dump/dump.hpp"
#include "vm/image.hpp"

namespace robosync::tool {

// Sensors, actuators, groups, verbs, words.
[[nodiscard]] std::string dump_wiring(const vm::Image& image);
// Variables, checks, timers, modifiers, constants.
[[nodiscard]] std::string dump_memory(const vm::Image& image);
// `length` instructions from word `start` on; blocks are indented and jumps show their target. Each
// source line is above its instructions, or its number next to them if its text is not known.
[[nodiscard]] std::string dump_code(const vm::Image& image, const SourceLines& source,
                                    std::size_t start, std::size_t length);

// "touch LEVEL" or "mood": what a number of an input means.
[[nodiscard]] std::string input_name(const vm::Image& image, std::size_t input);
[[nodiscard]] std::string actuator_names(const vm::Image& image, std::uint32_t mask);
// The label of a value, else the value with its unit.
[[nodiscard]] std::string shown_value(const vm::Image& image, const vm::Variable& variable,
                                      vm::Value value);

}  // namespace robosync::tool
