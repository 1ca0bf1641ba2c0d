// Starts the kernel's tick (tick.cpp).
#pragma once

namespace robosync::port {

void start_tick();  // [init]

}  // namespace robosync::port
