#include "app/calibration_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fovea::app::calibration_text_test {

using testing::HasSubstr;

CalibrationEstimate observable(std::array<bool, kCalibrationSize> which) {
  CalibrationEstimate estimate;
  estimate.observable = which;
  return estimate;
}

TEST(MissingEvidence, DependsOnWhatElseIsObservable) {
  const auto all_but_forward = observable({true, true, true, true, true, false, true});
  EXPECT_EQ(missing_evidence(all_but_forward, kCamRotation), "");
  EXPECT_THAT(missing_evidence(all_but_forward, kCamTranslation + 2), HasSubstr("speeds"));
  const auto rotation_alone = observable({true, true, true, false, false, false, false});
  EXPECT_EQ(missing_evidence(rotation_alone, kCamDelay), "move or turn while recording");
  for (int k = kCamTranslation; k < kCamDelay; ++k) {
    EXPECT_EQ(missing_evidence(rotation_alone, k), "record objects nearer to the camera");
  }
}

TEST(MissingEvidence, WithoutAnyRotationEdgesAreMissing) {
  for (int k = 0; k < kCalibrationSize; ++k) {
    EXPECT_THAT(missing_evidence(observable({}), k), HasSubstr("more edges")) << k;
  }
}

TEST(MissingEvidence, NoneHelpsACameraThatDisagrees) {
  CalibrationEstimate estimate;
  estimate.disagrees = true;
  EXPECT_EQ(missing_evidence(estimate, kCamDelay), "");
}

TEST(CalibrationParameterName, DiffersByParameter) {
  EXPECT_EQ(calibration_parameter_name(kCamRotation), "rotation about x (right)");
  EXPECT_EQ(calibration_parameter_name(kCamTranslation + 2), "points forward");
  EXPECT_EQ(calibration_parameter_name(kCamDelay), "delay of the images");
}

TEST(LensText, NamesWhatDoesNotFit) {
  LensCheck lens;
  EXPECT_THAT(lens_text(lens), HasSubstr("not checked"));
  lens = {.is_checked = true, .focal = 0.001, .focal_sigma = 0.001};
  EXPECT_EQ(lens_text(lens), "Focal length and distortion agree with the edges.");
  lens.focal = -0.021;
  EXPECT_EQ(lens_text(lens),
            "Edges fit better with a focal length 2.1 % shorter (+-0.1 %): check K.");
  lens.radial = 0.03;
  EXPECT_THAT(lens_text(lens), HasSubstr("3.0 % outwards (+-0.0 %): check K and the distortion"));
  lens.focal = 0;
  EXPECT_THAT(lens_text(lens), HasSubstr("fit better with a distortion"));
}

TEST(ImuDisagreement, NamesTheLikelyCause) {
  ImuHandEye imu;
  EXPECT_EQ(imu_disagreement(imu), "");
  imu.agrees = false;
  EXPECT_THAT(imu_disagreement(imu), HasSubstr("stamps"));
  imu.turn_ratio = 57.1;
  EXPECT_THAT(imu_disagreement(imu), HasSubstr("57 times"));
  imu.turn_ratio = 0.0175;
  EXPECT_THAT(imu_disagreement(imu), HasSubstr("pi/180"));
  imu.turn_ratio = 2.5;
  EXPECT_THAT(imu_disagreement(imu), HasSubstr("2.50 times"));
  imu.turn_ratio = 1;
  imu.mirrored = true;
  EXPECT_THAT(imu_disagreement(imu), HasSubstr("wrong sign"));
}

}  // namespace fovea::app::calibration_text_test
