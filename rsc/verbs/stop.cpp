// rsc stop --port P: all outputs go to their safe state and stay there, whatever is uploaded, until rsc resume.
#include <iostream>
#include <memory>
#include <string>

#include "rsc/device/session.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {

void add_stop(Options& options) {
  auto port = std::make_shared<std::string>();
  add_port_option(options, *port);
  options.runs([port] {
    Session session(*port);
    session.client.stop();
    std::cout << "stopped: all outputs are in their safe state until `rsc resume`\n";
  });
}

}  // namespace robosync::tool
