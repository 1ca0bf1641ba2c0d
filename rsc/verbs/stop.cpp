// rsc stop --port P: all outputs go to their safe state and stay there, whatever is uploaded, until rsc resume.
#include <chrono>
#include <iostream>
#include <memory>
#include <string>

#include "rsc/device/client.hpp"
#include "rsc/device/transport.hpp"
#include "rsc/failure.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {

namespace {

constexpr std::chrono::milliseconds kAskOnce{300};

// Firmware of another release may answer nothing else.
std::string why_unanswered(Client& client, const Failure& failure) {
  try {
    client.expect_protocol(kAskOnce);
  } catch (const Failure& other) {
    return other.what();
  }
  return failure.what();
}

// Without a hello first, which a busy board may answer late; and while another rsc, such as a monitor, has the line.
void stop_board(const std::string& port) {
  const std::unique_ptr<Transport> transport = open_port(port, Sharing::at_once);
  Client client(*transport);
  try {
    client.stop();
  } catch (const Failure& failure) {
    throw Failure(failure.exit(),
                  followed_by(why_unanswered(client, failure),
                              "It may have stopped all the same: a busy board stops first and "
                              "answers later, and another rsc on this line may have taken the "
                              "answer"));
  }
}

}  // namespace

void add_stop(Options& options) {
  auto port = std::make_shared<std::string>();
  add_port_option(options, *port);
  options.runs([port] {
    stop_board(*port);
    std::cout << "stopped: all outputs are in their safe state until `rsc resume`\n";
  });
}

}  // namespace robosync::tool
