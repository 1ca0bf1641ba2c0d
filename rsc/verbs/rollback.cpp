// rsc rollback --port P: the robot goes back to the program that it kept before this one.
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
  auto port = std::make_shared<std::string>();
  add_port_option(options, *port);
  options.runs([port] {
    Session session(*port);
    const link::HelloReply board = roll_back(session.client);
    std::cout << fmt::format("program {:02x} runs again ({} bytes)\n",
                             fmt::join(board.program_hash, ""), board.image_bytes);
  });
}

}  // namespace robosync::tool
