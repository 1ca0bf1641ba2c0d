// What a target demands: libFuzzer counts an abort() as a finding, and keeps its input.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace robosync::fuzz {

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

}  // namespace robosync::fuzz
