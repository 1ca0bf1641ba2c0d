#include "compiler/codegen/frame.hpp"

#include <algorithm>
#include <iterator>

namespace robosync::compiler {

Cell Frame::read(std::uint32_t input) {
  read_.insert(input);
  return {Zone::input, input};
}

Cell Frame::write(std::uint32_t input) {
  written_.insert(input);
  return read(input);
}

Cell Frame::add_local() {
  return {Zone::local, locals_++};
}

Cell Frame::add_watch() {
  return {Zone::watch, watches_++};
}

Cell Frame::temporary(std::uint32_t depth) {
  temporaries_ = std::max(temporaries_, depth + 1);
  return {Zone::temporary, depth};
}

std::vector<std::uint32_t> Frame::inputs() const {
  std::vector<std::uint32_t> inputs(written_.begin(), written_.end());
  std::set_difference(read_.begin(), read_.end(), written_.begin(), written_.end(),
                      std::back_inserter(inputs));
  return inputs;
}

std::size_t Frame::cells() const {
  return read_.size() + locals_ + watches_ + temporaries_;
}

CodeObject Frame::resolve(const CodeDraft& code) const {
  const std::vector<std::uint32_t> order = inputs();
  const auto locals = static_cast<std::uint32_t>(order.size());
  const auto place = [&](const Operand& operand) -> std::uint32_t {
    if (!operand.zone) return operand.value;
    switch (*operand.zone) {
      case Zone::input:
        return static_cast<std::uint32_t>(std::find(order.begin(), order.end(), operand.value) -
                                          order.begin());
      case Zone::local:
        return locals + operand.value;
      case Zone::watch:
        return locals + locals_ + operand.value;
      case Zone::temporary:
        break;
    }
    return locals + locals_ + watches_ + operand.value;
  };
  CodeObject object;
  object.words.reserve(code.size());
  for (const Instruction& instruction : code.instructions()) {
    const auto& [a, b, c] = instruction.operands;
    object.words.push_back(vm::encode(instruction.opcode, place(a), place(b), place(c)));
  }
  object.marks = code.marks();
  return object;
}

}  // namespace robosync::compiler
