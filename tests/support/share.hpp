// How much of their random work tests do under the sanitizers.
#pragma once

#include <cstdlib>
#include <string_view>

namespace robosync::test {

// The sanitizers make everything twenty times slower: a tenth of the work then, unless ROBOSYNC_FULL_FUZZ=1 asks for all
// of it. What is counted over all of it (a rate, how many were seen) the build without sanitizers holds against its bar.
inline bool whole() {
#ifdef __SANITIZE_ADDRESS__
  const char* full = std::getenv("ROBOSYNC_FULL_FUZZ");
  return full != nullptr && std::string_view(full) == "1";
#else
  return true;
#endif
}

template <class Count>
Count share_of(Count count) {
  return whole() ? count : count / 10;
}

// For work that is a list: is the one with this number, counted from 0, in the share?
template <class Number>
bool in_share(Number number) {
  return whole() || number % 10 == 0;
}

}  // namespace robosync::test
