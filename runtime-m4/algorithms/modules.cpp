// See modules.hpp.
#include "runtime-m4/algorithms/modules.hpp"

#include <iterator>

namespace robosync::algorithms {
namespace {

constexpr const robosync_module* kModules[] = {
#define MODULE(name, doc) &name##_module,
#include "runtime-m4/algorithms/modules.def"
#undef MODULE
};

constexpr robosync_describe kDescribe[] = {
#define MODULE(name, doc) name##_describe,
#include "runtime-m4/algorithms/modules.def"
#undef MODULE
};

}  // namespace

const robosync_module* find_module(std::size_t number) {
  return number < std::size(kModules) ? kModules[number] : nullptr;
}

const robosync_description* find_description(std::size_t number) {
  return number < std::size(kDescribe) ? kDescribe[number](ROBOSYNC_ABI) : nullptr;
}

}  // namespace robosync::algorithms
