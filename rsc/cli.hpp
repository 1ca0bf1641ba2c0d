// The command line as a whole: verbs, help, did-you-mean, exit codes. Errors go to stderr, results
// to stdout.
#pragma once

namespace robosync::tool {

// Runs `rsc` and returns its exit code (failure.hpp).
[[nodiscard]] int run_command_line(int argument_count, const char* const* arguments);

// Prints the help of a verb to stdout; of the whole tool when `verb` is empty. Throws Failure
// (usage) when there is no such verb.
void print_help(const char* verb);

}  // namespace robosync::tool
