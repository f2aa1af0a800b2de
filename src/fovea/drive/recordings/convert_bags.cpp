#include "fovea/drive/recordings/convert_bags.h"

#include <fmt/format.h>

#include <set>

#include "fovea/drive/recordings/bag.h"
#include "fovea/drive/recordings/bag_index.h"
#include "fovea/drive/recordings/conversion_plan.h"
#include "fovea/drive/recordings/missing_messages.h"
#include "fovea/drive/recordings/recording_writer.h"
#include "fovea/drive/writers/generic_drive_writer.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

std::vector<std::filesystem::path> files_of(const std::vector<std::filesystem::path>& bags) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& bag : bags) {
    const auto parts = bag_files(bag);
    files.insert(files.end(), parts.begin(), parts.end());
  }
  return files;
}

/// Runs `step`, and adds the name of the recording to its errors.
template <class Step>
auto naming(const std::vector<std::filesystem::path>& bags, Step&& step) {
  try {
    return step();
  } catch (const InputError& error) {
    throw InputError(error.problem(),
                     fmt::format("{} in {}{}", error.where(), bags.front().string(),
                                 bags.size() > 1 ? " and others" : ""),
                     error.remedy());
  }
}

/// Leaves the stamps of scans and images in the part of the recording that the options choose.
void keep_part(const ConvertOptions& options, const ConversionPlan& plan, BagIndex& index) {
  std::vector<TimeNs>& scans = index.lidars.at(plan.lidars.front().topic).stamps;
  const TimeNs first = scans.front();
  const auto erase_outside = [&](std::vector<TimeNs>& stamps, double margin) {
    std::erase_if(stamps, [&](TimeNs stamp) {
      const double time = seconds(stamp - first);
      return time < options.start - margin || time >= options.start + options.duration + margin;
    });
  };
  constexpr double kMargin = 0.1;  // s: what belongs to the first and to the last scan
  erase_outside(scans, 0);
  if (scans.empty()) {
    throw ConfigError("no scan lies in this part of the recording", "--start, --duration",
                      "choose an earlier start, or a longer part");
  }
  const auto keep_part_of = [&](std::vector<TimeNs>& stamps, const char* kind,
                                const std::string& topic, const char* option) {
    erase_outside(stamps, kMargin);
    if (!stamps.empty()) return;
    throw ConfigError(fmt::format("no {} of {} lies in this part of the recording", kind, topic),
                      "--start, --duration",
                      fmt::format("choose another part, or other topics ({})", option));
  };
  for (std::size_t k = 1; k < plan.lidars.size(); ++k) {
    const std::string& topic = plan.lidars[k].topic;
    keep_part_of(index.lidars.at(topic).stamps, "scan", topic, "--lidar");
  }
  for (const PlannedCamera& camera : plan.cameras) {
    keep_part_of(index.images.at(camera.topic).stamps, "image", camera.topic, "--camera");
  }
}

/// Warns of sensors whose stamps have gaps.
void warn_of_gaps(const BagIndex& index, const ConversionPlan& plan, ConvertFigures& figures) {
  const auto check = [&](const std::string& topic, const std::vector<TimeNs>& stamps,
                         const char* kind) {
    const std::size_t missing = missing_messages(stamps);
    if (missing == 0) return;
    figures.warn(fmt::format("{} of {} {} of {} are missing: their stamps have gaps", missing,
                             missing + stamps.size(), kind, topic));
  };
  for (const PlannedLidar& lidar : plan.lidars) {
    check(lidar.topic, index.lidars.at(lidar.topic).stamps, "scans");
  }
  for (const PlannedCamera& camera : plan.cameras) {
    check(camera.topic, index.images.at(camera.topic).stamps, "images");
  }
}

/// Notes each topic without use, with the number of its messages.
void note_unused_topics(const BagIndex& index, const ConversionPlan& plan,
                        ConvertFigures& figures) {
  const NavigationPlan& navigation = plan.navigation;
  std::set<std::string> used = {navigation.fix, navigation.imu, navigation.odometry};
  for (const PlannedLidar& lidar : plan.lidars) used.insert(lidar.topic);
  for (const PlannedCamera& camera : plan.cameras) used.insert(camera.topic);
  for (const auto& [name, messages] : index.messages) {
    const std::string& type = index.topics.at(name).type;
    if (type == ros::kTransforms || type == ros::kCameraInfo || used.contains(name)) continue;
    figures.notes.push_back(fmt::format("not used: {} message{} of {} ({})", messages,
                                        messages == 1 ? "" : "s", name, type));
  }
}

}  // namespace

ConvertFigures convert_bags(const std::vector<std::filesystem::path>& bags,
                            const std::filesystem::path& output, bool force,
                            const ConvertOptions& options,
                            const std::function<void(int, int)>& progress) {
  const std::vector<std::filesystem::path> files = files_of(bags);
  ConvertFigures figures;
  GenericDriveWriter writer(output, force);
  const std::filesystem::path scratch = writer.folder();
  BagIndex index = index_bags(files, scratch);
  ConversionPlan plan = naming(bags, [&] { return plan_conversion(index, options); });
  keep_part(options, plan, index);
  RecordingWriter recording_writer(index, plan, writer, options.allow_dropped, progress);
  for (const std::filesystem::path& file : files) read_bag_file(file, scratch, recording_writer);
  figures.notes = plan.notes;
  naming(bags, [&] { recording_writer.finish(plan.drive, figures); });
  note_unused_topics(index, plan, figures);
  warn_of_gaps(index, plan, figures);
  for (const std::string& loss : index.losses) figures.warn(loss);
  for (const auto& [topic, unusable] : index.unusable) {
    figures.warn(unusable.note(topic));
  }
  writer.finish(plan.drive);
  return figures;
}

RecordingContents list_bags(const std::vector<std::filesystem::path>& bags) {
  const BagIndex index = index_bags(files_of(bags), std::filesystem::temp_directory_path());
  RecordingContents contents;
  for (const auto& [name, topic] : index.topics) {
    RecordingContents::Topic& listed = contents.topics.emplace_back();
    listed.name = name;
    listed.type = topic.type;
    const auto count = index.messages.find(name);
    if (count != index.messages.end()) listed.messages = count->second;
    for (const auto* sensors : {&index.lidars, &index.images}) {
      const auto sensor = sensors->find(name);
      if (sensor == sensors->end()) continue;
      listed.first = sensor->second.stamps.front(), listed.last = sensor->second.stamps.back();
      listed.frame = sensor->second.frame;
    }
  }
  for (const std::string& loss : index.losses) contents.warn(loss);
  for (const auto& [topic, unusable] : index.unusable) contents.warn(unusable.note(topic));
  return contents;
}

}  // namespace fovea
