// The template robots (templates.hpp) on a board that is named.
#pragma once

#include <string>
#include <string_view>

#include "rsc/templates.hpp"

namespace robosync::tool {

// The text of a file of a template; robot.json names `board`, unless it is empty.
[[nodiscard]] std::string text_on(std::string_view board, const TemplateFile& file);

// Why the template is not for this board: the first error of its program there. Empty: it is.
[[nodiscard]] std::string why_not_on(std::string_view board, const Template& robot);

// The template for this board: one that names it, or else the first that fits. Throws Failure (usage) if there is none.
[[nodiscard]] const Template& template_for(std::string_view board);

// Throws Failure (usage), with the names of those that fit, if this one does not.
void refuse_misfit(std::string_view board, const Template& robot);

}  // namespace robosync::tool
