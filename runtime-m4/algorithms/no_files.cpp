// A board has no modules in files.
#include "runtime-m4/algorithms/modules.hpp"

namespace robosync::algorithms {

const robosync_description* find_in_file(std::size_t) {
  return nullptr;
}

}  // namespace robosync::algorithms
