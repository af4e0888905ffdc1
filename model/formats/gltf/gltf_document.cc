#include "model/formats/gltf/gltf_document.h"

#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::gltf {
namespace {

using Json = nlohmann::json;

constexpr absl::string_view kMagic = "glTF";
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr uint32_t kBinaryVersion = 2;
constexpr absl::string_view kJsonChunk = "JSON", kBinaryChunk = absl::string_view("BIN\0", 4);
constexpr int kMaxDepth = 64;             // tools may nest deeply in `extras`
constexpr std::size_t kMaxItems = 16384;  // of each kind; a scene has more nodes than joints
constexpr std::size_t kMaxSkins = 256;
constexpr std::size_t kMaxNameBytes = 256;
constexpr std::size_t kMaxUriBytes = motion::kMaxMotionFileBytes * 4 / 3 + 64;  // base64 data

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are copied as they are");

uint32_t ReadUint32(absl::string_view bytes, std::size_t at) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

struct Parts {
  absl::string_view json;
  std::optional<std::string> binary;
};

absl::Status Malformed(absl::string_view message) {
  return absl::InvalidArgumentError(absl::StrCat("binary glTF: ", message));
}

// Splits a .glb into its chunks.
absl::StatusOr<Parts> SplitBinary(absl::string_view content) {
  if (content.size() < kHeaderBytes) return Malformed("header: expected 12 bytes, got fewer");
  if (const uint32_t version = ReadUint32(content, 4); version != kBinaryVersion) {
    return Malformed(absl::StrCat("version: expected ", kBinaryVersion, ", got ", version));
  }
  const std::size_t length = ReadUint32(content, 8);
  if (length != content.size()) {
    return Malformed(absl::StrCat("length: expected ", length, " bytes, got ", content.size()));
  }
  Parts parts;
  for (std::size_t at = kHeaderBytes, chunk = 0; at < content.size(); ++chunk) {
    if (content.size() - at < kChunkHeaderBytes)
      return Malformed("chunk header: expected 8 bytes, got fewer");
    const std::size_t size = ReadUint32(content, at);
    const absl::string_view type = content.substr(at + 4, 4);
    at += kChunkHeaderBytes;
    if (size > content.size() - at)
      return Malformed(absl::StrCat("chunk: expected ", size, " bytes, got fewer"));
    const absl::string_view data = content.substr(at, size);
    if (chunk == 0 && type != kJsonChunk)
      return Malformed("first chunk: expected JSON, got another type");
    if (chunk == 0) parts.json = data;
    if (chunk == 1 && type == kBinaryChunk) parts.binary = std::string(data);
    at += size;
  }
  return parts;
}

int Components(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  if (type == "MAT3") return 9;
  if (type == "MAT4") return 16;
  return 0;
}

class DocumentReader {
 public:
  explicit DocumentReader(const Json& root) : root_(root, "") {}

  absl::StatusOr<GltfDocument> Read() {
    ReadAsset();
    ReadEach("buffers", [this](base::ObjectReader* reader) { ReadBuffer(reader); });
    ReadEach("bufferViews", [this](base::ObjectReader* reader) { ReadView(reader); });
    ReadEach("accessors", [this](base::ObjectReader* reader) { ReadAccessor(reader); });
    node_count_ = CountOf("nodes");
    ReadEach("nodes", [this](base::ObjectReader* reader) { ReadNode(reader); });
    if (root_.ok()) root_.Update(LinkNodes());
    ReadEach("skins", [this](base::ObjectReader* reader) { ReadSkin(reader); });
    ReadEach("animations", [this](base::ObjectReader* reader) { ReadAnimation(reader); });
    if (!root_.ok()) return root_.status();
    return std::move(document_);
  }

 private:
  // Calls `read` for every object of an optional array.
  template <typename Read>
  void ReadEach(const std::string& key, Read read) {
    ReadEachOf(&root_, key, read);
  }
  template <typename Read>
  static void ReadEachOf(base::ObjectReader* owner, const std::string& key, Read read) {
    if (!owner->ok() || !owner->Has(key)) return;
    int index = 0;
    for (const Json& item : owner->Array(key, kMaxItems)) {
      base::ObjectReader reader(item, absl::StrCat(owner->PathOf(key), "[", index++, "]"));
      if (reader.ok()) read(&reader);
      owner->Update(reader.status());
      if (!owner->ok()) return;
    }
  }

