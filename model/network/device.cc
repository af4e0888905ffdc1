#include "model/network/device.h"

#include <torch/torch.h>

#include "absl/strings/str_cat.h"

namespace duet::network {

absl::Status CheckDevice(const std::string& device) {
  if (device == "cpu" || (device == "cuda" && torch::cuda::is_available())) {
    return absl::OkStatus();
  }
  return absl::FailedPreconditionError(absl::StrCat(
      "device: expected one that LibTorch can use (cpu; cuda if LibTorch was built with "
      "it and finds an accelerator), got ",
      device));
}

}  // namespace duet::network
