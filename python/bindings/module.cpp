// fovea._fovea: the compiled part of `import fovea`.
#include <pybind11/numpy.h>

#include <string>

#include "fovea/platform.h"
#include "python/bindings/bindings.h"

namespace fovea::python {
namespace {

/// pybind11 before 2.12 reads the types of NumPy 2 in the layout of NumPy 1: arrays would be wrong.
void check_numpy() {
#if PYBIND11_VERSION_HEX < 0x020C0000
  const auto version = pybind11::module_::import("numpy").attr("__version__").cast<std::string>();
  if (version.starts_with("1.")) return;
  throw pybind11::import_error("this build of fovea needs NumPy 1, not " + version +
                               ": pip install 'numpy<2', or install fovea with pip");
#endif
}

}  // namespace
}  // namespace fovea::python

PYBIND11_MODULE(_fovea, module) {
  using namespace fovea::python;
  check_numpy();
  // pybind11 imports NumPy at the first array, and then deadlocks if two threads make it.
  pybind11::detail::npy_api::get();
  module.attr("__version__") = fovea::version();
  bind_errors(module);
  bind_frame_record(module);
  bind_points(module);
  bind_map(module);
  bind_map_output(module);
  bind_motion(module);
  bind_drive(module);
  bind_drive_writer(module);
  bind_map_drive(module);
  bind_mapper(module);
  bind_evaluate(module);
  bind_localizer(module);
  bind_live_mapper(module);
  bind_stages(module);
  bind_registration(module);
  bind_view(module);
  bind_render_drive(module);
}
