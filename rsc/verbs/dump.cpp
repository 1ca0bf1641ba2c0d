// rsc dump X.rsb
#include <iostream>
#include <memory>
#include <string>

#include "rsc/dump_text.hpp"
#include "rsc/files.hpp"
#include "rsc/program.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {

void add_dump(CLI::App& app) {
  auto file = std::make_shared<std::string>();
  app.add_option("FILE", *file, "image (.rsb)")->required()->option_text(" ");
  app.callback([file] {
    const Program program(read_bytes(*file), *file);
    std::cout << dump_text(program.image());
  });
}

}  // namespace robosync::tool
