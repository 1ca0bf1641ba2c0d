// Puts a program on a board, and says in words why it cannot be done.
#pragma once

#include "rsc/program.hpp"
#include "rsc/session.hpp"
#include "rsc/uploader.hpp"

namespace robosync::tool {

// Uploads `program` without its source lines. Throws Failure: as upload(), and (program) when the
// board cannot run it or refuses it.
UploadResult upload_program(Session& session, const Program& program, const UploadOptions& options);

}  // namespace robosync::tool
