// The page's own files (page.html, page.css, page.js), built into the program.
#pragma once

#include <string_view>

namespace fovea::app {

extern const std::string_view kPageHtml, kPageCss, kPageJs;

}  // namespace fovea::app
