// What module.cpp puts together, a function a file.
#pragma once

#include <pybind11/pybind11.h>

namespace fovea::python {

void bind_errors(pybind11::module_& module);
void bind_frame_record(pybind11::module_& module);
void bind_points(pybind11::module_& module);
void bind_map(pybind11::module_& module);
void bind_map_output(pybind11::module_& module);
void bind_render_drive(pybind11::module_& module);
void bind_drive(pybind11::module_& module);
void bind_motion(pybind11::module_& module);
void bind_stages(pybind11::module_& module);
void bind_registration(pybind11::module_& module);
void bind_view(pybind11::module_& module);
void bind_camera(pybind11::module_& module);
void bind_frame(pybind11::module_& module);
void bind_drive_writer(pybind11::module_& module);
void bind_map_drive(pybind11::module_& module);
void bind_mapper(pybind11::module_& module);
void bind_evaluate(pybind11::module_& module);
void bind_localizer(pybind11::module_& module);
void bind_live_mapper(pybind11::module_& module);

}  // namespace fovea::python
