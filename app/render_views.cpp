#include "app/render_views.h"

#include <CLI/Error.hpp>
#include <sstream>

namespace fovea::app {
namespace {

/// "1,2,3"; CLI::ValidationError for anything else.
Eigen::Vector3d parse_place(const std::string& text, const char* option) {
  Eigen::Vector3d place;
  char comma1 = 0, comma2 = 0, more = 0;
  std::istringstream in(text);
  in >> place.x() >> comma1 >> place.y() >> comma2 >> place.z();
  if (!in || comma1 != ',' || comma2 != ',' || in >> more || !place.allFinite()) {
    throw CLI::ValidationError(option, "a place in the map's local frame, m: X,Y,Z");
  }
  return place;
}

}  // namespace

FreeView parse_free_view(const std::string& from_text, const std::string& to_text) {
  const FreeView view{parse_place(from_text, "--from"), parse_place(to_text, "--to")};
  if (view.from == view.to) throw CLI::ValidationError("--to", "another place than --from");
  return view;
}

}  // namespace fovea::app
