// rsc keygen [--key FILE]
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "rsc/device/owner_key.hpp"
#include "rsc/verb.hpp"
#include "rsc/verb_options.hpp"

namespace robosync::tool {

void add_keygen(Options& options) {
  auto file = std::make_shared<std::string>();
  add_key_option(options, *file);
  options.runs([file] {
    const std::filesystem::path where = key_file(*file);
    const auto key = OwnerKey::make(where);
    std::cout << fmt::format(
        "{} is your key {}\n"
        "keep a copy where nobody else can reach it: a robot paired with it takes orders from no "
        "other key\n"
        "next: rsc pair --port PORT, in the first minute after the robot was switched on\n",
        where.string(), id_of(key->public_key()));
  });
}

}  // namespace robosync::tool
