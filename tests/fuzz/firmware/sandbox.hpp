// Runs a function on the board without privileges, behind the MPU: it may write the frame, the
// timer memory, the output, its stack and the job it is given, read the image besides, and execute
// the firmware. Every other access faults, and a fault ends the test as failed.
//
// Each piece of memory ends where its MPU region ends, so that the first word behind it faults; it
// begins where an eighth of the region begins, because that is how fine the MPU is.
#pragma once

#include <cstddef>
#include <cstdint>

namespace robosync::fuzz {

enum class Zone : std::uint8_t { frame, timer_memory, output, image, count_ };

// Gives the zone `size` bytes, a multiple of 4; their address.
std::byte* open_zone(Zone zone, std::size_t size);

// Where jobs are; the function's stack grows down from there.
inline constexpr std::uintptr_t kJobs = 0x20003000;
// Runs function(job) without privileges. `job` is at kJobs.
void run_unprivileged(void (*function)(void*), void* job);

// Switches on the MPU and the fault handlers.
void start_sandbox();

// Writes or reads one word without privileges; true when that faulted.
bool traps_write(std::uintptr_t address);
bool traps_read(std::uintptr_t address);
// Writes, and expects nothing.
void stray_write(std::uintptr_t address);

void print(const char* text);
void print(std::uint32_t number);

}  // namespace robosync::fuzz
