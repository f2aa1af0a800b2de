// The configuration in TOML: whole files and single settings of the command line.
#include "fovea/pipeline/config.h"
#include "fuzz_input.h"

using namespace fovea;

namespace {

template <class Apply>
void fuzz(Apply&& apply) {
  MapperOptions options;
  if (!read_or_refuse<ConfigError>([&] { apply(options); })) return;
  const std::string resolved = to_toml(options);
  MapperOptions again;
  require(read_or_refuse<ConfigError>([&] { apply_config_text(resolved, "resolved", again); }),
          "the resolved configuration is read again");
  require(to_toml(again) == resolved, "the resolved configuration says the same");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = as_text(data, size);
  fuzz([&](MapperOptions& options) { apply_config_text(text, "input", options); });
  fuzz([&](MapperOptions& options) { apply_setting(text, options); });
  return 0;
}
