// What a simulated drive says is true. Parts with "---" between them: truth.json, poses, exposures
// of a camera, true returns.
#include <fstream>

#include "fovea/drive/drive_truth.h"
#include "fuzz_input.h"
#include "scratch_folder.h"

using namespace fovea;

namespace {

constexpr std::array kFiles{"truth/truth.json", "truth/poses.txt", "truth/image_02/exposure.txt",
                            "truth/velodyne_points/0000000000.bin"};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder drive;
  for (const char* name : kFiles) std::filesystem::create_directories((drive / name).parent_path());
  std::string_view text = as_text(data, size);
  for (const char* name : kFiles) {
    constexpr std::string_view kBetween = "---\n";
    const std::size_t end = text.find(kBetween);
    std::ofstream(drive / name, std::ios::binary) << text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + kBetween.size());
  }
  std::filesystem::copy_file(drive / "truth/poses.txt", drive / "truth/image_02/poses.txt",
                             std::filesystem::copy_options::overwrite_existing);
  read_or_refuse([&] {
    const DriveTruth truth(drive.path());
    require(truth.T_local_lidar().size() == static_cast<std::size_t>(truth.frames()),
            "a frame has a pose");
    for (const int number : truth.camera_numbers()) {
      require(truth.camera(number).exposure.size() == truth.T_local_lidar().size(),
              "a frame has an exposure");
    }
    for (const TrueReturn& hit : truth.returns(0)) {
      require(hit.hit_lidar.allFinite(), "returns are finite");
    }
  });
  return 0;
}
