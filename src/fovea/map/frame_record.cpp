#include "fovea/map/frame_record.h"

#include <algorithm>

namespace fovea {

const char* to_string(FrameStatus status) {
  switch (status) {
    case FrameStatus::kMapped:
      return "mapped";
    case FrameStatus::kHeldOut:
      return "held-out";
    case FrameStatus::kSkipped:
      return "skipped";
  }
  return "unknown";
}

std::optional<FrameStatus> frame_status(std::string_view name) {
  for (const FrameStatus status :
       {FrameStatus::kMapped, FrameStatus::kHeldOut, FrameStatus::kSkipped}) {
    if (name == to_string(status)) return status;
  }
  return std::nullopt;
}

namespace {
std::string missing_image_figure(int camera) { return "images_missing_" + std::to_string(camera); }
}  // namespace

void FrameRecord::count_missing_image(int camera) {
  ++figures["images_missing"];
  ++figures[missing_image_figure(camera)];
}

bool FrameRecord::lacks_image(int camera) const { return has(missing_image_figure(camera)); }

const ViewRecord* FrameRecord::find_view(int camera) const {
  const auto view = std::find_if(views.begin(), views.end(),
                                 [&](const ViewRecord& v) { return v.camera == camera; });
  return view != views.end() ? &*view : nullptr;
}

ViewLight ViewRecord::light() const {
  const LogGain gain = log2_gain ? LogGain(log2_gain->cast<float>().array()) : LogGain::Zero();
  return {gain, response};
}

bool FrameRecord::has(const std::string& figure) const {
  const auto found = figures.find(figure);
  return found != figures.end() && found->second > 0;
}

}  // namespace fovea
