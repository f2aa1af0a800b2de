// Texts made of the settings' rows: the files config/default.toml and docs/settings.md.
#pragma once

#include <string>

#include "fovea/pipeline/settings_rows.h"

namespace fovea {

/// A mapper's settings in TOML, each with its default below its sentence.
std::string settings_listing(MapperKind mapper);

/// The page of the documentation, in Markdown.
std::string settings_page();

}  // namespace fovea