  std::size_t CountOf(const std::string& key) {
    return root_.ok() && root_.Has(key) ? root_.Array(key, kMaxItems).size() : 0;
  }

  static std::size_t Size(base::ObjectReader* reader, const std::string& key) {
    if (!reader->Has(key)) return 0;
    return static_cast<std::size_t>(reader->Int(key, 0, std::numeric_limits<uint32_t>::max()));
  }

  // An index below `count`.
  static int Index(base::ObjectReader* reader, const std::string& key, std::size_t count) {
    if (count == 0) {
      reader->Fail(key, "expected an index, but the file has no such item");
      return 0;
    }
    return static_cast<int>(reader->Int(key, 0, static_cast<int64_t>(count) - 1));
  }

  static std::string Name(base::ObjectReader* reader, const std::string& otherwise) {
    const std::string name =
        reader->Has("name") ? reader->String("name", kMaxNameBytes) : std::string();
    return name.empty() ? otherwise : name;
  }

  // Reads `count` finite numbers. Leaves `values` unchanged if the field is absent.
  static void Numbers(base::ObjectReader* reader, const std::string& key, std::size_t count,
                      double* values) {
    if (!reader->Has(key)) return;
    const Json& array = reader->Array(key, count);
    if (reader->ok() && array.size() != count) {
      reader->Fail(key, absl::StrCat("expected ", count, " numbers, got ", array.size()));
    }
    for (std::size_t i = 0; i < count && reader->ok(); ++i) {
      const double value =
          array[i].is_number() ? array[i].get<double>() : motion::kMaxCoordinate * 2;
      if (!(value >= -motion::kMaxCoordinate && value <= motion::kMaxCoordinate)) {
        reader->Fail(key, absl::StrCat("expected a number within +-", motion::kMaxCoordinate,
                                       ", got ", base::Shown(array[i])));
        return;
      }
      values[i] = value;
    }
  }

  std::vector<int> Indices(base::ObjectReader* reader, const std::string& key, std::size_t count) {
    std::vector<int> indices;
    for (const Json& item : reader->Array(key, kMaxItems)) {
      const bool fits = item.is_number_unsigned() && item.get<uint64_t>() < count;
      if (!fits) {
        reader->Fail(key,
                     absl::StrCat("expected an index below ", count, ", got ", base::Shown(item)));
        return {};
      }
      indices.push_back(item.get<int>());
    }
    return indices;
  }

  void ReadAsset() {
    const Json& asset = root_.Object("asset");
    if (!root_.ok()) return;
    base::ObjectReader reader(asset, "asset");
    const std::string version = reader.String("version", kMaxNameBytes);
    if (reader.ok() && !absl::StartsWith(version, "2.")) {
      reader.Fail("version", absl::StrCat("expected 2.0, got ", base::Quoted(version)));
    }
    ReadWriter(asset);
    root_.Update(reader.status());
    if (!root_.ok() || !root_.Has("extensionsRequired")) return;
    for (const std::string& extension : root_.Strings("extensionsRequired", kMaxItems)) {
      if (extension == "EXT_meshopt_compression" || extension == "KHR_meshopt_compression") {
        root_.Fail("extensionsRequired", absl::StrCat("expected no compression, got ", extension,
                                                      "; export without compression"));
      }
    }
  }

  // Ignores values of another type: these fields are informative only.
  void ReadWriter(const Json& asset) {
    const auto writer = asset.find("generator");
    if (writer != asset.end() && writer->is_string()) document_.writer = *writer;
    const auto extras = asset.find("extras");
    if (extras == asset.end() || !extras->is_object()) return;
    const auto rate = extras->find("frame_rate_hz");
    if (rate != extras->end() && rate->is_number()) document_.frame_rate_hz = rate->get<double>();
  }

  void ReadBuffer(base::ObjectReader* reader) {
    GltfBuffer buffer;
    buffer.length = Size(reader, "byteLength");
    if (reader->Has("uri")) buffer.uri = reader->String("uri", kMaxUriBytes);
    document_.buffers.push_back(std::move(buffer));
  }

