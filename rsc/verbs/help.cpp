// rsc help [VERB]
#include <memory>
#include <string>

#include "rsc/cli.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {

void add_help(CLI::App& app) {
  auto verb = std::make_shared<std::string>();
  app.add_option("VERB", *verb, "the verb to explain; without it, all are listed")
      ->option_text(" ");
  app.callback([verb] { print_help(verb->c_str()); });
}

}  // namespace robosync::tool
