// Arguments and results of the stages: NumPy arrays as point clouds and back.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "python/bindings/columns.h"
#include "python/bindings/sensor_arrays.h"

namespace fovea::python {

/// Points as a cloud with the origin 0.
/// @throws std::invalid_argument  unless N x 3, finite and within 100 km
PointCloud checked_cloud(const Floats& points);

/// A mask of N points, 1 where the array is True.
/// @throws std::invalid_argument  for another shape
std::vector<std::uint8_t> mask_from(const Numbers<bool>& mask, std::size_t points);

/// @throws std::invalid_argument  that names the argument, unless low <= value <= high
void require_range(const char* name, double value, double low, double high);

/// The number of a word in a list of choices.
/// @throws std::invalid_argument  that names the argument and the choices
std::size_t choice_of(const char* name, const std::string& word,
                      const std::vector<std::string>& choices);

/// An array that owns the entries, N or N x 3. The caller may write to it.
template <class Entry>
pybind11::array array_of(
    std::vector<Entry> entries,
    const pybind11::dtype& type = pybind11::dtype::of<typename ColumnEntry<Entry>::Scalar>()) {
  constexpr int kWidth = ColumnEntry<Entry>::kWidth;
  std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(entries.size())};
  if (kWidth > 1) shape.push_back(kWidth);
  using Entries = std::vector<Entry>;
  auto held = std::make_unique<Entries>(std::move(entries));
  const void* const data = held->data();
  const pybind11::capsule base(held.get(), [](void* kept) { delete static_cast<Entries*>(kept); });
  static_cast<void>(held.release());  // the capsule has it now
  return {type, std::move(shape), data, base};
}

/// Of 0 and 1.
inline pybind11::array bool_array(std::vector<std::uint8_t> entries) {
  return array_of(std::move(entries), pybind11::dtype::of<bool>());
}

/// A class of fovea/_results.py.
inline pybind11::object result_class(const char* name) {
  return pybind11::module_::import("fovea._results").attr(name);
}

}  // namespace fovea::python
