// The template robots (templates.txt) with their files.
#pragma once

#include <span>
#include <string_view>

#include "compiler/source/embedded.hpp"

namespace robosync::tool {

struct TemplateFile {
  std::string_view name;
  compiler::EmbeddedText content;

  [[nodiscard]] std::string_view text() const { return content.text(); }
};

struct Template {
  std::string_view name;
  std::string_view scenario;  // one of its files
  std::string_view summary;   // what the robot does
  std::span<const TemplateFile> files;
};

[[nodiscard]] std::span<const Template> templates();

}  // namespace robosync::tool
