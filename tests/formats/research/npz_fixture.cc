#include "tests/formats/research/npz_fixture.h"

#include <zlib.h>

#include <cstddef>
#include <cstdint>

#include "model/formats/research/body_joints.h"

namespace duet::test {
namespace {

// The least significant byte first.
void Append(std::uint32_t value, int bytes, std::string* out) {
  for (int i = 0; i < bytes; ++i, value >>= 8) out->push_back(static_cast<char>(value & 0xff));
}

std::string Deflated(const std::string& content) {
  z_stream stream = {};
  deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, static_cast<uLong>(content.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

}  // namespace

std::string Array(const std::vector<int>& shape, const std::vector<float>& values) {
  return formats::flat::FormatNpyArray(shape, values);
}

std::string MakeNpz(const std::map<std::string, std::string>& arrays, Packed packed) {
  std::string bytes, directory;
  for (const auto& [array, content] : arrays) {
    const std::string name = array + ".npy";
    const std::string data = packed == Packed::kDeflated ? Deflated(content) : content;
    const auto crc = static_cast<std::uint32_t>(crc32(
        0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())));
    std::string fields;
    Append(packed == Packed::kDeflated ? 8 : 0, 2, &fields);
    Append(0, 4, &fields);  // time and date
    Append(crc, 4, &fields);
    Append(static_cast<std::uint32_t>(data.size()), 4, &fields);
    Append(static_cast<std::uint32_t>(content.size()), 4, &fields);
    Append(static_cast<std::uint32_t>(name.size()), 2, &fields);
    Append(0x02014b50, 4, &directory);
    Append(20 | 20 << 16, 4, &directory);
    Append(0, 2, &directory);
    directory += fields;
    Append(0, 2 + 2 + 2 + 2 + 4, &directory);
    Append(static_cast<std::uint32_t>(bytes.size()), 4, &directory);
    directory += name;
    Append(0x04034b50, 4, &bytes);
    Append(20, 2, &bytes);
    Append(0, 2, &bytes);
    bytes += fields;
    Append(4, 2, &bytes);  // an extra field, which the directory does not have
    bytes += name;
    Append(0, 4, &bytes);
    bytes += data;
  }
  const auto at = static_cast<std::uint32_t>(bytes.size());
  bytes += directory;
  Append(0x06054b50, 4, &bytes);
  Append(0, 4, &bytes);
  for (int i = 0; i < 2; ++i) Append(static_cast<std::uint32_t>(arrays.size()), 2, &bytes);
  Append(static_cast<std::uint32_t>(directory.size()), 4, &bytes);
  Append(at, 4, &bytes);
  Append(0, 2, &bytes);
  return bytes;
}

formats::research::BodyPose TinyBodyJoints() {
  return {{0, 0.1, 0},       {0.1, 0, 0},        {-0.1, 0, 0},   {0, 0.2, 0},     {0.1, -0.4, 0},
          {-0.1, -0.4, 0},   {0, 0.3, 0},        {0.1, -0.8, 0}, {-0.1, -0.8, 0}, {0, 0.4, 0},
          {0.1, -0.85, 0.1}, {-0.1, -0.85, 0.1}, {0, 0.6, 0},    {0.08, 0.5, 0},  {-0.08, 0.5, 0},
          {0, 0.7, 0},       {0.2, 0.5, 0},      {-0.2, 0.5, 0}, {0.5, 0.5, 0},   {-0.5, 0.5, 0},
          {0.75, 0.5, 0},    {-0.75, 0.5, 0}};
}

std::map<std::string, std::string> TinyBodyModel() {
  using namespace formats::research;  // NOLINT: the joints' names
  std::vector<float> vertices, shapes(kBodyJoints * 3 * 2), regressor, table;
  for (const retargeting::Vec3d& joint : TinyBodyJoints()) {
    for (const double axis : {joint.x, joint.y, joint.z}) {
      vertices.push_back(static_cast<float>(axis));
    }
  }
  const auto shape = [&shapes](int joint, int axis, int of) -> float& {
    return shapes[static_cast<std::size_t>((joint * 3 + axis) * 2 + of)];
  };
  shape(kLeftHip, 0, 0) = 0.1f;
  shape(kRightHip, 0, 0) = -0.1f;
  shape(kHead, 1, 1) = 1;
  for (int i = 0; i < kBodyJoints * kBodyJoints; ++i) {
    regressor.push_back(i / kBodyJoints == i % kBodyJoints ? 1 : 0);
  }
  for (const int parent : BodyParents()) {
    table.push_back(parent < 0 ? 4294967295.f : static_cast<float>(parent));
  }
  for (int joint = 0; joint < kBodyJoints; ++joint) table.push_back(static_cast<float>(joint));
  return {{"v_template", Array({kBodyJoints, 3}, vertices)},
          {"shapedirs", Array({kBodyJoints, 3, 2}, shapes)},
          {"J_regressor", Array({kBodyJoints, kBodyJoints}, regressor)},
          {"kintree_table", Array({2, kBodyJoints}, table)}};
}

}  // namespace duet::test
