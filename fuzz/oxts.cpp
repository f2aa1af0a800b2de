// KITTI's GPS/INS records.
#include "fovea/drive/kitti/oxts.h"

#include "fuzz_input.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static FileInMemory file;
  std::string_view text = as_text(data, size);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a file may begin with this mark
  const auto of_text = parse_oxts(text);
  const auto of_file = read_oxts(file.hold(as_text(data, size)));
  require(of_text.index() == of_file.index(), "a file is read as its text");
  if (const auto* record = std::get_if<OxtsRecord>(&of_file)) {
    require(record->R_enu_imu().allFinite(), "the orientation is finite");
    require(record->position_accuracy >= 0 && record->satellites.value_or(0) >= 0,
            "counts are positive");
  } else {
    require(!std::get<std::string>(of_file).empty(), "a record is refused with a reason");
  }
  return 0;
}
