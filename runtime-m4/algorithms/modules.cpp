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
static_assert(std::size(kModules) <= kFirstInFile);

}  // namespace

const robosync_module* find_module(std::size_t number) {
  if (number < std::size(kModules)) return kModules[number];
  const robosync_description* const in_file = find_in_file(number);
  return in_file != nullptr ? in_file->module : nullptr;
}

const robosync_description* find_description(std::size_t number) {
  return number < std::size(kDescribe) ? kDescribe[number](ROBOSYNC_ABI) : find_in_file(number);
}

}  // namespace robosync::algorithms
