#include "compiler/sema/program.hpp"

#include <algorithm>

namespace robosync::compiler {

bool has_time_word(const Expression& expression) {
  return expression.operation >= Operation::held ||
         std::any_of(expression.operands.begin(), expression.operands.end(), has_time_word);
}

}  // namespace robosync::compiler
