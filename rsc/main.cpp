// rsc: the tool.
#include "rsc/cli.hpp"

int main(int argument_count, char** arguments) {
  return robosync::tool::run_command_line(argument_count, arguments);
}
