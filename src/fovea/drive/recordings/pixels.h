// The pixels of an Image message.
#pragma once

#include <string>
#include <string_view>

#include "fovea/drive/recordings/ros_messages.h"
#include "fovea/image.h"

namespace fovea {

/// Whether images of this encoding (sensor_msgs/image_encodings.hpp) are read: mono, RGB, BGR with
/// or without alpha, Bayer patterns and YUV 4:2:2, of eight bits.
bool is_known_encoding(std::string_view encoding);

/// The image as grey or RGB; Bayer patterns are interpolated bilinearly. InputError that names
/// `where` for another encoding, sides over 8192 and fewer data than the image takes.
Image image_of(const ros::ImageMessage& message, const std::string& where);

/// What the bytes of a file begin with.
inline bool is_png(std::string_view bytes) { return bytes.starts_with("\x89PNG\r\n\x1a\n"); }
inline bool is_jpeg(std::string_view bytes) { return bytes.starts_with("\xff\xd8\xff"); }

/// Of a file with the bytes of a compressed image: ".png" or ".jpg". InputError that names `where`
/// for other formats.
std::string_view extension_of(const ros::CompressedImage& image, const std::string& where);

}  // namespace fovea
