// Everything that a simulated drive depends on besides the program: same options, same bytes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/angle.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/simulation/imu_options.h"
#include "fovea/simulation/lidar_options.h"

namespace fovea {

enum class Scene {
  kStreet,    ///< a street that goes on as long as wanted; nothing moves
  kTraffic,   ///< the same with cars, cyclists and pedestrians that move
  kCrossing,  ///< round a block: four crossings, and back to the start (loop closure)
  kCanyon,    ///< a narrow street between high walls, where GPS is lost
  kPlaza,     ///< an open square, little structure
  kStress,    ///< as many occluders as fit: poles, fences, bushes, people
  kTown,      ///< streets on a grid; drives follow routes through one town
};

/// The grid of streets of scene town, and the drive through it.
struct TownOptions {
  int blocks_x = 4, blocks_y = 4;  ///< crossings are numbered from 0,0 to blocks_x,blocks_y
  std::string route;     ///< crossings "x,y x,y ..."; empty: round the block in the middle
  double begin = 0;      ///< m along the route, where the drive begins
  bool traffic = false;  ///< cars, cyclists and pedestrians move along the route
};

/// Sun and sky.
struct LightOptions {
  double sun_azimuth = 130 * kDegree;  ///< rad, clockwise from north
  double sun_elevation = 42 * kDegree;
  /// Irradiance of a surface that faces the sun, and of one that sees the whole sky; 1 shows a
  /// white surface at full scale (exposure 1).
  double sun = 0.95, sky = 0.38;
  bool reflections = true;  ///< glossy surfaces mirror what is around
};

/// What moves the sensors along the path.
enum class Carrier {
  kWheels,  ///< a vehicle
  kWalker,  ///< a person who holds them
  kDrone,
};

/// How the vehicle drives along its path. T_world_vehicle is a smooth function of time.
struct VehicleOptions {
  Carrier carrier = Carrier::kWheels;
  double speed = 9;               ///< m/s, mean
  double speed_variation = 0.25;  ///< share of the speed
  double weave = 0.25;            ///< m, sideways in the lane
  double sway = 0.25 * kDegree;   ///< rad, amplitude of roll and pitch
  double heave = 0.01;            ///< m, up and down on the springs
  double stop_at = -1;        ///< s from frame 0's stamp when it begins to brake; negative: never
  double stop_braking = 2.5;  ///< s until it stands, and as long to speed up again
  double stop_duration = 5;   ///< s that it stands
  double turn_rate = 0;       ///< rad/s, the fastest turn to both sides; 0: it looks ahead
  double turn_angle = 60 * kDegree;  ///< rad, of these turns to each side
  double stairs = 0;                 ///< m, height of stairs on the way; 0: none
};

/// Lenses that can be simulated; coefficients in rig.cpp.
enum class SimulatedLens {
  kNone,      ///< pinhole
  kPlumbBob,  ///< barrel distortion as of an everyday wide-angle lens
  kRational,  ///< the same with OpenCV's rational polynomial
  kFisheye,   ///< equidistant
};

struct SimulatedCamera {
  int number = 2;    ///< KITTI's: 0, 1 grey; 2, 3 colour
  double right = 0;  ///< m, from camera 0 along the rectified x axis
  bool grey = false;
  double forward = 0;  ///< m, from camera 0 along the rectified z axis
  double yaw = 0;      ///< rad, counter-clockwise seen from above
  SimulatedLens lens = SimulatedLens::kNone;
  double rate = 0;   ///< images a second; 0: CameraOptions::rate
  double phase = 0;  ///< s, in addition to CameraOptions::phase
};

/// The place of KITTI's camera of that number (0 to 3), or one beside camera 0.
SimulatedCamera kitti_camera(int number);

/// Whole sets of cameras.
enum class CameraRig {
  kKitti,     ///< cameras 2 and 3
  kSurround,  ///< five all round, 0 looking ahead, counter-clockwise; 1 has a fisheye, 4 distorts
};
std::vector<SimulatedCamera> rig_cameras(CameraRig rig);

struct CameraOptions {
  CameraRig rig = CameraRig::kKitti;  ///< where `cameras` come from, unless they were changed
  std::vector<SimulatedCamera> cameras = rig_cameras(CameraRig::kKitti);
  int width = 1242, height = 375;
  double focal = 721.5;              ///< pixels
  double cx = 609.6, cy = 172.9;     ///< pixel centres at integers
  double exposure = 1.0;             ///< factor on linear light
  double exposure_variation = 0.35;  ///< natural logarithm, amplitude over the drive
  double exposure_ratio = 1;         ///< of the last camera's exposure to the first's
  /// Natural logarithm, standard deviation of the gains of red and blue. They change every four
  /// seconds in steps.
  double white_balance_step = 0;
  bool exposure_times = false;  ///< a generic drive states the exposure of each image
  double vignetting = 0.25;     ///< light lost in the image's corners
  double noise = 1.5;           ///< grey levels of 255 at half light, standard deviation
  /// What the calibration files leave out: the cameras are turned, all as one round camera 0, by
  /// this rotation vector in camera 0's rectified axes (rad).
  Eigen::Vector3d rotation_error = Eigen::Vector3d::Zero();
  /// The same of the cameras' place: they are moved by this (m).
  Eigen::Vector3d translation_error = Eigen::Vector3d::Zero();
  double trigger_delay = 0;    ///< s, images are taken this long after the stamps say
  double rate = 0;             ///< images a second; 0: one in the middle of each sweep
  double phase = 0;            ///< s, of the images after the middle of (the first) sweep
  double rolling_shutter = 0;  ///< s, from the first row of an image to the last; 0: all at once
};

struct NavigationOptions {
  GeodeticPoint origin{49.01, 8.43, 114.5};     ///< of the LiDAR at frame 0; town: of crossing 0,0
  double min_delay = 0.011, max_delay = 0.038;  ///< s, of a record after its scan
  double position_noise = 0.01;                 ///< m, white, each axis
  double position_walk = 0.03;                  ///< m per square root of a second, random walk
  double position_bias = 0.4;                   ///< m, standard deviation of the constant error
  double angle_noise = 0.012 * kDegree;         ///< rad, white
  double angle_walk = 0.018 * kDegree;          ///< rad per square root of a second
  double velocity_noise = 0.02;                 ///< m/s, white, each axis
  double rate_noise = 0.05 * kDegree;           ///< rad/s, white, each axis
  double jump_rate = 0.02;                      ///< GPS jumps a second
  double jump_size = 0.4;                       ///< m, standard deviation
  bool outages = false;  ///< satellites are lost for a while: the walk grows tenfold
};

enum class DriveFormat {
  kKitti,    ///< KITTI's raw format
  kGeneric,  ///< docs/drives.md
};

struct SimulationOptions {
  static constexpr int kMaxFrames = 100'000;

