// A drive with moves of its submaps, and a map job, for tests of map_drive().
#pragma once

#include <gtest/gtest.h>

#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/map_store.h"
#include "fovea/pipeline/map_drive.h"
#include "fovea/pipeline/mapper_test_support.h"

namespace fovea {

/// A drive with moves of its submaps; one frame may not be readable.
class BrokenDrive : public SyntheticDrive {
 public:
  int error_at = -1;
  TimeNs shift = 0;  ///< of all stamps
  std::optional<TimeNs> stamp(int index) const override { return stamp_of(index) + shift; }
  BrokenDrive() : SyntheticDrive(street_scene(), 8, 0.8) {}
  LoadedFrame load(int index) const override {
    if (index == error_at) throw InputError("cannot be read", "frame", "repair it");
    return SyntheticDrive::load(index);
  }
};

class MapDrive : public testing::Test {
 protected:
  MapJob job() const {
    MapJob job;
    job.output = folder_ / "out.fovea";
    job.hold_out = HoldOut::parse("8:2");
    job.settings.mapper().fusion.submap_duration = 0.25;  // several submaps, which navigation moves
    job.settings.mapper().surface.spacing = 0.05;         // a sparse map is soon made
    job.force = true;
    return job;
  }
  std::string digest() const { return MapReader(folder_ / "out.fovea").digest(); }

  BrokenDrive drive_;
  TemporaryFolder folder_;
};

}  // namespace fovea
