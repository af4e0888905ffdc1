#include "model/network/parameters.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"

namespace duet::network {
namespace {

std::string ShapeText(at::IntArrayRef shape) {
  return absl::StrCat("[", absl::StrJoin(shape, ", "), "]");
}

}  // namespace

std::map<std::string, torch::Tensor> NamedModule::tensors() const {
  std::map<std::string, torch::Tensor> views;
  for (const auto& [name, tensor] : by_name_) views[name] = tensor.detach();
  return views;
}

void NamedModule::Add(const std::string& name, const torch::Tensor& value, bool is_learnt) {
  const std::string plain =
      absl::StrReplaceAll(name, {{".", "/"}});  // LibTorch does not allow dots
  by_name_[name] = is_learnt ? register_parameter(plain, value) : register_buffer(plain, value);
}

torch::Tensor NamedModule::Named(const std::string& name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? torch::Tensor() : found->second;
}

absl::Status LoadTensors(const checkpoint::Checkpoint& checkpoint,
                         std::map<std::string, torch::Tensor> wanted) {
  for (const checkpoint::Tensor& tensor : checkpoint.tensors) {
    const auto it = wanted.find(tensor.name);
    if (it == wanted.end()) {
      return absl::InvalidArgumentError(absl::StrCat("tensor \"", tensor.name, "\" is unknown"));
    }
    if (it->second.sizes() != at::IntArrayRef(tensor.shape)) {
      return absl::InvalidArgumentError(
          absl::StrCat("tensor \"", tensor.name, "\": expected the shape ",
                       ShapeText(it->second.sizes()), ", got ", ShapeText(tensor.shape)));
    }
    it->second.copy_(torch::from_blob(const_cast<float*>(tensor.values.data()), tensor.shape));
    wanted.erase(it);
  }
  if (wanted.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("tensor \"", wanted.begin()->first, "\" is missing"));
}

std::vector<checkpoint::Tensor> StoreTensors(const checkpoint::Manifest& manifest,
                                             const std::map<std::string, torch::Tensor>& values) {
  std::vector<checkpoint::Tensor> tensors;
  for (const checkpoint::TensorSpec& spec : ExpectedTensors(manifest)) {
    const torch::Tensor value = values.at(spec.name).contiguous();
    const float* data = value.data_ptr<float>();
    tensors.push_back({spec.name, spec.shape, std::vector<float>(data, data + value.numel())});
  }
  return tensors;
}

}  // namespace duet::network
