// Which topics become what: cameras and navigation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fovea/drive/recordings/camera_topics.h"
#include "fovea/drive/recordings/conversion_plan.h"
#include "fovea/drive/recordings/navigation_topics.h"
#include "fovea/drive/recordings/scan_message.h"
#include "fovea/errors.h"

namespace fovea::plan_test {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

QuaternionMotion at(double x) { return {Eigen::Vector3d(x, 0, 0), Eigen::Quaterniond::Identity()}; }

ros::CameraInfo some_info(const std::string& frame) {
  ros::CameraInfo info;
  info.header.frame = frame;
  info.width = 640, info.height = 480;
  info.distortion_model = "plumb_bob";
  info.d = {-0.3, 0.1, 0.001, -0.001, 0.01};
  info.k = {400, 0, 320, 0, 410, 240, 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {380, 0, 310, 0, 0, 390, 230, 0, 0, 0, 1, 0};
  return info;
}

void add_images(BagIndex& index, const std::string& topic, const std::string& unread = "") {
  SensorTopic& images = index.images[topic];
  images.frame = "front";
  images.stamps = {1, 2, 3};
  images.unread = unread;
}

BagIndex one_camera() {
  BagIndex index;
  add_images(index, "/cams/front/image_raw/compressed");
  index.camera_infos["/cams/front/camera_info"] = some_info("front");
  index.transforms.add("base_link", "lidar", 0, at(1), true);
  index.transforms.add("lidar", "front", 0, at(0.25), true);
  return index;
}

std::vector<std::string> topics_of(const std::vector<PlannedCamera>& cameras) {
  std::vector<std::string> topics;
  for (const PlannedCamera& camera : cameras) topics.push_back(camera.topic);
  return topics;
}

TEST(PlanCameras, TakesWhatHasCalibrationAndPlace) {
  BagIndex index = one_camera();
  add_images(index, "/cams/rear/image_raw");
  add_images(index, "/cams/depth/image_raw/compressed");
  std::vector<std::string> notes;
  const auto cameras = plan_cameras(index, {}, "lidar", notes);
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_EQ(cameras[0].camera.name, "cams_front");
  EXPECT_EQ(cameras[0].camera.index, 0);
  EXPECT_EQ(cameras[0].camera.optics.fy, 410);
  EXPECT_EQ(cameras[0].camera.optics.lens.model(), LensModel::kPlumbBob);
  EXPECT_EQ(cameras[0].camera.T_lidar_cam.translation.x(), 0.25);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("/cams/rear/camera_info")));
}

TEST(PlanCameras, PrefersRawAndPlainImages) {
  BagIndex index = one_camera();
  std::vector<std::string> notes;
  add_images(index, "/cams/front/image_rect_color");
  EXPECT_THAT(topics_of(plan_cameras(index, {}, "lidar", notes)),
              ElementsAre("/cams/front/image_raw/compressed"));
  add_images(index, "/cams/front/image_raw");
  EXPECT_THAT(topics_of(plan_cameras(index, {}, "lidar", notes)),
              ElementsAre("/cams/front/image_raw"));
  index.images.at("/cams/front/image_raw").unread = "of another encoding";
  EXPECT_THAT(topics_of(plan_cameras(index, {}, "lidar", notes)),
              ElementsAre("/cams/front/image_raw/compressed"));
  ConvertOptions options;
  options.cameras = {{"a", "/cams/front/image_rect_color"}};
  const auto rectified = plan_cameras(index, options, "lidar", notes);
  EXPECT_EQ(rectified[0].camera.name, "a");
  EXPECT_EQ(rectified[0].camera.optics.fy, 390);
  EXPECT_EQ(rectified[0].camera.optics.lens.model(), LensModel::kNone);
}