  Scene scene = Scene::kStreet;
  int seed = 1;
  /// The same street on another day: another pass has the surfaces of pass 0 and its own noise,
  /// exposure, navigation errors, traffic, and small motions of the vehicle. In a town the parked
  /// cars differ, too.
  int pass = 0;
  int frames = 100;
  DriveFormat format = DriveFormat::kKitti;
  LightOptions light;
  VehicleOptions vehicle;
  double bends = 7 * kDegree;  ///< rad, how far the street's heading swings
  double curvature = 0;        ///< 1/m, of the whole street, besides its bends
  TownOptions town;            ///< for scene town alone
  LidarOptions lidar;
  std::vector<FurtherLidarOptions> further_lidars;
  CameraOptions camera;
  NavigationOptions navigation;
  ImuOptions imu;
  WheelOptions wheels;

  /// ConfigError that names the field.
  void validate() const;
  /// Seed of all that differs from pass to pass.
  int pass_seed() const;
};

/// Names of all scenes ("street"), in the order of Scene.
std::vector<std::string> scene_names();
/// Scene of that name; ConfigError that lists all for any other.
Scene parse_scene(std::string_view name);
std::string_view to_string(Scene scene);

/// "none", "default", "harsh".
std::vector<std::string> noise_names();

/// Options of a scene under a level of noise: with "none" every error is off (of ranges, pixels,
/// exposure, vignetting, navigation), with "harsh" they are two to three times as large and
/// satellites get lost. The vehicle drives the same way under all. ConfigError for another name.
SimulationOptions simulation_options(Scene scene, std::string_view noise);

}  // namespace fovea
