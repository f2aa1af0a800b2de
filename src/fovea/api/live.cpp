#include "fovea/live.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <thread>
#include <utility>

#include "fovea/api/live_pose.h"
#include "fovea/api/map_settings_of.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/drive/live/live_source.h"
#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/pipeline/live_state.h"
#include "fovea/pipeline/map_live.h"
#include "fovea/pipeline/summary_json.h"

namespace fovea {
namespace {

LiveOptions source_options(const std::filesystem::path& output, const LiveMapperOptions& options) {
  LiveOptions source;
  source.drive.cameras = options.cameras;
  source.max_wait = options.max_wait;
  source.longest_beginning = std::max(source.longest_beginning, options.max_wait);
  source.expects_navigation = options.expects_navigation;
  source.waits = options.every_frame;
  source.record = options.record;
  if (options.resume) continue_map(output, source);
  return source;
}

}  // namespace

struct LiveMapper::Content {
  Content(std::string_view drive_toml, const std::filesystem::path& output,
          const LiveMapperOptions& options)
      : source(drive_toml, source_options(output, options)), threads(options.threads) {
    job.output = output;
    job.settings = map_settings_of(options.settings);
    job.texture_every_frame = options.every_frame;
    job.resume = options.resume;
    job.force = options.force;
    job.stop = stop.get_token();
    if (options.on_pose) {
      job.on_tracked = [on_pose = options.on_pose](const FrameResult& frame) {
        on_pose(live_pose(frame));
      };
    }
    mapping = std::jthread([this] { run(); });
  }

  void run() {
    std::exception_ptr thrown;
    try {
      map();
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard lock(guard);
    error = thrown;
    has_ended = true;
    ended.notify_all();
  }

  void map() {
    const ThreadLimit limit(threads);
    MapSummary summary = map_live(source, job, {});
    source.finish_recording();
    const LiveFigures counts = source.figures();
    summary.append(counts);
    nlohmann::ordered_json json = to_json(summary);
    json["live"] = to_json(counts);
    // A note may quote a name in any encoding.
    using Json = nlohmann::ordered_json;
    figures = map_figures(summary, json.dump(2, ' ', false, Json::error_handler_t::replace));
  }

  /// What has ended the map early; null: nothing so far.
  std::exception_ptr failure() const {
    const std::lock_guard lock(guard);
    return error;
  }

  /// Of the source, unless the map has ended with an error.
  LiveSource& open_source() {
    if (const std::exception_ptr thrown = failure()) std::rethrow_exception(thrown);
    return source;
  }

  LiveSource source;
  MapJob job;
  int threads;
  std::stop_source stop;
  MapFigures figures;  // of the thread until it has ended

  mutable std::mutex guard;  // of all below
  std::condition_variable ended;
  bool has_ended = false;
  std::exception_ptr error;

  std::jthread mapping;  // last: it uses the others
};

LiveMapper::LiveMapper(std::string_view drive_toml, const std::filesystem::path& output,
                       const LiveMapperOptions& options) {
  CommandFiles files;
  files.outputs = {{output.string(), ContentKind::kMap, options.force || options.resume}};
  files.folder = {options.record.string(), FolderUse::kReplace};
  check_files(files);
  if (options.on_pose && map_settings_of(options.settings).is_paper()) {
    throw ConfigError("the paper's method gives no poses before the map has their frames",
                      "on_pose", "leave it out, or choose another preset");
  }
  content_ = std::make_unique<Content>(drive_toml, output, options);
}

LiveMapper::~LiveMapper() { stop(); }

void LiveMapper::stop() {
  content_->stop.request_stop();
  content_->source.close();
}

void LiveMapper::add_scan(TimeNs stamp, PointCloud points, const std::string& lidar) {
  points.check();
  content_->open_source().add_scan({lidar, stamp, std::move(points)});
}

void LiveMapper::add_image(const std::string& camera, TimeNs stamp,
                           std::variant<Image, std::string> content,
                           std::optional<double> exposure) {
  content_->open_source().add_image({camera, stamp, std::move(content), exposure});
}

void LiveMapper::add_pose(TimeNs stamp, const RigidMotion& T_world_body) {
  content_->open_source().add_pose({stamp, checked_pose(T_world_body.matrix().topRows<3>())});
}

void LiveMapper::add_position(TimeNs stamp, const GnssPosition& position) {
  content_->open_source().add_position({stamp,
                                        {position.latitude, position.longitude, position.altitude},
                                        position.accuracy,
                                        position.roll_pitch_yaw});
}

void LiveMapper::add_imu(TimeNs stamp, const Eigen::Vector3d& angular_velocity,
                         const Eigen::Vector3d& acceleration,
                         const std::optional<Eigen::Matrix3d>& R_enu_imu) {
  RecordedInertia inertia{stamp, std::nullopt, angular_velocity, acceleration};
  if (R_enu_imu) {
    Eigen::Matrix<double, 3, 4> pose = Eigen::Matrix<double, 3, 4>::Zero();
    pose.leftCols<3>() = *R_enu_imu;
    inertia.R_enu_imu = Eigen::Quaterniond(checked_pose(pose).linear());
  }
  content_->open_source().add_inertia(inertia);
}

void LiveMapper::add_wheel_speed(TimeNs stamp, double speed) {
  content_->open_source().add_wheel_speed({stamp, speed});
}

std::string LiveMapper::missing() const { return content_->source.missing(); }

std::map<std::string, std::size_t> LiveMapper::figures() const {
  return to_json(content_->source.figures()).get<std::map<std::string, std::size_t>>();
}

bool LiveMapper::close_within(std::chrono::milliseconds time) {
  content_->source.close();
  std::unique_lock lock(content_->guard);
  return content_->ended.wait_for(lock, time, [&] { return content_->has_ended; });
}

MapFigures LiveMapper::close() {
  content_->source.close();
  std::unique_lock lock(content_->guard);
  content_->ended.wait(lock, [&] { return content_->has_ended; });
  if (content_->error) std::rethrow_exception(content_->error);
  return content_->figures;
}

}  // namespace fovea
