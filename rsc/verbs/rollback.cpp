// rsc rollback --port P [--key FILE]: the robot goes back to the program that it kept before this one.
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "rsc/device/keeping.hpp"
#include "rsc/device/session.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {

void add_rollback(Options& options) {
  struct RollBackOptions {
    std::string port, key;
  };
  auto asked = std::make_shared<RollBackOptions>();
  add_port_option(options, asked->port);
  add_key_option(options, asked->key);
  options.runs([asked] {
    Session session(asked->port);
    session.client.use_key(asked->key);
    const link::HelloReply board = roll_back(session.client);
    std::cout << fmt::format("program {} runs again ({} bytes)\n", text_of(board.program_hash),
                             board.image_bytes);
  });
}

}  // namespace robosync::tool
