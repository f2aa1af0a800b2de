#include "fovea/server/recent_images.h"

#include <iterator>
#include <utility>

#include "fovea/core/thread.h"

namespace fovea {

RecentImages::RecentImages(DriveInfo drive, std::size_t capacity)
    : info_(std::move(drive)),
      capacity_(capacity),
      first_kept_(info_.begin),
      compressor_(start_thread(
          "fovea-images", [this](const std::stop_token& stop) { compress_images(stop); },
          ThreadPriority::kBackground)) {}

void RecentImages::add(const Frame& frame) {
  KeptFrame images;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < frame.images.size(); ++i) {
    if (frame.images[i].empty()) continue;
    KeptImage& kept = images[info_.calibration.cameras.at(i).index];
    kept.pixels = std::make_shared<const Image>(frame.images[i]);
    bytes += kept.size();
  }
  {
    const std::lock_guard lock(guard_);
    frames_[frame.index] = std::move(images);
    bytes_ += bytes;
    drop_oldest();
  }
  changed_.notify_one();
}

void RecentImages::drop_oldest() {
  while (bytes_ > capacity_ && frames_.size() > 1) {
    const auto oldest = frames_.begin();
    for (const auto& [camera, image] : oldest->second) bytes_ -= image.size();
    first_kept_ = oldest->first + 1;
    frames_.erase(oldest);
  }
}

const RecentImages::KeptImage* RecentImages::find(const Place& place) const {
  const auto frame = frames_.find(place.frame);
  if (frame == frames_.end()) return nullptr;
  const auto image = frame->second.find(place.camera);
  return image == frame->second.end() ? nullptr : &image->second;
}

std::optional<RecentImages::Place> RecentImages::newest_pixels() const {
  for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame) {
    for (const auto& [camera, image] : frame->second) {
      if (image.pixels) return Place{frame->first, camera};
    }
  }
  return std::nullopt;
}

void RecentImages::compress_images(const std::stop_token& stop) {
  for (;;) {
    Place place;
    std::shared_ptr<const Image> pixels;
    {
      std::unique_lock lock(guard_);
      std::optional<Place> next;
      changed_.wait(lock, stop, [&] { return (next = newest_pixels()).has_value(); });
      if (stop.stop_requested()) return;
      place = *next;
      pixels = find(place)->pixels;
    }
    KeptImage compressed{nullptr, photograph_jpeg(*pixels)};
    const std::lock_guard lock(guard_);
    if (find(place) == nullptr) continue;  // dropped meanwhile
    KeptImage& kept = frames_[place.frame][place.camera];
    bytes_ = bytes_ - kept.size() + compressed.size();
    kept = std::move(compressed);
  }
}

WebResponse RecentImages::image(int frame, int camera) const {
  KeptImage kept;
  {
    const std::lock_guard lock(guard_);
    if (const KeptImage* const found = find({frame, camera})) {
      kept = *found;
    } else if (frame < first_kept_) {
      return refusal(410, "the image is no longer kept");
    }
  }
  if (kept.jpeg) return photograph_response(kept.jpeg);
  return kept.pixels ? photograph_response(photograph_jpeg(*kept.pixels)) : no_image();
}

}  // namespace fovea
