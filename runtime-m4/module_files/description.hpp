// What a module in a file says about itself, checked and copied: texts and lists are this object's own. Its functions are left for
// the caller to set (registry.cpp).
#pragma once

#include <array>
#include <deque>
#include <string>
#include <vector>

#include "runtime-m4/module_files/desk.hpp"

namespace robosync::module_files {

class Description {
public:
  explicit Description(const Described& said);
  Description(const Description&) = delete;
  Description& operator=(const Description&) = delete;

  // What does not comply with robosync_module.h; empty: everything does.
  const std::string& mistake() const { return mistake_; }

  const robosync_description& in_c() const { return in_c_; }
  robosync_module& module() { return module_; }
  const robosync_module& module() const { return module_; }
  Config usual() const;

private:
  const char* kept(const Name& name);
  void copy(const Described& said);
  void judge(const Described& said);
  void judge_name(const std::string& what, const Name& name);
  void judge_unit(const std::string& what, unsigned unit, bool may_be_any);
  void judge_output(const Described& said, const DescribedOutput& output);
  void add_mistake(const std::string& mistake);

  std::deque<std::string> texts_;
  std::vector<const char*> words_;
  std::array<robosync_input, ROBOSYNC_MOST_INPUTS> inputs_{};
  std::array<robosync_output, ROBOSYNC_MOST_OUTPUTS> outputs_{};
  std::array<robosync_parameter, ROBOSYNC_MOST_PARAMETERS> parameters_{};
  std::array<robosync_range, ROBOSYNC_MOST_PARAMETERS> ranges_{};
  robosync_module module_{};
  robosync_description in_c_{};
  std::string mistake_;
};

}  // namespace robosync::module_files
