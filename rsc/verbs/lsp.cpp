// rsc lsp
#include <iostream>

#include <unistd.h>

#include "rsc/failure.hpp"
#include "rsc/lsp/stdio.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {

void add_lsp(Options& options) {
  options.runs([] {
    if (isatty(STDIN_FILENO) != 0)
      std::cerr << "rsc lsp talks to an editor, which starts it: see docs/editors.md\n";
    if (lsp::serve(STDIN_FILENO, STDOUT_FILENO) != 0) throw Failure(Exit::program, "");
  });
}

}  // namespace robosync::tool
