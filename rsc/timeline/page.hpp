// The page that shows a run: one HTML file that works offline.
#pragma once

#include <string>
#include <vector>

#include "compiler/source/embedded.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {

// The parts of the page, from this folder.
struct PageParts {
  compiler::EmbeddedText html, style, script;
};
[[nodiscard]] PageParts page_parts();

// `run`: from TimelineRecorder. `source`: the lines that the rules' line numbers refer to; may be empty.
[[nodiscard]] std::string timeline_page(const std::string& title, Json run,
                                        const std::vector<std::string>& source);

}  // namespace robosync::tool
