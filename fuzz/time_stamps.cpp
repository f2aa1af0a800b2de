// KITTI's time stamps, both forms.
#include "fovea/drive/time_stamps.h"

#include <algorithm>

#include "fovea/core/text_encoding.h"
#include "fuzz_input.h"

using namespace fovea;

namespace {

void check(const TimeStamps& stamps, std::string_view text) {
  const auto lines =
      std::count(text.begin(), text.end(), '\n') + (text.empty() || text.back() == '\n' ? 0 : 1);
  require(std::ssize(stamps.times) == lines, "there is an entry a line");
  std::optional<TimeNs> last;
  for (const std::optional<TimeNs>& time : stamps.times) {
    require(!time || !last || *time > *last, "times increase");
    if (time) last = time;
  }
  const std::optional<double> period = median_period(stamps);
  require(!period || *period > 0, "the period is positive");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static FileInMemory file;
  const std::string_view text = as_text(data, size);
  const std::filesystem::path& path = file.hold(text);
  read_or_refuse([&] { check(read_date_times(path), without_byte_order_mark(text, "text")); });
  read_or_refuse([&] { check(read_seconds(path), without_byte_order_mark(text, "text")); });
  return 0;
}
