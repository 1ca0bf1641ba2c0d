// How much of their random work tests do under the sanitizers.
#pragma once

#include <cstdlib>
#include <string_view>

namespace robosync::test {

// The sanitizers make everything twenty times slower: a tenth of `count` then, unless
// ROBOSYNC_FULL_FUZZ=1 asks for all of it.
template <class Count>
Count share_of(Count count) {
#ifdef __SANITIZE_ADDRESS__
  const char* full = std::getenv("ROBOSYNC_FULL_FUZZ");
  return full != nullptr && std::string_view(full) == "1" ? count : count / 10;
#else
  return count;
#endif
}

}  // namespace robosync::test
