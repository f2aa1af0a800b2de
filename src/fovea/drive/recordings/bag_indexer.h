// Notes what messages of recordings contain.
#pragma once

#include <map>
#include <string_view>
#include <vector>

#include "fovea/drive/recordings/bag_index.h"

namespace fovea {

///   BagIndexer indexer;
///   read_bag_file(file, scratch, indexer);
///   const BagIndex index = indexer.finish();
class BagIndexer : public BagSink {
 public:
  /// Requests the topics that a drive can be made of.
  bool is_requested(const BagTopic& topic) override;
  void skip(const BagTopic& topic) override { ++index_.messages[topic.name]; }
  void report_loss(const std::string& problem) override { index_.losses.push_back(problem); }
  /// A message that cannot be used is counted.
  void add(const BagTopic& topic, std::string_view bytes) override;

  /// Forgets the measurements, so that memory is bounded. Topics, calibration and the latest
  /// transforms stay.
  void forget_past();

  /// In order of stamps.
  BagIndex finish();

 private:
  using Reader = void (BagIndexer::*)(const BagTopic&, MessageReader&);
  static const std::map<std::string_view, Reader>& readers();

  void add_scan(const BagTopic& topic, MessageReader& message);
  void add_image(const BagTopic& topic, MessageReader& message);
  void add_compressed(const BagTopic& topic, MessageReader& message);
  void add_camera_info(const BagTopic& topic, MessageReader& message);
  void add_fix(const BagTopic& topic, MessageReader& message);
  void add_imu(const BagTopic& topic, MessageReader& message);
  void add_odometry(const BagTopic& topic, MessageReader& message);
  void add_transforms(const BagTopic& topic, MessageReader& message);

  BagIndex index_;
};

}  // namespace fovea
