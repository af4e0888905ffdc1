#ifndef DUET_MODEL_NETWORK_DEVICE_H_
#define DUET_MODEL_NETWORK_DEVICE_H_

#include <string>

#include "absl/status/status.h"

namespace duet::network {

// Returns OK if LibTorch can use a device: "cpu", or "cuda" if LibTorch was built with it and finds
// an accelerator. Otherwise FAILED_PRECONDITION, with the reason.
absl::Status CheckDevice(const std::string& device);

}  // namespace duet::network

#endif  // DUET_MODEL_NETWORK_DEVICE_H_
