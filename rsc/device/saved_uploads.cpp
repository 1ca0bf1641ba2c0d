// See saved_uploads.hpp. Errors in a program, files that cannot be read and the robot's refusals are printed, and the previous one
// keeps running: an editor may remove a file for a moment while it saves it.
#include "rsc/device/saved_uploads.hpp"

#include <iostream>

#include "rsc/failure.hpp"

namespace robosync::tool {

bool SavedUploads::work(Session* session) {
  if (session == nullptr || (!is_first_ && !saved_.changed())) return true;
  is_first_ = false;
  saved_.look_at(files_of_program(file_, how_));
  const auto tell = [](const Failure& failure) { std::cerr << "rsc: " << failure.what() << '\n'; };
  try {
    programs_.push_back(load_program(file_, how_));
  } catch (const Failure& failure) {
    tell(failure);
    return true;
  }
  try {
    upload_program(*session, programs_.back(), {});
  } catch (const Refused& refusal) {
    tell(refusal);
  } catch (const Failure& failure) {
    if (failure.exit() != Exit::program) throw;
    tell(failure);
  }
  return true;
}

const Program* SavedUploads::uploaded(const link::ProgramHash& hash) const {
  for (const Program& program : programs_)
    if (program.image().header->program_hash == hash) return &program;
  return nullptr;
}

}  // namespace robosync::tool
