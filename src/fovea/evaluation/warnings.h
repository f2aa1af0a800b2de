// What in a report says that its best figures are not what they seem (docs/method.md 7): plays
// against single figures, planted or by mistake, leave their marks on others.
#pragma once

#include <string>
#include <vector>

#include "fovea/evaluation/report.h"

namespace fovea {

/// A sentence for each, in a fixed order: held-out protocols only, because in-sample figures are no
/// measure of quality anyway.
std::vector<std::string> warnings(const EvaluationReport& report);

}  // namespace fovea
