// Keys of earlier versions: errors that name the new key, and the conversion of old files.
#pragma once

#include <string>
#include <string_view>

#include "fovea/pipeline/settings_rows.h"

namespace fovea {

/// ConfigError whose place is the key, for a key of an earlier version or of the other mapper;
/// nothing for a key that no version has.
void explain_unknown_key(MapperKind mapper, std::string_view key);

/// A configuration of an earlier version in today's keys; comments name the keys that have no
/// counterpart. Text in today's keys comes back with the same settings.
///
/// The text is for the paper mapper if it says so, or if its values or keys are those of the paper.
/// @param name  stands for the file in errors
/// ConfigError for a key that no version has, and for a value that is not allowed.
std::string convert_settings(std::string_view text, std::string_view name);

/// All keys of earlier versions with the new key or the value, in Markdown.
std::string old_keys_table();

}  // namespace fovea
