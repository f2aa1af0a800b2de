#include "app/map_live_command.h"

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/kept_recording.h"
#include "app/live_view.h"
#include "app/pose_lines.h"
#include "app/progress_bar.h"
#include "app/reports.h"
#include "app/robot_reader.h"
#include "app/robot_run.h"
#include "fovea/core/parallel.h"
#include "fovea/core/process_memory.h"
#include "fovea/drive/bridge/pose_publisher.h"
#include "fovea/errors.h"
#include "fovea/pipeline/live_state.h"
#include "fovea/pipeline/map_live.h"
#include "fovea/pipeline/summary_json.h"
#include "fovea/pipeline/tracking_state.h"

namespace fovea::app {
namespace {

/// Values of --poses that choose the source of the first guess.
const std::map<std::string, NavigationSource> kSources = {
    {kRefinedPoses, NavigationSource::kAuto},
    {kNavigationPoses, NavigationSource::kAuto},
    {"gnss", NavigationSource::kGnss},
    {"odometry", NavigationSource::kOdometry},
    {"tf", NavigationSource::kTf},
    {"none", NavigationSource::kNone}};

LiveTopicsOptions options_of(const MapArguments& arguments, const LiveArguments& live) {
  const auto poses = kSources.find(arguments.poses);
  if (poses == kSources.end()) {
    throw ConfigError("poses of a file need a drive that is recorded", "--poses " + arguments.poses,
                      "give refine, navigation, gnss, odometry, tf or none");
  }
  LiveTopicsOptions options = topics_options(arguments.drive, live);
  options.topics.poses = poses->second;
  options.topics.allow_dropped = arguments.allow_dropped;
  if (arguments.resume) continue_map(arguments.output, options.live);
  return options;
}

class RobotMap {
 public:
  RobotMap(const MapArguments& arguments, const LiveArguments& live, Session& session)
      : arguments_(arguments),
        live_(live),
        session_(session),
        topics_(options_of(arguments, live)),
        job_(job_of(arguments)) {
    if (arguments.poses == kNavigationPoses) job_.pose_source = PoseSource::kNavigation;
    job_.texture_every_frame = live.every_frame;
    job_.on_tracked = [this](const FrameResult& frame) { report_pose(frame); };
  }

  void run() {
    std::optional<OutputFile> report;  // opened first: a bad path must not cost a run
    if (!arguments_.report.empty()) report.emplace(arguments_.report, /*force=*/true);
    const bridge::BridgeOptions bridge = bridge_options(arguments_.drive.drive, live_, poses_);
    warm_memory(std::min(kWarmMemory, job_.memory / kWarmShare));
    const std::stop_token stop = session_.interrupt.stop_gently();
    RobotReader reader(bridge, topics_, stop, arguments_.quiet);
    LiveSource* const source = reader.wait_for_source();
    if (source == nullptr) throw_missing(reader, arguments_.drive.drive);
    if (!is_quiet()) {
      for (const std::string& line : topics_.chosen()) print_out("{}\n", line);
    }
    keep_recording(*source, [&] {
      MapSummary summary = naming_log(arguments_.output, [&] { return map(*source); });
      reader.join();
      const LiveFigures figures = source->figures();
      summary.append(figures);
      summary.append(reader.figures());
      summary.append(topics_.unusable());
      print(summary);
      if (report) {
        write_json(*report, {{"map", to_json(summary)},
                             {"live", live_json(reader, topics_, figures, poses_)}});
      }
    });
    reader.rethrow();
    job_.stop = stop;  // of the view: a stop has completed the map
    if (view_) view_->keep_serving();
  }

 private:
  static constexpr std::size_t kWarmMemory = std::size_t{512} << 20, kWarmShare = 2;

  /// Whether standard output is for poses, or for nothing.
  bool is_quiet() const { return arguments_.quiet || live_.pose_stream; }

  MapSummary map(LiveSource& source) {
    job_.on_begin = [&](const std::shared_ptr<const FrameSource>& first_frames) {
      view_.emplace(arguments_.live, job_, first_frames, is_quiet());
    };
    ProgressBar bar(arguments_.quiet);
    return map_live(source, job_, std::ref(bar));
  }

  void report_pose(const FrameResult& frame) {
    if (!frame.stamp) return;
    bridge::PublishedPose pose;
    pose.frame = frame.index;
    pose.stamp = *frame.stamp;
    pose.T_world_lidar = frame.poses.T_local_lidar;
    pose.state = state_of(frame.tracking);
    if (const auto& registration = frame.tracking.registration) {
      pose.covariance = registration->covariance;
    }
    if (live_.pose_stream) print_pose(pose);
    poses_.publish(std::move(pose));
  }

  void print(const MapSummary& summary) {
    if (live_.pose_stream) {
      session_.warnings.add(summary.warnings, arguments_.quiet);
    } else {
      print_run(summary, {}, arguments_, session_);
    }
  }

  const MapArguments& arguments_;
  const LiveArguments& live_;
  Session& session_;
  bridge::PosePublisher poses_;
  LiveTopics topics_;
  MapJob job_;
  std::optional<LiveView> view_;  // observes the job
};

}  // namespace

void map_robot(const MapArguments& arguments, const LiveArguments& live, Session& session) {
  check_files_of_robot(files_of(arguments), live);
  const ThreadLimit threads(arguments.threads);
  RobotMap(arguments, live, session).run();
}

}  // namespace fovea::app
