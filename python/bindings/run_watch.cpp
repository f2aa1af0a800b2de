#include "python/bindings/run_watch.h"

namespace fovea::python {
namespace py = pybind11;

void raise_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void RunWatch::call(const std::function<void()>& python) {
  if (raised_) return;
  const py::gil_scoped_acquire running;
  try {
    raise_signals();
    python();
  } catch (...) {
    raised_ = std::current_exception();
    stop_.request_stop();
  }
}

void RunWatch::rethrow(const std::string& error) const {
  if (!raised_) return;
  try {
    std::rethrow_exception(raised_);
  } catch (py::error_already_set& exception) {
    if (!error.empty()) exception.value().attr("add_note")("The run itself ended so: " + error);
    throw;
  }
}

}  // namespace fovea::python
