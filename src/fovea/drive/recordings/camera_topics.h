// Which topics are cameras, and their calibration.
#pragma once

#include <string>
#include <vector>

#include "fovea/drive/recordings/bag_index.h"
#include "fovea/drive/recordings/convert_options.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

struct PlannedCamera {
  std::string topic;
  RecordedCamera camera;
};

/// The optics that a CameraInfo says. InputError that names `topic` where there are none, or none
/// that are read: an unknown distortion model, binning, a region of interest.
/// @param rectified  of an image that is rectified already: its P instead of its K and D
LensCamera optics_of(const ros::CameraInfo& info, bool rectified, const std::string& topic);

/// The cameras: those of the options, or every topic of images that has calibration and place; of
/// two topics of the same name the plain one before the compressed, the raw one before the
/// rectified. Empty, with a note, if the recording has no images. InputError if one of the options,
/// or all topics, have no calibration or place; or if there are over ten.
/// @param lidar_frame  of the scans
/// @param notes        which topics are left out, and why
std::vector<PlannedCamera> plan_cameras(const BagIndex& index, const ConvertOptions& options,
                                        const std::string& lidar_frame,
                                        std::vector<std::string>& notes);

}  // namespace fovea
