// rsc lsp
#include <unistd.h>

#include "rsc/failure.hpp"
#include "rsc/lsp/stdio.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {

void add_lsp(Options& options) {
  options.runs([] {
    if (lsp::serve(STDIN_FILENO, STDOUT_FILENO) != 0) throw Failure(Exit::program, "");
  });
}

}  // namespace robosync::tool