  void ReadView(base::ObjectReader* reader) {
    GltfView view;
    view.buffer = Index(reader, "buffer", document_.buffers.size());
    view.offset = Size(reader, "byteOffset");
    view.length = Size(reader, "byteLength");
    view.stride = Size(reader, "byteStride");
    document_.views.push_back(view);
  }

  void ReadAccessor(base::ObjectReader* reader) {
    GltfAccessor accessor;
    if (reader->Has("bufferView")) {
      accessor.view = Index(reader, "bufferView", document_.views.size());
    }
    accessor.offset = Size(reader, "byteOffset");
    accessor.component_type = static_cast<int>(reader->Int("componentType", 0, 65535));
    accessor.normalized = reader->Has("normalized") && reader->Bool("normalized");
    accessor.count = Size(reader, "count");
    const std::string type = reader->String("type", kMaxNameBytes);
    accessor.components = Components(type);
    if (reader->ok() && accessor.components == 0) {
      reader->Fail("type",
                   absl::StrCat("expected SCALAR, VEC3, VEC4, ..., got ", base::Quoted(type)));
    }
    accessor.sparse = reader->Has("sparse");
    document_.accessors.push_back(accessor);
  }

  void ReadNode(base::ObjectReader* reader) {
    GltfNode node;
    node.name = Name(reader, absl::StrCat("node ", document_.nodes.size()));
    if (reader->Has("children")) node.children = Indices(reader, "children", node_count_);
    double translation[3] = {}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
    Numbers(reader, "translation", 3, translation);
    Numbers(reader, "rotation", 4, rotation);
    Numbers(reader, "scale", 3, scale);
    node.translation = {translation[0], translation[1], translation[2]};
    node.rotation = {rotation[3], rotation[0], rotation[1], rotation[2]};
    node.scale = {scale[0], scale[1], scale[2]};
    if (reader->Has("matrix")) Numbers(reader, "matrix", 16, node.matrix.emplace().data());
    document_.nodes.push_back(std::move(node));
  }

