// Uploads a program to the watched board at the start, and again whenever one of its
// files is saved.
#pragma once

#include <list>
#include <string>
#include <utility>

#include "rsc/device/uploader.hpp"
#include "rsc/device/viewer.hpp"
#include "rsc/saved_files.hpp"

namespace robosync::tool {

class SavedUploads final : public Viewer {
public:
  SavedUploads(std::string file, CompileOptions how)
      : file_(std::move(file)), how_(std::move(how)) {}

  bool work(Session* session) override;
  [[nodiscard]] const Program* uploaded(const link::ProgramHash& hash) const override;

private:
  std::string file_;
  CompileOptions how_;
  SavedFiles saved_;
  std::list<Program> programs_;  // all uploaded so far, one for each save
  bool is_first_ = true;
};

}  // namespace robosync::tool
