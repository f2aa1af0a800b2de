#include "bench/bench_data.h"

#include <algorithm>
#include <variant>

#include "fovea/core/read_file.h"
#include "fovea/drive/frame_source.h"
#include "fovea/errors.h"
#include "fovea/simulation/simulate.h"
#include "tests/temporary_folder.h"
#include "tools/paper/upsampling_times.h"

namespace fovea::bench {
namespace {

namespace fs = std::filesystem;
constexpr int kScansBefore = 20;

BenchData data_of(const fs::path& folder) {
  const auto drive = open_drive(folder, {});
  BenchData data{
      paper::scan_in_view(*drive), drive->info().calibration.cameras.at(0), {}, drive->info(), {}};
  const fs::path images =
      drive->info().path / ("image_0" + std::to_string(data.camera.index)) / "data";
  const NumberedFiles files = list_numbered_files(images, {".png"});
  if (files.empty()) {
    throw InputError("the drive has no PNG image", images.string(), "give a KITTI raw drive");
  }
  data.png = read_bytes(files.begin()->second);
  const int last = (drive->info().begin + drive->info().end) / 2;
  for (int k = std::max(drive->info().begin, last - kScansBefore); k <= last; ++k) {
    LoadedFrame frame = drive->load(k);
    if (!std::holds_alternative<Frame>(frame)) continue;
    data.frames.push_back(std::move(std::get<Frame>(frame)));
  }
  return data;
}

}  // namespace

BenchData load_bench_data(const std::string& drive) {
  if (!drive.empty()) return data_of(drive);
  const TemporaryFolder folder;
  SimulationOptions options;
  options.frames = 3;
  return data_of(simulate(options, folder / "drive"));
}

}  // namespace fovea::bench
