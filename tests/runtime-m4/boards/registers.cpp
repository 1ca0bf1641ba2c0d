#include "tests/runtime-m4/boards/registers.hpp"

#include "runtime-m4/port/cortex-m4/register.hpp"

namespace {

robosync::tests::RegisterModel* model = nullptr;

}  // namespace

robosync::tests::RegisterModel::RegisterModel() {
  model = this;
}

robosync::tests::RegisterModel::~RegisterModel() {
  model = nullptr;
}

std::uint32_t robosync::port::read_register(std::uintptr_t address) {
  return model->read(address);
}

void robosync::port::write_register(std::uintptr_t address, std::uint32_t value) {
  model->write(address, value);
}
