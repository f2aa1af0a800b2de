#include "fovea/drive/bridge/pose_schemas.h"

#include <string_view>
#include <utility>

namespace fovea::bridge {
namespace {

constexpr std::string_view kHeader = R"(MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
)";
constexpr std::string_view kTime = R"(MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
)";
constexpr std::string_view kRos1Header = R"(MSG: std_msgs/Header
uint32 seq
time stamp
string frame_id
)";
constexpr std::string_view kVector = R"(MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
)";
constexpr std::string_view kPoint = R"(MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
)";
constexpr std::string_view kQuaternion = R"(MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
)";
constexpr std::string_view kPose = R"(MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
)";
constexpr std::string_view kTwist = R"(MSG: geometry_msgs/Twist
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
)";
constexpr std::string_view kPoseWithCovariance = R"(MSG: geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance
)";
constexpr std::string_view kTwistWithCovariance = R"(MSG: geometry_msgs/TwistWithCovariance
geometry_msgs/Twist twist
float64[36] covariance
)";
constexpr std::string_view kTransform = R"(MSG: geometry_msgs/Transform
geometry_msgs/Vector3 translation
geometry_msgs/Quaternion rotation
)";
constexpr std::string_view kTransformStamped = R"(MSG: geometry_msgs/TransformStamped
std_msgs/Header header
string child_frame_id
geometry_msgs/Transform transform
)";

void append_type(std::string& schema, std::string_view type) {
  schema.append(80, '=');
  schema += '\n';
  schema += type;
}

std::string with_header(std::string schema, bool is_ros1) {
  append_type(schema, is_ros1 ? kRos1Header : kHeader);
  if (!is_ros1) append_type(schema, kTime);
  return schema;
}

}  // namespace

std::string odometry_schema(bool is_ros1) {
  std::string schema = R"(std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
geometry_msgs/TwistWithCovariance twist
)";
  for (const std::string_view type :
       {kPoseWithCovariance, kTwistWithCovariance, kPose, kTwist, kPoint, kQuaternion, kVector}) {
    append_type(schema, type);
  }
  return with_header(std::move(schema), is_ros1);
}

std::string transforms_schema(bool is_ros1) {
  std::string schema = "geometry_msgs/TransformStamped[] transforms\n";
  for (const std::string_view type : {kTransformStamped, kTransform, kVector, kQuaternion}) {
    append_type(schema, type);
  }
  return with_header(std::move(schema), is_ros1);
}

std::string string_schema() { return "string data\n"; }

}  // namespace fovea::bridge
