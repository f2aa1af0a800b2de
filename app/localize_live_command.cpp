#include "app/localize_live_command.h"

#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "app/kept_recording.h"
#include "app/pose_lines.h"
#include "app/reports.h"
#include "app/robot_reader.h"
#include "app/robot_run.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/bridge/pose_publisher.h"
#include "fovea/errors.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/localization/localize_live.h"

namespace fovea::app {
namespace {

LiveTopicsOptions options_of(const LocalizeArguments& arguments, const LiveArguments& live) {
  LiveTopicsOptions options = topics_options(arguments.drive, live);
  options.live.drive.use_images = false;
  options.live.max_scans = 8;  // the pose of an older scan comes too late to be of use
  return options;
}

RigidMotion first_pose(const std::string& file) {
  const auto poses = read_poses_with_gaps(file);
  if (poses.size() == 1 && poses.front()) return *poses.front();
  throw InputError("a running robot needs one pose, that of the first scan", file,
                   "give a file with one line, or another --guess");
}

LiveLocalizationJob job_of(const LocalizeArguments& arguments, const Place& place) {
  LiveLocalizationJob job;
  job.map_origin = place.origin;
  if (arguments.guess.empty()) return job;
  job.guess = arguments.guess == kNavigationGuess ? LiveGuess::kNavigation : LiveGuess::kFirst;
  if (arguments.guess != kNavigationGuess && arguments.guess != kFirstGuess) {
    job.first = first_pose(arguments.guess);
  }
  return job;
}

/// Covariance of a pose that is not known: 1 km, and half a turn.
bridge::PoseCovariance anywhere() {
  bridge::PoseCovariance covariance = bridge::PoseCovariance::Zero();
  covariance.diagonal().head<3>().setConstant(std::numbers::pi * std::numbers::pi);
  covariance.diagonal().tail<3>().setConstant(1e6);
  return covariance;
}

class RobotLocalization {
 public:
  RobotLocalization(const LocalizeArguments& arguments, const LiveArguments& live, Session& session)
      : arguments_(arguments),
        live_(live),
        session_(session),
        place_(open_place(arguments.map)),
        topics_(options_of(arguments, live)),
        job_(job_of(arguments, place_)) {
    job_.on_localized = [this](const Localization& frame) { report_pose(frame); };
  }

  void run() {
    OutputFile output(arguments_.output, arguments_.force);  // first: a bad path costs no run
    std::optional<OutputFile> report;
    if (!arguments_.report.empty()) report.emplace(arguments_.report, /*force=*/true);
    RobotReader reader(bridge_options(arguments_.drive.drive, live_, poses_), topics_,
                       session_.interrupt.stop_gently(), arguments_.quiet);
    LiveSource* const source = reader.wait_for_source();
    if (source == nullptr) throw_missing(reader, arguments_.drive.drive);
    if (!is_quiet()) {
      for (const std::string& line : topics_.chosen()) print_out("{}\n", line);
    }
    keep_recording(*source, [&] {
      LocalizedLive localized = localize_live(*source, place_.surfaces(), job_);
      reader.join();
      const LiveFigures figures = source->figures();
      require_poses(localized, arguments_);
      write_poses(localized, 0, localized.frames.back().index + 1, arguments_, output);
      for (const Messages& messages : {Messages(figures), Messages(reader.figures()),
                                       topics_.unusable(), missing_poses(localized)}) {
        localized.append(messages);
      }
      print(localized);
      output.commit();
      if (report) {
        nlohmann::ordered_json json = to_json(localized, guess_of(localized));
        json["warnings"] = localized.warnings;
        write_json(*report,
                   {{"localize", json}, {"live", live_json(reader, topics_, figures, poses_)}});
      }
    });
    reader.rethrow();
  }

 private:
  /// Whether standard output is for poses, or for nothing.
  bool is_quiet() const { return arguments_.quiet || live_.pose_stream; }

  /// A frame without a pose repeats the last one, with a covariance that says so.
  void report_pose(const Localization& frame) {
    if (!frame.stamp) return;
    const bool is_localized = frame.state == LocalizationState::kLocalized;
    if (is_localized) last_T_local_lidar_ = frame.T_local_lidar;
    bridge::PublishedPose pose;
    pose.frame = frame.index;
    pose.stamp = *frame.stamp;
    pose.T_world_lidar = last_T_local_lidar_;
    pose.covariance = is_localized ? frame.covariance : anywhere();
    pose.state = to_string(frame.state);
    if (live_.pose_stream) print_pose(pose);
    poses_.publish(std::move(pose));
  }

  std::string guess_of(const LocalizedLive& localized) const {
    if (!arguments_.guess.empty()) return arguments_.guess;
    return localized.guess == LiveGuess::kNavigation ? kNavigationGuess : kFirstGuess;
  }

  void print(const LocalizedLive& localized) {
    if (live_.pose_stream) {
      session_.warnings.add(localized.warnings, arguments_.quiet);
      return;
    }
    session_.warnings.add(localized, "note: ", arguments_.quiet);
    LocalizeArguments named = arguments_;
    named.guess = guess_of(localized);
    if (!arguments_.quiet) print_summary(named, localized);
  }

  const LocalizeArguments& arguments_;
  const LiveArguments& live_;
  Session& session_;
  const Place place_;
  bridge::PosePublisher poses_;
  LiveTopics topics_;
  LiveLocalizationJob job_;
  RigidMotion last_T_local_lidar_ = RigidMotion::Identity();
};

}  // namespace

void localize_robot(const LocalizeArguments& arguments, const LiveArguments& live,
                    Session& session) {
  check_files_of_robot(files_of(arguments), live);
  const ThreadLimit threads(arguments.threads);
  RobotLocalization(arguments, live, session).run();
}

}  // namespace fovea::app
