// See saved_uploads.hpp. A program that is wrong is said, and the one before
// runs on.
#include "rsc/device/saved_uploads.hpp"

#include <iostream>

#include "rsc/failure.hpp"

namespace robosync::tool {

bool SavedUploads::work(Session* session) {
  if (session == nullptr || (!is_first_ && !saved_.changed())) return true;
  is_first_ = false;
  saved_.look_at(files_of_program(file_, how_));
  try {
    upload_program(*session, load_program(file_, how_), {});
  } catch (const Failure& failure) {
    if (failure.exit() != Exit::program) throw;
    std::cerr << "rsc: " << failure.what() << '\n';
  }
  return true;
}

}  // namespace robosync::tool
