// rsc help [VERB] [--man]
#include <iostream>
#include <memory>
#include <string>

#include "rsc/cli.hpp"
#include "rsc/failure.hpp"
#include "rsc/usage.hpp"
#include "rsc/verb.hpp"

namespace robosync::tool {

void add_help(Options& options) {
  auto verb = std::make_shared<std::string>();
  options.argument("VERB", *verb, "the verb to explain; without it, all are listed",
                   Options::Need::optional);
  auto man = std::make_shared<bool>(false);
  options.flag("--man", *man, "everything, as a man page");
  options.runs([verb, man] {
    if (*man && !verb->empty())
      throw Failure(Exit::usage,
                    "--man prints one page about all verbs: leave out `" + *verb + "`, or --man");
    if (*man)
      std::cout << manual_page(all_usage());
    else
      print_help(verb->c_str());
  });
}

}  // namespace robosync::tool
