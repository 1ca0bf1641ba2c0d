// rsc help [VERB]
#include <memory>
#include <string>

#include "rsc/cli.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {

void add_help(Options& options) {
  auto verb = std::make_shared<std::string>();
  options.argument("VERB", *verb, "the verb to explain; without it, all are listed",
                   Options::Need::optional);
  options.runs([verb] { print_help(verb->c_str()); });
}

}  // namespace robosync::tool
