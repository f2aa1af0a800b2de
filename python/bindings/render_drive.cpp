// Map.render_drive(): images, depth and scans of a map from any poses.
#include "fovea/rendering/render_drive.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/geometry/lidar_data_sheet.h"
#include "fovea/map/checked_map.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/run_watch.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

std::vector<RigidMotion> motions_of(const py::array_t<double>& poses) {
  if (poses.ndim() != 3) throw std::invalid_argument("the poses are an array of shape (N, 4, 4)");
  std::vector<RigidMotion> motions;
  for (const py::handle pose : poses) {
    motions.push_back(motion_from(py::cast<py::array_t<double>>(pose)));
  }
  return motions;
}

RenderFigures render_drive_in_python(const std::filesystem::path& map, RenderJob job,
                                     const py::array_t<double>& poses,
                                     const std::map<std::string, Camera>& cameras,
                                     const std::string& lidar, double rate, int threads) {
  if (!(rate >= 0.1 && rate <= 1000) || !(job.reach >= 1 && job.reach <= 1000)) {
    throw std::invalid_argument("rate is 0.1 to 1000 frames a second, reach 1 to 1000 m");
  }
  if (cameras.empty() && lidar.empty()) {
    throw std::invalid_argument("a drive needs cameras, a lidar, or both");
  }
  job.T_local_lidar = motions_of(poses);
  job.period = from_seconds(1 / rate);
  for (const auto& [name, camera] : cameras) {
    job.cameras.push_back({name, camera});
    job.cameras.back().camera.image_delay = 0;  // of its frame's own moment
  }
  const py::gil_scoped_release others_run;
  if (!lidar.empty()) job.lidar = lidar_pattern(parse_lidar_model(lidar));
  const CommandFiles files{
      .inputs = {map.string()}, .outputs = {}, .folder = {job.output.string()}};
  check_files(files);
  const ThreadLimit limit(threads);
  return render_drive(open_checked_map(map), job, [](int, int) {
    const py::gil_scoped_acquire running;
    raise_signals();
  });
}

}  // namespace

void bind_render_drive(py::module_& module) {
  py::class_<RenderFigures>(module, "RenderFigures", "What Map.render_drive() wrote.")
      .def_readonly("frames", &RenderFigures::frames)
      .def_readonly("covered", &RenderFigures::covered,
                    "Mean share of the images' pixels that show something.")
      .def_readonly("points", &RenderFigures::points, "Mean number of points of the scans.")
      .def_readonly("blank", &RenderFigures::blank, "Images without anything.")
      .def_readonly("empty", &RenderFigures::empty, "Scans without a point, which are not written.")
      .def("__repr__", [](const RenderFigures& self) {
        return "<fovea.RenderFigures: " + std::to_string(self.frames) + " frames>";
      });
  module.def(
      "_render_drive",
      [](const std::filesystem::path& map, const std::filesystem::path& output,
         const py::array_t<double>& poses, const std::map<std::string, Camera>& cameras,
         const std::string& lidar, double rate, double reach, const std::string& exposure,
         int threads, bool force) {
        RenderJob job;
        job.output = output;
        job.force = force;
        job.reach = reach;
        job.exposure = parse_exposure(exposure);
        return render_drive_in_python(map, std::move(job), poses, cameras, lidar, rate, threads);
      },
      "Map.render_drive()");
}

}  // namespace fovea::python
