// rsc pair --port P [--key FILE]: a person next to the robot makes a key its owner.
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <sodium.h>

#include "rsc/device/owner_key.hpp"
#include "rsc/device/session.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {

void add_pair(Options& options) {
  struct PairOptions {
    std::string port, key;
  };
  auto asked = std::make_shared<PairOptions>();
  add_port_option(options, asked->port);
  add_key_option(options, asked->key);
  options.runs([asked] {
    const auto key = OwnerKey::read(key_file(asked->key));
    Session session(asked->port);
    link::Pair owner{};
    owner.key = key->public_key();
    randombytes_buf(owner.seed.data(), owner.seed.size());
    session.client.pair(owner);
    std::cout << fmt::format(
        "paired with the key {}: {} takes orders from nobody else now; rsc stop still works for "
        "everybody\n",
        id_of(owner.key), text_of(session.board.board));
  });
}

}  // namespace robosync::tool
