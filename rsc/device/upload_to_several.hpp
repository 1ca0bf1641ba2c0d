// rsc upload to several robots at the same time: a thread for each, and one table or one JSON array.
#pragma once

#include "rsc/device/robot_upload.hpp"
#include "rsc/program.hpp"

namespace robosync::tool {

// To all of options.ports, which are different lines. One robot's trouble stops no other. Throws Failure, with the highest of
// the exit codes that they would have given one by one, when the program does not run on all of them.
void upload_to_several(const SendOptions& options, const Program& program);

}  // namespace robosync::tool
