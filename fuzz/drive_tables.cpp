// The tables of a drive: poses, positions, orientations. The first byte says which the rest is.
#include <fstream>

#include "fovea/drive/navigation/generic_navigation.h"
#include "fovea/drive/scans/csv_rows.h"
#include "fuzz_input.h"
#include "scratch_folder.h"

using namespace fovea;

namespace {

void write(const std::filesystem::path& file, std::string_view text) {
  std::ofstream(file, std::ios::binary) << text;
}

void check(const GenericNavigation& navigation) {
  if (!navigation.T_local_lidar) return;
  const auto& poses = navigation.T_local_lidar->poses();
  require(navigation.accuracy.size() == poses.size(), "each pose has an accuracy");
  for (const double accuracy : navigation.accuracy) require(accuracy >= 0, "accuracies are known");
  for (const StampedPose& pose : poses) {
    require(pose.T_local_body.matrix().allFinite(), "poses are finite");
    require(is_rotation(pose.T_local_body.linear(), 1e-6), "poses turn by rotations");
  }
  if (navigation.origin)
    require(std::abs(navigation.origin->latitude) <= 90, "origins are on earth");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder folder;
  if (size == 0) return 0;
  folder.clear();
  const std::string_view text = as_text(data + 1, size - 1);
  switch (data[0] % 3) {
    case 0:
      write(folder / "poses.csv", text);
      break;
    case 1:
      write(folder / "gnss.csv", text);
      break;
    default:
      write(folder / "gnss.csv",
            "time_ns,latitude,longitude,altitude\n1000000000,49,8.4,100\n1100000000,49.00001,8.4,"
            "100\n");
      write(folder / "imu.csv", text);
  }
  const bool has_scans = (data[0] & 0x80) != 0;
  const auto scans =
      has_scans ? std::optional(ScanPeriod{1'000'000'000, 2'000'000'000}) : std::nullopt;
  read_or_refuse([&] { check(read_generic_navigation(folder.path(), {}, 1'000'000'000, scans)); });

  constexpr std::array<CsvColumn, 1> kColumns = {{{"index", false}}};
  static FileInMemory file;
  read_or_refuse([&] {
    CsvRows rows = read_csv(file.hold(text), kColumns);
    std::vector<std::string> notes;
    if (has_scans) set_scan_time_unit(rows, "stamps.csv", notes);
    rows.drop_out_of_order();
    require(rows.lines.size() == rows.size() && rows.values.size() == rows.size(),
            "rows are whole");
    for (std::size_t i = 1; i < rows.size(); ++i) {
      require(rows.times[i - 1] < rows.times[i], "times increase");
    }
  });
  return 0;
}
