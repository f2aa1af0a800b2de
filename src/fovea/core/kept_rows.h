// Some rows of a table of columns are kept, the others go.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fovea {

/// Mostly few rows go: those between two of them move up together, column by column.
class KeptRows {
 public:
  /// @param indices  ascending; must outlive this
  explicit KeptRows(std::span<const std::uint32_t> indices) : indices_(indices) {
    for (std::size_t k = 0; k < indices.size(); ++k) {
      if (k == 0 ? indices[k] != 0 : indices[k] != indices[k - 1] + 1) run_begins_.push_back(k);
    }
  }

  /// Leaves an empty column alone.
  template <class Value>
  void close_up(std::vector<Value>& column) const {
    if (column.empty()) return;
    for (std::size_t r = 0; r < run_begins_.size(); ++r) {
      const std::size_t begin = run_begins_[r];
      const std::size_t end = r + 1 < run_begins_.size() ? run_begins_[r + 1] : indices_.size();
      const auto from = column.begin() + indices_[begin];
      std::move(from, from + static_cast<std::ptrdiff_t>(end - begin),
                column.begin() + static_cast<std::ptrdiff_t>(begin));
    }
    column.resize(indices_.size());
  }

 private:
  std::span<const std::uint32_t> indices_;
  std::vector<std::size_t> run_begins_;  // where indices do not follow each other
};

}  // namespace fovea
