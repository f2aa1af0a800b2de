// fovea._fovea: the compiled part of `import fovea`.
#include <pybind11/numpy.h>

#include "fovea/platform.h"
#include "python/bindings/bindings.h"

PYBIND11_MODULE(_fovea, module) {
  using namespace fovea::python;
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
}
