// The keys of a map's table `meta` (docs/map-format.md): their one list.
#pragma once

#include <array>
#include <string_view>

namespace fovea::meta_key {

// The store's own.
inline constexpr const char* kFormatVersion = "format_version";

// What was mapped, and with what.
inline constexpr const char* kFoveaVersion = "fovea.version";
inline constexpr const char* kDriveName = "drive.name";
inline constexpr const char* kDriveKind = "drive.kind";
inline constexpr const char* kCameras = "cameras";
inline constexpr const char* kMasks = "masks";  // of the images: camera and fingerprint
inline constexpr const char* kFramesBegin = "frames.begin";
inline constexpr const char* kFramesEnd = "frames.end";
inline constexpr const char* kHoldOut = "hold_out";
inline constexpr const char* kPoses = "poses";
inline constexpr const char* kImu = "imu";  // absent: none was used
inline constexpr const char* kVariant = "variant";
inline constexpr const char* kConfig = "config";
inline constexpr const char* kNotes = "notes";
inline constexpr const char* kComplete = "complete";

// Calibration; the prefix is followed by the number of a camera and one of the endings.
inline constexpr const char* kCalibration = "calibration";
inline constexpr const char* kCalibrationPrefix = "calibration.camera_";
inline constexpr const char* kRotationEnding = ".rotation_rad";
inline constexpr const char* kTranslationEnding = ".translation_m";
inline constexpr const char* kDelayEnding = ".delay_s";
inline constexpr const char* kImuRotation = "calibration.imu.rotation_rad";
inline constexpr const char* kImuDelay = "calibration.imu.delay_s";

// The cameras; the prefix is followed by the numbers of a drive and of its camera, "0.2". Excluded
// from the digest, so that maps from before these keys are equal to new ones.
inline constexpr const char* kCameraModelPrefix = "camera_model.";

// Geometry.
inline constexpr const char* kTileSize = "map.tile_size_m";
inline constexpr const char* kGeoreferenced = "georeferenced";
inline constexpr const char* kOriginLatitude = "origin.latitude_deg";
inline constexpr const char* kOriginLongitude = "origin.longitude_deg";
inline constexpr const char* kOriginHeight = "origin.height_m";

// What became of the map later.
inline constexpr const char* kCrop = "crop";
inline constexpr const char* kRepair = "repair";

/// Keys with this prefix are excluded from the digest.
inline constexpr const char* kTimingPrefix = "timing.";

/// All keys and prefixes, for the test of docs/map-format.md.
inline constexpr std::array<std::string_view, 30> kAll = {
    kFormatVersion,
    kFoveaVersion,
    kDriveName,
    kDriveKind,
    kCameras,
    kFramesBegin,
    kFramesEnd,
    kHoldOut,
    kPoses,
    kVariant,
    kConfig,
    kNotes,
    kComplete,
    kCalibration,
    kCalibrationPrefix,
    kRotationEnding,
    kTranslationEnding,
    kDelayEnding,
    kImuRotation,
    kImuDelay,
    kCameraModelPrefix,
    kTileSize,
    kGeoreferenced,
    kOriginLatitude,
    kOriginLongitude,
    kOriginHeight,
    kCrop,
    kRepair,
    kTimingPrefix,
    kImu,
};

}  // namespace fovea::meta_key
