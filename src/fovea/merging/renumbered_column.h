// Other numbers in the columns of a tile. Private to merging/.
#pragma once

#include <cstdint>
#include <utility>

#include "fovea/core/run_column.h"

namespace fovea {

/// Puts `number_of(value)` in the place of each value of a column.
template <class Value, class F>
void renumber(RunColumn<Value>& column, F&& number_of) {
  RunColumn<Value> renumbered;
  column.for_each_run([&](std::uint32_t begin, std::uint32_t end, Value value) {
    renumbered.push_back(static_cast<Value>(number_of(value)), end - begin);
  });
  column = std::move(renumbered);
}

/// A missing column means 0 for every point: writes it out.
inline void fill_with_zeros(std::size_t points, RunColumn<std::uint16_t>& column) {
  if (column.empty() && points > 0) column.push_back(0, static_cast<std::uint32_t>(points));
}

}  // namespace fovea
