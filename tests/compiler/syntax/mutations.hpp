// One-word mutations of a program: what a slip of the hand or of the mind makes of it.
#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <vector>

namespace robosync::compiler::testing {

enum class Mutation { drop, repeat, swap, misspell, exchange };
inline constexpr Mutation every_mutation[] = {Mutation::drop, Mutation::repeat, Mutation::swap,
                                              Mutation::misspell, Mutation::exchange};

[[nodiscard]] std::string name_of(Mutation mutation);

// Changes one word of `program`, chosen by `random`. Texts in quotes are left alone.
[[nodiscard]] std::string mutate(const std::string& program, Mutation mutation,
                                 std::mt19937& random);
// Changes one string, number, word or sign of a JSON text; a string is misspelt between its quotes.
[[nodiscard]] std::string mutate_json(const std::string& text, Mutation mutation,
                                      std::mt19937& random);

}  // namespace robosync::compiler::testing
