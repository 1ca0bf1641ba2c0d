// What a module's process may ask of the operating system (Linux). Both calls apply for the rest of the process, and the second
// restricts it further. False if the system cannot enforce this: then no code of a module may run.
#pragma once

namespace robosync::module_files {

// Allows reading files and mapping memory, as the loader does: no writing to files, no network, no other processes.
[[nodiscard]] bool allow_loading();
// Allows reading and writing what is already open, and ending.
[[nodiscard]] bool allow_answers();

// The signal that ends a process that asks for more.
extern const int kForbidden;

}  // namespace robosync::module_files
