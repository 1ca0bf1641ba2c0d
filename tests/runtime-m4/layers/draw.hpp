// Random numbers for tests with random programs: the same with every library, since the engine is
// standardised and no distribution is used.
#pragma once

#include <cstddef>
#include <random>
#include <string>

namespace robosync::test {

class Draw {
public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  unsigned below(unsigned count) { return static_cast<unsigned>(engine_() % count); }
  bool one_in(unsigned count) { return below(count) == 0; }
  template <std::size_t kCount>
  std::string of(const char* const (&choices)[kCount]) {
    return choices[below(kCount)];
  }

private:
  std::mt19937 engine_;
};

}  // namespace robosync::test
