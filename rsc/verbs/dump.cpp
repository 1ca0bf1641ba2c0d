// rsc dump FILE|X.rsb [--config FILE] [-O0]
#include "rsc/dump/dump.hpp"

#include <iostream>
#include <memory>
#include <string>

#include "rsc/program.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {
namespace {

struct DumpOptions {
  std::string file;
  CompileOptions how;
};

}  // namespace

void add_dump(Options& options) {
  auto asked = std::make_shared<DumpOptions>();
  options.argument("FILE", asked->file, "program (.rsl) or image (.rsb)", Options::Need::required);
  add_compile_options(options, asked->how);
  options.runs([asked] {
    const Program program = load_program(asked->file, asked->how);
    std::cout << dump_text(program.image(), program.source());
  });
}

}  // namespace robosync::tool
