// The configuration in TOML: whole files, single settings of the command line, and files of earlier
// versions.
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/old_settings.h"
#include "fuzz_input.h"

using namespace fovea;

namespace {

template <class Apply>
void fuzz(Apply&& apply) {
  MapSettings settings;
  if (!read_or_refuse<ConfigError>([&] { apply(settings); })) return;
  const std::string resolved = to_toml(settings);
  MapSettings again;
  require(read_or_refuse<ConfigError>([&] { apply_config_text(resolved, "resolved", again); }),
          "the resolved configuration is read again");
  require(to_toml(again) == resolved, "the resolved configuration says the same");
}

void fuzz_conversion(std::string_view text) {
  std::string converted;
  if (!read_or_refuse<ConfigError>([&] { converted = convert_settings(text, "input"); })) return;
  MapSettings settings;
  require(read_or_refuse<ConfigError>([&] { apply_config_text(converted, "converted", settings); }),
          "a converted configuration is read");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = as_text(data, size);
  fuzz([&](MapSettings& settings) { apply_config_text(text, "input", settings); });
  fuzz([&](MapSettings& settings) { apply_setting(text, settings); });
  fuzz_conversion(text);
  return 0;
}
