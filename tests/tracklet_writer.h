// For tests: a tracklet file as KITTI's are.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace fovea::test {

struct BoxPose {
  double x, y, z, rz;  // LiDAR frame: middle of the bottom (m), heading (rad)
};

/// One <item>; size: length, width, height.
inline std::string tracklet_item(const char* type, double length, double width, double height,
                                 int first_frame, const std::vector<BoxPose>& poses) {
  std::string text = fmt::format(
      "<item class_id=\"1\"><objectType>{}</objectType><h>{}</h><w>{}</w><l>{}</l>"
      "<first_frame>{}</first_frame><poses class_id=\"2\"><count>{}</count>"
      "<item_version>2</item_version>\n",
      type, height, width, length, first_frame, poses.size());
  for (const BoxPose& p : poses) {
    text += fmt::format(
        "<item class_id=\"3\"><tx>{}</tx><ty>{}</ty><tz>{}</tz><rx>0</rx><ry>0</ry><rz>{}</rz>"
        "<state>2</state><occlusion>0</occlusion><truncation>0</truncation></item>\n",
        p.x, p.y, p.z, p.rz);
  }
  return text + "</poses><finished>1</finished></item>\n";
}

inline std::string tracklet_file(const std::vector<std::string>& items) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\" ?>\n"
      "<!DOCTYPE boost_serialization>\n"
      "<boost_serialization signature=\"serialization::archive\" version=\"9\">\n"
      "<tracklets class_id=\"0\" tracking_level=\"0\" version=\"0\">\n";
  text += fmt::format("<count>{}</count><item_version>1</item_version>\n", items.size());
  for (const std::string& item : items) text += item;
  return text + "</tracklets>\n</boost_serialization>\n";
}

}  // namespace fovea::test
