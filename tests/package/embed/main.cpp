// Compiles a program that somebody has in a string: prints what is wrong with it, or how long its image is.
#include <iostream>

#include "compiler/compiler.hpp"
#include "compiler/diagnostics/render.hpp"

int main(int, char** arguments) {
  using namespace robosync::compiler;
  const Result result = compile({"robot.rsl", arguments[1]}, {"robot.json", arguments[2]});
  std::cout << render_human(result.diagnostics, result.sources, false);
  std::cout << result.image.size() << " bytes\n";
  return result.diagnostics.errors() == 0 ? 0 : 1;
}