TEST(PlanCameras, ARectifiedCameraIsTurnedAsItsRectificationSays) {
  BagIndex index = one_camera();
  add_images(index, "/cams/front/image_rect");
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R =
      Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  std::copy(R.data(), R.data() + 9, index.camera_infos["/cams/front/camera_info"].r.begin());
  ConvertOptions options;
  options.cameras = {{"a", "/cams/front/image_rect"}};
  std::vector<std::string> notes;
  const auto cameras = plan_cameras(index, options, "lidar", notes);
  const Eigen::Vector3d ray_lidar =
      cameras[0].camera.T_lidar_cam.rotation * (R * Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(ray_lidar.isApprox(Eigen::Vector3d(1, 2, 3), 1e-12));
}

TEST(PlanCameras, ARecordingWithoutImagesHasNoCamera) {
  BagIndex index = one_camera();
  index.images.clear();
  std::vector<std::string> notes;
  EXPECT_TRUE(plan_cameras(index, {}, "lidar", notes).empty());
  EXPECT_THAT(notes, ElementsAre(HasSubstr("the recording has no images")));
}

TEST(PlanCameras, SaysWhichCalibrationIsMissing) {
  const auto error_of = [](const std::function<void(BagIndex&)>& change) -> std::string {
    BagIndex index = one_camera();
    change(index);
    std::vector<std::string> notes;
    try {
      plan_cameras(index, {}, "lidar", notes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto info_of = [](BagIndex& index) -> ros::CameraInfo& {
    return index.camera_infos.at("/cams/front/camera_info");
  };
  EXPECT_THAT(error_of([](BagIndex& s) { s.camera_infos.clear(); }), HasSubstr("CameraInfo"));
  EXPECT_THAT(error_of([](BagIndex& s) { s.transforms = {}; }), HasSubstr("/tf_static"));
  EXPECT_THAT(error_of([](BagIndex& s) { s.images.begin()->second.unread = "odd"; }),
              HasSubstr("odd"));
  EXPECT_THAT(error_of([](BagIndex& s) {
                s.images.begin()->second.width = 320, s.images.begin()->second.height = 240;
              }),
              HasSubstr("320 x 240"));
  EXPECT_THAT(error_of([&](BagIndex& s) {
                info_of(s).header.frame = s.images.begin()->second.frame = "lidar";
              }),
              HasSubstr("'lidar'"));
  EXPECT_THAT(error_of([&](BagIndex& s) { info_of(s).k = {}; }), HasSubstr("not calibrated"));
  EXPECT_THAT(error_of([&](BagIndex& s) { info_of(s).distortion_model = "ftheta"; }),
              HasSubstr("'ftheta'"));
  EXPECT_THAT(error_of([&](BagIndex& s) { info_of(s).d.resize(3); }), HasSubstr("3 coefficients"));
  EXPECT_THAT(error_of([&](BagIndex& s) { info_of(s).d.resize(8, 0.1); }),
              HasSubstr("8 coefficients"));
  EXPECT_THAT(error_of([&](BagIndex& s) { info_of(s).binning_x = 2; }), HasSubstr("binning"));
  EXPECT_THAT(error_of([&](BagIndex& s) { info_of(s).roi_x = 2; }), HasSubstr("region"));
  EXPECT_THAT(error_of([&](BagIndex& s) { info_of(s).width = 0; }), HasSubstr("0 x 480"));
  EXPECT_THAT(error_of([](BagIndex& s) {
                s.transforms.add("lidar", "front", 1, at(0), false);
                s.transforms.add("lidar", "front", 2, at(1), false);
              }),
              HasSubstr("moves"));
}

TEST(PlanCameras, AFrameThatTfDoesNotKnowGivesWayToThatOfTheImages) {
  BagIndex index = one_camera();
  index.camera_infos["/cams/front/camera_info"].header.frame = "unknown";
  std::vector<std::string> notes;
  const auto cameras = plan_cameras(index, {}, "lidar", notes);
  EXPECT_EQ(cameras.at(0).camera.T_lidar_cam.translation.x(), 0.25);
}

TEST(OpticsOf, WithoutDistortionALensIsAPinhole) {
  ros::CameraInfo info = some_info("front");
  info.d = {0, 0, 0, 0, 0};
  EXPECT_EQ(optics_of(info, false, "t").lens.model(), LensModel::kNone);
  info.distortion_model = "";
  info.d = {};
  EXPECT_EQ(optics_of(info, false, "t").lens.model(), LensModel::kNone);
  info.distortion_model = "equidistant";
  info.d = {0, 0, 0, 0};
  EXPECT_EQ(optics_of(info, false, "t").lens.model(), LensModel::kEquidistant);
  info.p[3] = -50;
  EXPECT_THROW(optics_of(info, true, "t"), InputError);
}

class PlanNavigation : public testing::Test {
 protected:
  PlanNavigation() {
    index_.transforms.add("base_link", "lidar", 0, at(1), true);
    index_.transforms.add("base_link", "imu", 0, at(0.5), true);
    index_.transforms.add("base_link", "gps", 0, at(-2), true);
  }

  void add_fixes(const std::string& topic) {
    for (int i = 0; i < 4; ++i) {
      ros::NavSatFix fix;
      fix.header.stamp = i;
      fix.header.frame = "gps";
      fix.fix = i != 1;
      fix.latitude = 49, fix.longitude = i == 2 ? std::nan("") : 8;
      fix.covariance = {0.09, 0, 0, 0, 0.09, 0, 0, 0, 1};
      fix.covariance_known = true;
      index_.fixes[topic].push_back(fix);
    }
  }
  void add_imu(const std::string& frame, const Eigen::Quaterniond& orientation = {0.8, 0, 0, 0.6}) {
    ros::Imu imu;
    imu.header.frame = frame;
    index_.imus["/imu"].push_back(imu);
    imu.orientation = orientation;
    index_.imus["/imu"].push_back(imu);
  }
  void add_odometry(const std::string& topic, const std::string& child) {
    ros::Odometry odometry;
    odometry.header.stamp = 7;
    odometry.child_frame = child;
    odometry.T_header_child = at(3);
    index_.odometries[topic].push_back(odometry);
  }
  void add_course() {
    for (int i = 0; i < 3; ++i) index_.transforms.add("odom", "base_link", i, at(i), false);
  }

  RecordedDrive plan() {
    RecordedDrive drive;
    notes_.clear();
    plan_navigation(index_, options_, "lidar", drive, notes_);
    return drive;
  }
  std::string error() {
    try {
      plan();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  BagIndex index_;
  ConvertOptions options_;
  std::vector<std::string> notes_;
};

TEST_F(PlanNavigation, PositionsComeFirstWithTheirAccuracyAndOrientations) {
  add_fixes("/fix");
  add_imu("imu");
  add_odometry("/odom", "base_link");
  const RecordedDrive drive = plan();
  EXPECT_THAT(drive.poses, IsEmpty());
  ASSERT_EQ(drive.positions.size(), 2u);  // one has no fix, one is nowhere
  EXPECT_EQ(drive.positions[1].time, 3);
  EXPECT_DOUBLE_EQ(drive.positions[0].accuracy, 0.3);
  EXPECT_EQ(drive.inertia.size(), 1u);  // the other's orientation is not known
  EXPECT_EQ(drive.antenna_body.x(), -2);
  EXPECT_EQ(drive.T_body_lidar.translation.x(), 1);
  EXPECT_EQ(drive.T_body_imu.translation.x(), 0.5);
}

TEST_F(PlanNavigation, AnImuThatNeverTurnsKnowsNoOrientation) {
  add_fixes("/fix");
  add_imu("imu", Eigen::Quaterniond::Identity());
  EXPECT_THAT(plan().inertia, IsEmpty());
  index_.imus.clear();
  add_imu("imu");
  options_.imu = "none";
  EXPECT_THAT(plan().inertia, IsEmpty());
  EXPECT_EQ(plan().positions.size(), 2u);
}

TEST_F(PlanNavigation, RatesAndAccelerationsOfAnImuNeedNoPositions) {
  add_imu("imu");
  for (ros::Imu& imu : index_.imus["/imu"]) {
    imu.acceleration << 0.1, 0, 9.8;
    imu.angular_velocity << 0.01, 0, 0;
  }
  const RecordedDrive drive = plan();
  ASSERT_EQ(drive.inertia.size(), 2u);
  EXPECT_FALSE(drive.inertia[1].R_enu_imu);  // nothing has a use for it
  EXPECT_EQ(drive.inertia[0].acceleration.z(), 9.8);
  ASSERT_TRUE(drive.T_lidar_imu);
  EXPECT_EQ(drive.T_lidar_imu->translation.x(), -0.5);
  index_.imus["/imu"].front().header.frame = "elsewhere";
  EXPECT_FALSE(plan().T_lidar_imu);
  EXPECT_EQ(plan().inertia.size(), 2u);
  EXPECT_THAT(notes_, Contains(HasSubstr("imu.T_lidar_imu")));
  index_.imus["/other"] = index_.imus["/imu"];
  EXPECT_THAT(plan().inertia, IsEmpty());
  EXPECT_THAT(notes_, Contains(HasSubstr("--imu TOPIC")));
  options_.imu = "/other";
  EXPECT_EQ(plan().inertia.size(), 2u);
}

TEST_F(PlanNavigation, AnAntennaThatMovesIsNone) {
  add_fixes("/fix");
  add_course();
  for (ros::NavSatFix& fix : index_.fixes["/fix"]) fix.header.frame = "odom";
  EXPECT_TRUE(plan().antenna_body.isZero(0));
  EXPECT_THAT(notes_, Contains(HasSubstr("'odom'")));
}

TEST_F(PlanNavigation, WhatIsNamedIsWherePosesComeFrom) {
  add_fixes("/fix");
  add_odometry("/odom", "nobody");
  options_.odometry = "/odom";
  EXPECT_THAT(error(), HasSubstr("--body"));
  options_.body = "imu";
  EXPECT_EQ(plan().poses.size(), 1u);
  EXPECT_EQ(plan().T_body_lidar.translation.x(), 0.5);
  options_.poses = NavigationSource::kGnss;
  EXPECT_THROW(plan(), ConfigError);
}

TEST_F(PlanNavigation, NoImuIsNoWordOnWherePosesComeFrom) {
  options_.imu = "none";
  add_odometry("/odom", "imu");
  EXPECT_EQ(plan().poses.size(), 1u);
  options_.poses = NavigationSource::kOdometry;
  EXPECT_EQ(error(), "");
}

TEST_F(PlanNavigation, WhatTfDoesNotJoinIsTold) {
  add_fixes("/fix");
  add_imu("elsewhere");
  index_.fixes["/fix"].front().header.frame = "nowhere";
  const RecordedDrive drive = plan();
  EXPECT_THAT(drive.inertia, IsEmpty());
  EXPECT_TRUE(drive.antenna_body.isZero(0));
  EXPECT_THAT(notes_, Contains(HasSubstr("'elsewhere'")));
  EXPECT_THAT(notes_, Contains(HasSubstr("'nowhere'")));
}

TEST_F(PlanNavigation, ThenOdometryThenTfThenNothing) {
  add_course();
  EXPECT_EQ(plan().poses.size(), 3u);
  add_odometry("/odom", "imu");
  EXPECT_EQ(plan().poses.size(), 1u);
  EXPECT_EQ(plan().T_body_lidar.translation.x(), 0.5);  // from the IMU's frame
  options_.poses = NavigationSource::kTf;
  EXPECT_EQ(plan().poses.size(), 3u);
  options_.poses = NavigationSource::kNone;
  EXPECT_THAT(plan().poses, IsEmpty());
  EXPECT_THAT(notes_, Contains(HasSubstr("no poses")));
}

TEST_F(PlanNavigation, AsksWhereSeveralMightBeMeant) {
  add_odometry("/wheels", "base_link");
  add_odometry("/visual", "base_link");
  EXPECT_THAT(error(), HasSubstr("--odometry"));
  options_.odometry = "/visual";
  EXPECT_EQ(error(), "");
  options_.odometry = "";
  add_fixes("/a");
  add_fixes("/b");
  EXPECT_THAT(error(), HasSubstr("--fix"));
}

TEST_F(PlanNavigation, RefusesWhatTheRecordingDoesNotHave) {
  options_.poses = NavigationSource::kGnss;
  EXPECT_THAT(error(), HasSubstr("no positions"));
  options_.poses = NavigationSource::kOdometry;
  EXPECT_THAT(error(), HasSubstr("no poses"));
  options_.poses = NavigationSource::kTf;
  EXPECT_THAT(error(), HasSubstr("no frame"));
  add_course();
  options_.world = "mars";
  EXPECT_THAT(error(), HasSubstr("no frame"));
  options_.world = "odom";
  EXPECT_EQ(error(), "");
  options_.world = "";
  options_.poses = NavigationSource::kOdometry;
  add_odometry("/odom", "nobody");
  EXPECT_THAT(error(), HasSubstr("'nobody'"));
  options_.odometry = "/none";
  EXPECT_THAT(error(), HasSubstr("/none"));
}

void add_scans(BagIndex& index, const std::string& topic, std::string_view type,
               double clock_ahead = 0) {
  index.topics[topic] = {topic, std::string(type), std::string(kCdrEncoding)};
  SensorTopic& lidar = index.lidars[topic];
  lidar.frame = "lidar";
  for (int i = 0; i < 5; ++i) {
    const TimeNs stamp = 1'700'000'000 * kNsPerSecond + i * kNsPerSecond / 10;
    ScanNumberRows rows(stamp);
    const std::vector<std::optional<Scalar>> types(rows.columns().size(), Scalar::kDouble);
    rows.begin(100, types);
    for (int k = 0; k < 100; ++k) {
      const double time = seconds(stamp) + clock_ahead + 0.001 * k;
      rows.add(std::vector<double>{5, 1, 1, 0.5, 0, time}, std::size_t(k));
    }
    lidar.stamps.push_back(stamp);
    lidar.first_scans.push_back(rows.take());
  }
}

ConversionPlan plan_of(const BagIndex& index, const std::string& lidar = "") {
  ConvertOptions options;
  if (!lidar.empty()) options.lidars = {lidar};
  return plan_conversion(index, options);
}

TEST(PlanConversion, PacketsCountOnlyWithoutPointClouds) {
  BagIndex index = one_camera();
  index.images.clear();
  add_scans(index, "/packets", ros::kVelodyneScan);
  EXPECT_EQ(plan_of(index).lidars.front().topic, "/packets");
  add_scans(index, "/points", ros::kPointCloud);
  EXPECT_EQ(plan_of(index).lidars.front().topic, "/points");
  EXPECT_EQ(plan_of(index, "/packets").lidars.front().topic, "/packets");
  add_scans(index, "/livox", ros::kLivox2);
  EXPECT_THROW(plan_of(index), InputError);
}

TEST(PlanConversion, FurtherLidarsHaveNamesAndPlaces) {
  BagIndex index = one_camera();
  index.images.clear();
  add_scans(index, "/sensors/top/points", ros::kPointCloud);
  add_scans(index, "/left/points", ros::kPointCloud);
  add_scans(index, "/left/second", ros::kPointCloud);
  index.lidars.at("/left/points").frame = "left";
  ConvertOptions options;
  options.lidars = {"/sensors/top/points", "/left/points", "/left/second"};
  EXPECT_THROW(plan_conversion(index, options), InputError);  // tf does not have "left"
  index.transforms.add("lidar", "left", 0, at(0.5), /*is_static=*/true);
  const ConversionPlan plan = plan_conversion(index, options);
  ASSERT_EQ(plan.drive.further_lidars.size(), 2u);
  EXPECT_EQ(plan.drive.lidar.name, "sensors_top");
  EXPECT_EQ(plan.drive.further_lidars[0].name, "left");
  EXPECT_EQ(plan.drive.further_lidars[0].T_lidar_sensor.translation.x(), 0.5);
  EXPECT_EQ(plan.drive.further_lidars[1].name, "left_2");  // in the frame of the first one
  EXPECT_EQ(plan.drive.further_lidars[1].T_lidar_sensor.translation.x(), 0);
  options.lidars = {"/left/points", "/left/points"};
  EXPECT_THROW(plan_conversion(index, options), ConfigError);
}

TEST(PlanConversion, TimesOfAnotherClockCountFromTheFirstPoint) {
  BagIndex index = one_camera();
  index.images.clear();
  add_scans(index, "/points", ros::kPointCloud);
  EXPECT_EQ(plan_of(index).lidars.front().format.time_reference, TimeReference::kAbsolute);
  index.lidars.clear();
  add_scans(index, "/points", ros::kPointCloud, /*clock_ahead=*/-1.69e9);
  const ConversionPlan plan = plan_of(index);
  EXPECT_EQ(plan.lidars.front().format.time_reference, TimeReference::kFirstPoint);
  EXPECT_EQ(plan.lidars.front().format.time_unit, 1);
  EXPECT_THAT(plan.notes, Contains(HasSubstr("another clock")));
}

TEST(PlanConversion, PacketsOfOtherLidarsAreRefusedByName) {
  BagIndex index = one_camera();
  index.topics["/ouster/packets"] = {"/ouster/packets", "ouster_ros/msg/PacketMsg", "cdr"};
  try {
    plan_of(index);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("/ouster/packets"), HasSubstr("PacketMsg"),
                                             HasSubstr("driver ouster_ros")));
  }
}

}  // namespace fovea::plan_test
