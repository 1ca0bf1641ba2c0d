// See saved_files.hpp. Editors overwrite a file or replace it; its time or size shows both.
#include "rsc/saved_files.hpp"

#include <system_error>

#include "rsc/failure.hpp"
#include "rsc/files.hpp"

namespace robosync::tool {
namespace fs = std::filesystem;

std::vector<std::string> files_of_program(const std::string& file, const CompileOptions& how) {
  std::vector<std::string> files = {file};
  for (const fs::path& place : places_of_configuration(file, how.config))
    files.push_back(place.string());
  try {
    for (const std::string& name : names_of(compile_file(file, how).sources))
      files.push_back(name);
  } catch (const Failure&) {
    // A file is missing, or the program is an image.
  }
  return files;
}

void SavedFiles::look_at(const std::vector<std::string>& files) {
  files_.clear();
  changed_.reset();
  for (const std::string& file : files)
    if (!file.empty()) files_[file] = facts_of(file);
}

bool SavedFiles::changed() {
  constexpr std::chrono::milliseconds kMoment{150};
  const auto now = std::chrono::steady_clock::now();
  for (auto& [file, known] : files_) {
    const Facts facts = facts_of(file);
    if (facts != known) changed_ = now;
    known = facts;
  }
  if (!changed_ || now - *changed_ < kMoment) return false;
  changed_.reset();
  return true;
}

SavedFiles::Facts SavedFiles::facts_of(const std::string& file) {
  std::error_code error;
  Facts facts;
  facts.time = fs::last_write_time(file, error);
  if (error) return {};
  facts.bytes = fs::file_size(file, error);
  return facts;
}

}  // namespace robosync::tool
