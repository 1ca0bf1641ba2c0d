#include "compiler/project.hpp"

#include "compiler/modules.hpp"
#include "compiler/reading.hpp"

namespace robosync::compiler {

query::Project project_of(const Result& result) {
  static const Robot nothing_known;
  const Reading& reading = *result.reading;
  query::Project project{result.sources, reading.trees(),
                         reading.robot ? *reading.robot : nothing_known};
  for (const ModuleText& module : module_texts())
    project.library.push_back({module.name, module.text});
  return project;
}

}  // namespace robosync::compiler
