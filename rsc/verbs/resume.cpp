// rsc resume --port P [--key FILE]: ends a stop. Actuators that SAFETY rules halt stay halted.
#include <iostream>
#include <memory>
#include <string>

#include "rsc/device/session.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {

void add_resume(Options& options) {
  struct ResumeOptions {
    std::string port, key;
  };
  auto asked = std::make_shared<ResumeOptions>();
  add_port_option(options, asked->port);
  add_key_option(options, asked->key);
  options.runs([asked] {
    Session session(asked->port);
    session.client.use_key(asked->key);
    session.client.resume();
    std::cout << "resumed\n";
  });
}

}  // namespace robosync::tool
