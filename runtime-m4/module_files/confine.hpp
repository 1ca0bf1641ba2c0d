// What the process of a module may ask of the operating system (Linux). Both calls hold for the rest of the process; the second
// one adds to the first. False when the system cannot be asked for that: then nothing of a module may run.
#pragma once

namespace robosync::module_files {

// Reads files and maps memory, as the loader does: no writing to files, no network, no other process.
[[nodiscard]] bool allow_loading();
// Reads and writes what is open already, and ends.
[[nodiscard]] bool allow_answers();

// What a process is ended with that asks for more.
extern const int kForbidden;

}  // namespace robosync::module_files
