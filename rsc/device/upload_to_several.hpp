// rsc upload to several robots at the same time: a thread for each, and one table or one JSON array.
#pragma once

#include "rsc/device/robot_upload.hpp"
#include "rsc/program.hpp"

namespace robosync::tool {

// Uploads to all of options.ports, which are different lines. A failure of one robot does not stop the others. Throws
// Failure, with the highest exit code of the single uploads, if the program does not run on all of them.
void upload_to_several(const SendOptions& options, const Program& program);

}  // namespace robosync::tool
