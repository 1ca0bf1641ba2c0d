// rsc dump FILE|X.rsb [--config FILE] [-O0]
#include <iostream>
#include <memory>
#include <string>

#include "rsc/console.hpp"
#include "rsc/dump_text.hpp"
#include "rsc/program.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {
namespace {

struct Options {
  std::string file;
  CompileOptions how;
};

}  // namespace

void add_dump(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("FILE", options->file, "program (.rsl) or image (.rsb)")
      ->required()
      ->option_text(" ");
  add_compile_options(app, options->how);
  app.callback([options] {
    const Program program = load_program(options->file, options->how);
    std::cout << dump_text(program.image(), program.source());
  });
}

}  // namespace robosync::tool
