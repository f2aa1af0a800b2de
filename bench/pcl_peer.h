// PCL's registration.
#pragma once

#include "bench/registration_peer.h"

namespace fovea::bench {

__attribute__((visibility("default"))) PeerRegistration pcl_gicp(const RegistrationTask& task);
/// Point to point.
__attribute__((visibility("default"))) PeerRegistration pcl_icp(const RegistrationTask& task);

}  // namespace fovea::bench