  // Derives parents from children. Rejects a node with two parents or among its own ancestors.
  absl::Status LinkNodes() {
    std::vector<GltfNode>& nodes = document_.nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      for (int child : nodes[n].children) {
        int& parent = nodes[static_cast<size_t>(child)].parent;
        if (parent >= 0) {
          return absl::InvalidArgumentError(absl::StrCat(
              "nodes[", n, "].children: expected one parent for node ", child, ", got two"));
        }
        parent = static_cast<int>(n);
      }
    }
    // Each node has at most one parent, so nodes that no root reaches form a cycle.
    std::vector<int> reached;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (nodes[n].parent < 0) reached.push_back(static_cast<int>(n));
    }
    for (std::size_t next = 0; next < reached.size(); ++next) {
      const GltfNode& node = nodes[static_cast<size_t>(reached[next])];
      for (int child : node.children) nodes[static_cast<size_t>(child)].depth = node.depth + 1;
      if (node.depth > motion::kMaxFileJoints) {
        return absl::InvalidArgumentError(
            absl::StrCat("nodes: expected at most ", motion::kMaxFileJoints, " levels, got more"));
      }
      reached.insert(reached.end(), node.children.begin(), node.children.end());
    }
    if (reached.size() == nodes.size()) return absl::OkStatus();
    return absl::InvalidArgumentError("nodes: expected trees, got a cycle");
  }

  void ReadSkin(base::ObjectReader* reader) {
    GltfSkin skin;
    skin.joints = Indices(reader, "joints", document_.nodes.size());
    if (reader->ok() && (skin.joints.empty() || skin.joints.size() > motion::kMaxFileJoints)) {
      reader->Fail("joints", absl::StrCat("expected 1 to ", motion::kMaxFileJoints, " joints, got ",
                                          skin.joints.size()));
    }
    if (document_.skins.size() == kMaxSkins) {
      reader->Fail("joints", absl::StrCat("expected at most ", kMaxSkins, " skins, got more"));
    }
    document_.skins.push_back(std::move(skin));
  }

  struct Sampler {
    GltfInterpolation interpolation = GltfInterpolation::kLinear;
    int times = 0, values = 0;
  };

  Sampler ReadSampler(base::ObjectReader* reader) {
    Sampler sampler;
    sampler.times = Index(reader, "input", document_.accessors.size());
    sampler.values = Index(reader, "output", document_.accessors.size());
    if (!reader->Has("interpolation")) return sampler;
    const std::string name = reader->String("interpolation", kMaxNameBytes);
    if (name == "STEP") {
      sampler.interpolation = GltfInterpolation::kStep;
    } else if (name == "CUBICSPLINE") {
      sampler.interpolation = GltfInterpolation::kCubicSpline;
    } else if (name != "LINEAR") {
      reader->Fail("interpolation",
                   absl::StrCat("expected LINEAR, STEP or CUBICSPLINE, got ", base::Quoted(name)));
    }
    return sampler;
  }

  void ReadAnimation(base::ObjectReader* reader) {
    GltfAnimation animation;
    animation.name = Name(reader, absl::StrCat("animation ", document_.animations.size()));
    std::vector<Sampler> samplers;
    ReadEachOf(reader, "samplers",
               [&](base::ObjectReader* sampler) { samplers.push_back(ReadSampler(sampler)); });
    std::set<std::pair<int, GltfPath>> targets;
    ReadEachOf(reader, "channels", [&](base::ObjectReader* channel) {
      const Sampler* sampler = FindSampler(channel, samplers);
      const Json& target_json = channel->Object("target");
      if (!channel->ok()) return;
      base::ObjectReader target(target_json, channel->PathOf("target"));
      const std::optional<GltfPath> path = ReadPath(&target);
      if (path.has_value() && target.Has("node")) {
        const int node = Index(&target, "node", document_.nodes.size());
        if (!targets.insert({node, *path}).second) {
          target.Fail("path", "expected one channel per property of a node, got two");
        }
        animation.channels.push_back(
            {node, *path, sampler->interpolation, sampler->times, sampler->values});
      }
      channel->Update(target.status());
    });
    document_.animations.push_back(std::move(animation));
  }

  static const Sampler* FindSampler(base::ObjectReader* channel,
                                    const std::vector<Sampler>& samplers) {
    const int index = Index(channel, "sampler", samplers.size());
    return channel->ok() ? &samplers[static_cast<size_t>(index)] : nullptr;
  }

  // Absent for morph targets and properties of extensions.
  static std::optional<GltfPath> ReadPath(base::ObjectReader* target) {
    const std::string path = target->String("path", kMaxNameBytes);
    if (path == "translation") return GltfPath::kTranslation;
    if (path == "rotation") return GltfPath::kRotation;
    if (path == "scale") return GltfPath::kScale;
    return std::nullopt;
  }

  base::ObjectReader root_;
  std::size_t node_count_ = 0;
  GltfDocument document_;
};

absl::string_view WithoutPrelude(absl::string_view text) {
  return absl::StripLeadingAsciiWhitespace(base::SkipByteOrderMark(text));
}

absl::StatusOr<Parts> Split(absl::string_view content) {
  if (absl::StartsWith(content, kMagic)) return SplitBinary(content);
  if (absl::StartsWith(WithoutPrelude(content), "{")) return Parts{content, std::nullopt};
  return absl::InvalidArgumentError(
      absl::StrCat("expected glTF, a JSON object or binary that starts with \"glTF\", got ",
                   content.empty() ? "an empty file" : "another kind of file"));
}

absl::StatusOr<GltfDocument> Parse(absl::string_view content) {
  absl::StatusOr<Parts> parts = Split(content);
  if (!parts.ok()) return parts.status();
  const absl::StatusOr<Json> json = base::ParseHandwrittenJson(parts->json, kMaxDepth);
  if (!json.ok()) return json.status();
  absl::StatusOr<GltfDocument> document = DocumentReader(*json).Read();
  if (document.ok()) document->binary = std::move(parts->binary);
  return document;
}

}  // namespace

absl::string_view JsonOf(absl::string_view content) { return Split(content)->json; }

absl::StatusOr<GltfDocument> ParseGltf(absl::string_view content, absl::string_view source) {
  absl::StatusOr<GltfDocument> document = Parse(content);
  if (document.ok()) return document;
  return absl::InvalidArgumentError(absl::StrCat(source, ": ", document.status().message()));
}

}  // namespace duet::formats::gltf
