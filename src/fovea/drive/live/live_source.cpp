#include "fovea/drive/live/live_source.h"

#include <utility>

#include "fovea/drive/live/live_source_impl.h"

namespace fovea {

LiveSource::LiveSource(std::string_view drive_toml, const LiveOptions& options)
    : impl_(std::make_unique<Impl>(drive_toml, options)) {}
LiveSource::~LiveSource() = default;

void LiveSource::add_scan(LiveScan scan) { impl_->add_scan(std::move(scan)); }
void LiveSource::add_image(LiveImage image) { impl_->add_image(std::move(image)); }
void LiveSource::add_pose(const RecordedPose& pose) { impl_->add_pose(pose); }
void LiveSource::add_position(const RecordedPosition& position) { impl_->add_position(position); }
void LiveSource::add_inertia(const RecordedInertia& inertia) { impl_->add_inertia(inertia); }
void LiveSource::add_wheel_speed(const WheelSpeed& speed) { impl_->add_wheel_speed(speed); }
void LiveSource::close() { impl_->close(); }
std::unique_ptr<FrameSource> LiveSource::begin(const std::stop_token& stop) {
  return impl_->begin(stop);
}
std::optional<LiveFrame> LiveSource::next(const std::stop_token& stop) { return impl_->next(stop); }
std::string LiveSource::missing() const { return impl_->missing(); }
std::optional<Eigen::Vector3d> LiveSource::world_origin() const { return impl_->world_origin(); }
void LiveSource::finish_recording() { impl_->finish_recording(); }
LiveFigures LiveSource::figures() const { return impl_->figures(); }

}  // namespace fovea
