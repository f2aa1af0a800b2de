#include "fovea/drive/recordings/recording_writer.h"

#include <fmt/format.h>

#include <algorithm>

#include "fovea/drive/recordings/pixels.h"
#include "fovea/errors.h"

namespace fovea {

RecordingWriter::RecordingWriter(const BagIndex& index, const ConversionPlan& plan,
                                 GenericDriveWriter& writer, bool allow_dropped,
                                 const std::function<void(int, int)>& progress)
    : allow_dropped_(allow_dropped), writer_(writer), progress_(progress) {
  for (const PlannedLidar& planned : plan.lidars) {
    Numbered messages(planned.topic, index.lidars.at(planned.topic));
    messages.name = planned.lidar.name;
    total_ += messages.stamps.size();
    lidars_.emplace(planned.topic, LidarMessages{std::move(messages), planned.format});
  }
  for (const PlannedCamera& planned : plan.cameras) {
    Numbered& camera =
        cameras_.try_emplace(planned.topic, planned.topic, index.images.at(planned.topic))
            .first->second;
    camera.name = planned.camera.name;
    total_ += camera.stamps.size();
  }
}

bool RecordingWriter::is_requested(const BagTopic& topic) {
  return (lidars_.contains(topic.name) && is_scan_type(topic.type)) ||
         (cameras_.contains(topic.name) &&
          (topic.type == ros::kImage || topic.type == ros::kCompressedImage));
}

void RecordingWriter::add(const BagTopic& topic, std::string_view bytes) {
  try {
    MessageReader message(bytes, topic.encoding, topic.name);
    if (is_scan_type(topic.type)) {
      write_scan(ScanMessage(topic.type, message), lidars_.at(topic.name));
    } else if (topic.type == ros::kImage) {
      write_plain(ros::read_image(message), cameras_.at(topic.name));
    } else {
      write_compressed(ros::read_compressed_image(message), cameras_.at(topic.name));
    }
  } catch (const InputError&) {
    // The index has counted it.
  }
  done_ = std::min(done_ + 1, total_);
  progress_(int(done_), int(total_));
}

void RecordingWriter::finish(RecordedDrive& drive, ConvertFigures& figures) const {
  figures.cameras = cameras_.size();
  figures.lidars = lidars_.size();
  const auto set_scale = [&](RecordedLidar& of_drive) {
    for (const auto& [topic, lidar] : lidars_) {
      if (lidar.messages.name == of_drive.name) of_drive.intensity_max = lidar.scale.max();
    }
  };
  set_scale(drive.lidar);
  for (RecordedLidar& lidar : drive.further_lidars) set_scale(lidar);
  for (const auto& [topic, lidar] : lidars_) {
    figures.scans += lidar.messages.written;
    account_for(lidar.messages, figures);
  }
  for (const auto& [topic, camera] : cameras_) {
    figures.images += camera.written;
    account_for(camera, figures);
  }
  for (const auto& [topic, lidar] : lidars_) {
    if (lidar.dropped.total() > 0) {
      const std::string of = lidars_.size() > 1 ? fmt::format(" of {}", topic) : "";
      figures.notes.push_back(fmt::format("points left out{}: {}", of, reasons_of(lidar.dropped)));
    }
    if (!allow_dropped_) require_few_dropped(lidar.dropped, lidar.kept, topic);
  }
}

RecordingWriter::Numbered::Numbered(const std::string& topic_name, const SensorTopic& sensor)
    : topic(topic_name), frame(sensor.frame), stamps(sensor.stamps), taken(stamps.size()) {}

std::optional<int> RecordingWriter::Numbered::take(const ros::Header& header) {
  const auto found = std::lower_bound(stamps.begin(), stamps.end(), header.stamp);
  const auto number = std::size_t(found - stamps.begin());
  if (found == stamps.end() || *found != header.stamp || header.frame != frame || taken[number]) {
    return std::nullopt;
  }
  taken[number] = true;
  return int(number);
}

/// Calls `write(number)` for a message that has not been there yet.
template <class Write>
void RecordingWriter::use(Numbered& sensor, const ros::Header& header, Write&& write) {
  const auto number = sensor.take(header);
  if (!number) return;
  try {
    write(*number);
    ++sensor.written;
  } catch (const InputError& error) {
    sensor.unusable.add(error.problem());
  }
}

void RecordingWriter::write_scan(const ScanMessage& message, LidarMessages& lidar) {
  const TimeNs stamp = message.header().stamp;
  const std::string& topic = lidar.messages.topic;
  use(lidar.messages, message.header(), [&](int number) {
    const LidarScan scan = scan_of(message, lidar.format, topic);
    lidar.dropped += scan.dropped;
    lidar.kept += scan.points.size();
    lidar.scale.add(scan.points.intensity);
    writer_.write_scan(number, stamp, scan.points, ScanFile::kPcd, lidar.messages.name);
  });
}

void RecordingWriter::write_plain(const ros::ImageMessage& image, Numbered& camera) {
  use(camera, image.header, [&](int number) {
    writer_.write_image(camera.name, number, image.header.stamp, image_of(image, camera.topic));
  });
}

void RecordingWriter::write_compressed(const ros::CompressedImage& image, Numbered& camera) {
  use(camera, image.header, [&](int number) {
    const std::string extension(extension_of(image, camera.topic));
    writer_.write_encoded_image(camera.name, number, image.header.stamp, image.data, extension);
  });
}

void RecordingWriter::account_for(const Numbered& sensor, ConvertFigures& figures) {
  const UnusableMessages& unusable = sensor.unusable;
  if (sensor.written == 0) {
    throw InputError(fmt::format("none of the messages can be used ({})", unusable.first_problem),
                     sensor.topic,
                     "restore it from a copy, or see docs/drives.md for what is read");
  }
  if (unusable.count > 0) figures.warn(unusable.note(sensor.topic));
}

}  // namespace fovea
