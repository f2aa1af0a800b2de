// Rows that change one thing of the default preset: what each part gives, and why each default is
// what it is.
#pragma once

#include <string>
#include <vector>

#include "fovea/pipeline/mapper_options.h"

namespace fovea::paper {

struct Ablation {
  std::string name;                   ///< of the row: "no-bilinear", "tau-0.2"
  std::string part;                   ///< rows of one table have one part
  std::vector<std::string> settings;  ///< "key=value", over the default preset
  bool navigation_poses = false;      ///< --poses navigation: no refinement at all
};

/// In the order of the tables; parts follow each other.
const std::vector<Ablation>& ablations();

/// Null if there is none of this name.
const Ablation* find_ablation(const std::string& name);

}  // namespace fovea::paper
