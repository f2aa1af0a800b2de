// Open3D's registration, on one thread.
#pragma once

#include "bench/registration_peer.h"

namespace fovea::bench {

__attribute__((visibility("default"))) PeerRegistration open3d_gicp(const RegistrationTask& task);
/// Point to plane.
__attribute__((visibility("default"))) PeerRegistration open3d_icp(const RegistrationTask& task);

}  // namespace fovea::bench
