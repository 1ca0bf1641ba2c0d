// See page.hpp.
#include "rsc/timeline/page.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "rsc/escaped.hpp"
#include "rsc/json.hpp"

namespace robosync::tool {
namespace {

std::string in_html(std::string_view text) {
  return escaped(text, {{'<', "&lt;"}, {'&', "&amp;"}});
}

// Escapes a text so that it cannot end its HTML element.
std::string in_script(const Json& run) {
  return escaped(json_text(run), {{'<', "\\u003c"}});
}

}  // namespace

std::string timeline_page(const std::string& title, Json run,
                          const std::vector<std::string>& source) {
  run["source"] = source;
  const PageParts parts = page_parts();
  const std::array<std::pair<std::string_view, std::string>, 4> places = {
      {{"@TITLE@", in_html(title)},
       {"@STYLE@", std::string(parts.style.text())},
       {"@RUN@", in_script(run)},
       {"@SCRIPT@", std::string(parts.script.text())}}};
  std::string page;
  std::string_view rest = parts.html.text();
  for (const auto& [place, text] : places) {
    const std::size_t at = rest.find(place);
    page.append(rest.substr(0, at)).append(text);
    rest.remove_prefix(at + place.size());
  }
  return page.append(rest);
}

}  // namespace robosync::tool
