// rsc unpair --port P [--key FILE]: the owner gives the robot up.
#include <iostream>
#include <memory>
#include <string>

#include "rsc/device/session.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {

void add_unpair(Options& options) {
  struct UnpairOptions {
    std::string port, key;
  };
  auto asked = std::make_shared<UnpairOptions>();
  add_port_option(options, asked->port);
  add_key_option(options, asked->key);
  options.runs([asked] {
    Session session(asked->port);
    session.client.use_key(asked->key);
    session.client.unpair();
    std::cout << "not paired: anyone on this line can give the robot orders\n";
  });
}

}  // namespace robosync::tool
