#include "tests/runtime-m4/boards/registers.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include "runtime-m4/port/cortex-m4/register.hpp"

namespace {

robosync::tests::RegisterModel* model = nullptr;

constexpr std::uint32_t kFirst = 0x2000'0000, kBetween = 0x100;
std::vector<const volatile void*> told;  // the first is at kFirst, and so on

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

std::uint32_t robosync::port::bus_address(const volatile void* memory) {
  told.push_back(memory);
  return kFirst + kBetween * static_cast<std::uint32_t>(told.size() - 1);
}

void robosync::tests::no_register(std::uintptr_t address) {
  throw std::runtime_error("the model has no register at " + std::to_string(address));
}

void robosync::tests::demand(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

const volatile void* robosync::tests::memory_at(std::uint32_t bus_address) {
  const std::uint32_t index = (bus_address - kFirst) / kBetween;
  if ((bus_address - kFirst) % kBetween != 0 || index >= told.size())
    throw std::runtime_error("a peripheral reads memory that nobody has told it");
  return told[index];
}
