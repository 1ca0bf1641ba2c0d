// What mutation starts from: the images of a folder, each as it is, and, small enough to be quick,
// each of its behaviours by itself.
#pragma once

#include <string>

#include "tests/fuzz/mutator.hpp"

namespace robosync::fuzz {

struct Seeds {
  std::vector<Seed> whole;
  std::vector<Seed> carved;
};

// Every *.rsb in `folder`, in the order of their names, and the companion of tests/vm. Throws
// std::runtime_error where there is none, or one that the verifier refuses.
[[nodiscard]] Seeds load_seeds(const std::string& folder);

}  // namespace robosync::fuzz
