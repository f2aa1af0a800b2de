// Formats: wiki.ros.org/camera_calibration_parsers; github.com/ethz-asl/kalibr/wiki/yaml-formats;
// github.com/PJLab-ADG/SensorsCalibration.
#include "fovea/drive/calibration_file.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <vector>

#include "fovea/core/input_file.h"
#include "fovea/core/printable.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

class CalibrationFile {
 public:
  explicit CalibrationFile(const std::filesystem::path& file) : name_(file.string()) {
    const std::vector<std::uint8_t> bytes = InputFile(file, kCalibrationFile).bytes();
    root_ = YAML::Load(std::string(bytes.begin(), bytes.end()));
  }

  LensCamera read(const std::string& camera) const {
    if (!root_.IsMap()) refuse("this is no calibration of a camera");
    if (root_["camera_matrix"]) return ros();
    for (const auto& entry : root_) {
      if (entry.second.IsMap() && entry.second["param"])
        return sensors_calibration(entry.second["param"]);
    }
    return kalibr(camera);
  }

  [[noreturn]] void refuse(
      const std::string& problem,
      const std::string& remedy =
          "give a file of ROS, Kalibr or SensorsCalibration, or state K and D") const {
    throw InputError(problem, name_, remedy);
  }

 private:
  LensCamera ros() const {
    const auto K = root_["camera_matrix"]["data"].as<std::vector<double>>();
    const YAML::Node D = root_["distortion_coefficients"]["data"];
    const auto model = root_["distortion_model"].as<std::string>("plumb_bob");
    return camera(K, root_["image_width"].as<int>(), root_["image_height"].as<int>(), model,
                  D ? D.as<std::vector<double>>() : std::vector<double>());
  }

  LensCamera sensors_calibration(const YAML::Node& param) const {
    std::vector<double> K, D;
    for (const YAML::Node& row : param["cam_K"]["data"]) {
      for (const YAML::Node& number : row) K.push_back(number.as<double>());
    }
    for (const YAML::Node& row : param["cam_dist"]["data"]) {
      for (const YAML::Node& number : row) D.push_back(number.as<double>());
    }
    return camera(K, param["img_dist_w"].as<int>(), param["img_dist_h"].as<int>(),
                  D.size() > 5 ? "rational_polynomial" : "plumb_bob", D);
  }

  LensCamera kalibr(const std::string& name) const {
    const YAML::Node chosen = chosen_camera(name);
    const auto model = chosen["camera_model"].as<std::string>();
    if (model != "pinhole") {
      refuse(fmt::format("the camera model '{:.40}' is not read", printable(model)),
             "calibrate with the models pinhole-radtan or pinhole-equi");
    }
    const auto f = chosen["intrinsics"].as<std::vector<double>>();
    const auto size = chosen["resolution"].as<std::vector<int>>();
    if (f.size() != 4 || size.size() != 2)
      refuse("intrinsics or resolution have not 4 and 2 numbers");
    return camera({f[0], 0, f[2], 0, f[1], f[3], 0, 0, 1}, size[0], size[1],
                  chosen["distortion_model"].as<std::string>("none"),
                  chosen["distortion_coeffs"].as<std::vector<double>>(std::vector<double>()));
  }

  YAML::Node chosen_camera(const std::string& name) const {
    std::map<std::string, YAML::Node> cameras;
    for (const auto& entry : root_) {
      if (entry.second.IsMap() && entry.second["camera_model"]) {
        cameras[entry.first.as<std::string>()] = entry.second;
      }
    }
    if (cameras.empty()) refuse("this is no calibration of a camera");
    if (name.empty() && cameras.size() == 1) return cameras.begin()->second;
    const auto found = cameras.find(name);
    if (found != cameras.end()) return found->second;
    refuse(name.empty() ? fmt::format("the file has {} cameras", cameras.size())
                        : fmt::format("the file has no camera '{:.40}'", name),
           "name one behind the file: \"camchain.yaml:cam0\"");
  }

  LensCamera camera(const std::vector<double>& K, int width, int height, const std::string& model,
                    const std::vector<double>& D) const {
    static const std::map<std::string, LensModel> kModels = {
        {"none", LensModel::kNone},
        {"plumb_bob", LensModel::kPlumbBob},
        {"radtan", LensModel::kPlumbBob},
        {"rational_polynomial", LensModel::kRationalPolynomial},
        {"equidistant", LensModel::kEquidistant},
        {"equi", LensModel::kEquidistant},
        {"fisheye", LensModel::kEquidistant}};
    const auto found = kModels.find(model);
    if (found == kModels.end()) {
      refuse(fmt::format("the distortion model '{:.40}' is not read", printable(model)),
             "calibrate with radtan (plumb_bob) or equidistant");
    }
    const auto coefficients = lens_coefficients(found->second, D);
    if (!coefficients)
      refuse(fmt::format("{} numbers are no coefficients of '{}'", D.size(), model));
    const bool is_pinhole =
        K.size() == 9 && K[1] == 0 && K[3] == 0 && K[6] == 0 && K[7] == 0 && K[8] == 1;
    if (!is_pinhole) refuse("the matrix is not fx 0 cx, 0 fy cy, 0 0 1");
    return {width, height, K[0], K[4], K[2], K[5], Lens(found->second, *coefficients)};
  }

  std::string name_;
  YAML::Node root_;
};

}  // namespace

LensCamera read_calibration_file(const std::filesystem::path& file, const std::string& camera) {
  try {
    return CalibrationFile(file).read(camera);
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("this is no calibration of a camera ({})", error.what()),
                     file.string(),
                     "give a file of ROS, Kalibr or SensorsCalibration, or state K and D");
  }
}

}  // namespace fovea
