// rsc resume --port P: ends a stop. What SAFETY rules of the program halt stays halted.
#include <iostream>
#include <memory>
#include <string>

#include "rsc/device/session.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {

void add_resume(Options& options) {
  auto port = std::make_shared<std::string>();
  add_port_option(options, *port);
  options.runs([port] {
    Session session(*port);
    session.client.resume();
    std::cout << "resumed\n";
  });
}

}  // namespace robosync::tool
