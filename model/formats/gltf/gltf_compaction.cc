#include "model/formats/gltf/gltf_compaction.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "absl/strings/match.h"

namespace duet::formats::gltf {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kAlignment = 4;

// Prefixes of extensions that refer to no accessor and no view.
constexpr const char* kHarmless[] = {
    "KHR_materials_",        "KHR_texture_", "EXT_texture_", "KHR_lights_",
    "KHR_mesh_quantization", "KHR_xmp",      "VRM",          "KHR_node_"};

bool IsHarmless(const ordered_json& extension) {
  if (!extension.is_string()) return false;
  for (const char* beginning : kHarmless) {
    if (absl::StartsWith(extension.get_ref<const std::string&>(), beginning)) return true;
  }
  return false;
}

// Finds the used accessors and views, then rewrites the document without the others. Leaves the
// document unchanged if any index, range or extension is not understood.
class Compaction {
 public:
  Compaction(ordered_json* json, std::string* buffer) : json_(*json), buffer_(*buffer) {}

  void Run() {
    const auto mark_view = [this](const ordered_json& index) { Mark(index, &views_); };
    for (const ordered_json& extension : List("extensionsUsed")) sound_ &= IsHarmless(extension);
    accessors_.assign(List("accessors").size(), kUnused);
    views_.assign(List("bufferViews").size(), kUnused);
    ForEachAccessorUse([this](ordered_json& index) { Mark(index, &accessors_); });
    for (std::size_t i = 0; i < accessors_.size() && sound_; ++i) {
      if (accessors_[i] != kUnused) ForEachView(json_["accessors"][i], mark_view);
    }
    ForEachImageView(mark_view);
    for (std::size_t i = 0; i < views_.size() && sound_; ++i) {
      if (views_[i] != kUnused) CheckRange(json_["bufferViews"][i]);
    }
    if (sound_) Rewrite();
  }

 private:
  static constexpr int kUnused = -1, kUsed = 0;

  // An array of the document, or an empty array.
  const ordered_json& List(const char* name) const {
    static const ordered_json* const kEmpty = new ordered_json(ordered_json::array());
    const auto found = json_.find(name);
    return found != json_.end() && found->is_array() ? *found : *kEmpty;
  }

  template <typename Action>
  void ForEachAccessorUse(const Action& action) {
    if (List("meshes").size() > 0) {
      for (ordered_json& mesh : json_["meshes"]) {
        if (!mesh.contains("primitives")) continue;
        for (ordered_json& primitive : mesh["primitives"]) ForEachOfPrimitive(primitive, action);
      }
    }
    if (List("skins").size() > 0) {
      for (ordered_json& skin : json_["skins"]) {
        if (skin.contains("inverseBindMatrices")) action(skin["inverseBindMatrices"]);
      }
    }
  }

  template <typename Action>
  static void ForEachOfPrimitive(ordered_json& primitive, const Action& action) {
    if (primitive.contains("attributes")) {
      for (auto& [name, index] : primitive["attributes"].items()) action(index);
    }
    if (primitive.contains("indices")) action(primitive["indices"]);
    if (!primitive.contains("targets")) return;
    for (ordered_json& target : primitive["targets"]) {
      for (auto& [name, index] : target.items()) action(index);
    }
  }

  template <typename Action>
  static void ForEachView(ordered_json& accessor, const Action& action) {
    if (accessor.contains("bufferView")) action(accessor["bufferView"]);
    if (!accessor.contains("sparse")) return;
    for (const char* part : {"indices", "values"}) {
      ordered_json& sparse = accessor["sparse"];
      if (sparse.contains(part) && sparse[part].contains("bufferView")) {
        action(sparse[part]["bufferView"]);
      }
    }
  }

  template <typename Action>
  void ForEachImageView(const Action& action) {
    if (List("images").size() == 0) return;
    for (ordered_json& image : json_["images"]) {
      if (image.contains("bufferView")) action(image["bufferView"]);
    }
  }

  void Mark(const ordered_json& index, std::vector<int>* places) {
    sound_ = sound_ && index.is_number_unsigned() && index.get<std::size_t>() < places->size();
    if (sound_) (*places)[index.get<std::size_t>()] = kUsed;
  }

  void CheckRange(const ordered_json& view) {
    const auto begin = view.find("byteOffset"), length = view.find("byteLength");
    sound_ = begin != view.end() && length != view.end() && begin->is_number_unsigned() &&
             length->is_number_unsigned() && begin->get<std::size_t>() <= buffer_.size() &&
             length->get<std::size_t>() <= buffer_.size() - begin->get<std::size_t>();
  }

  // Keeps the used items of an array and sets `places` to their new indices.
  void Keep(const char* name, std::vector<int>* places) {
    ordered_json kept = ordered_json::array();
    for (std::size_t i = 0; i < places->size(); ++i) {
      if ((*places)[i] == kUnused) continue;
      (*places)[i] = static_cast<int>(kept.size());
      kept.push_back(std::move(json_[name][i]));
    }
    if (kept.empty()) {
      json_.erase(name);
    } else {
      json_[name] = std::move(kept);
    }
  }

  void Rewrite() {
    const auto move_to = [](const std::vector<int>& places) {
      return [&places](ordered_json& index) { index = places[index.get<std::size_t>()]; };
    };
    Keep("accessors", &accessors_);
    Keep("bufferViews", &views_);
    ForEachAccessorUse(move_to(accessors_));
    if (List("accessors").size() > 0) {
      for (ordered_json& accessor : json_["accessors"]) ForEachView(accessor, move_to(views_));
    }
    ForEachImageView(move_to(views_));
    std::string bytes;
    if (List("bufferViews").size() > 0) {
      for (ordered_json& view : json_["bufferViews"]) {
        const std::size_t begin = bytes.size();
        bytes.append(buffer_, view["byteOffset"].get<std::size_t>(),
                     view["byteLength"].get<std::size_t>());
        bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment, '\0');
        view["byteOffset"] = begin;
      }
    }
    buffer_ = std::move(bytes);
  }

  ordered_json& json_;
  std::string& buffer_;
  bool sound_ = true;
  // The state of each item, then its index after compaction.
  std::vector<int> accessors_, views_;
};

}  // namespace

void DropAnimations(ordered_json* json, std::string* buffer) {
  json->erase("animations");
  Compaction(json, buffer).Run();
}

}  // namespace duet::formats::gltf
