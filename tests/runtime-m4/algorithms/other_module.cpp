#include "tests/runtime-m4/algorithms/other_module.hpp"

namespace robosync::test {
namespace {

const robosync_module* other = nullptr;

}  // namespace

OtherModule::OtherModule(const robosync_module& module) {
  other = &module;
}

OtherModule::~OtherModule() {
  other = nullptr;
}

const robosync_module* real_find_module(std::size_t number) __asm__(
    "__real__ZN8robosync10algorithms11find_moduleEm");
const robosync_module* wrapped_find_module(std::size_t number) __asm__(
    "__wrap__ZN8robosync10algorithms11find_moduleEm");
const robosync_module* wrapped_find_module(std::size_t number) {
  return number == 0 && other != nullptr ? other : real_find_module(number);
}

}  // namespace robosync::test
