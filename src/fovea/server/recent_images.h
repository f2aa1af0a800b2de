// The latest images of a drive that cannot be read again.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "fovea/server/frame_images.h"

namespace fovea {

/// Keeps the images of the latest frames in memory. A thread of low priority compresses them.
class RecentImages : public FrameImages {
 public:
  static constexpr std::size_t kCapacity = std::size_t{64} << 20;

  /// @param drive     a live drive
  /// @param capacity  of images, bytes. The oldest frames leave first; the newest one stays
  explicit RecentImages(DriveInfo drive, std::size_t capacity = kCapacity);
  const DriveInfo& info() const override { return info_; }

  /// Copies the images of the next frame.
  void add(const Frame& frame) override;

 private:
  struct KeptImage {
    std::shared_ptr<const Image> pixels;      ///< null once it is compressed
    std::shared_ptr<const std::string> jpeg;  ///< or null
    std::size_t size() const { return pixels ? pixels->data.size() : jpeg->size(); }
  };
  /// By number of the camera.
  using KeptFrame = std::map<int, KeptImage>;
  struct Place {
    int frame = 0, camera = 0;
  };

  /// Status 410 if the image was kept earlier, or belongs to an earlier run.
  WebResponse image(int frame, int camera) const override;
  void compress_images(const std::stop_token& stop);
  // Under the guard.
  const KeptImage* find(const Place& place) const;
  std::optional<Place> newest_pixels() const;
  void drop_oldest();

  const DriveInfo info_;
  const std::size_t capacity_;
  mutable std::mutex guard_;  // of all below
  std::condition_variable_any changed_;
  std::map<int, KeptFrame> frames_;
  std::size_t bytes_ = 0;
  int first_kept_;  // earlier frames are not kept
  std::jthread compressor_;
};

}  // namespace fovea
