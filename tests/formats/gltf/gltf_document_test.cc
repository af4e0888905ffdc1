#include "model/formats/gltf/gltf_document.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "tests/formats/gltf/gltf_fixture.h"
#include "tests/support/matchers.h"

namespace duet::formats::gltf {
namespace {

std::string ParseError(const std::string& content) {
  const absl::StatusOr<GltfDocument> document = ParseGltf(content, "a.gltf");
  EXPECT_EQ(document.status().code(), absl::StatusCode::kInvalidArgument) << document.status();
  return std::string(document.status().message());
}

// A document with these fields.
std::string With(const std::string& fields) {
  return absl::StrCat(R"({"asset": {"version": "2.0"}, )", fields, "}");
}

constexpr char kArm[] = R"({
  "asset": {"version": "2.0", "generator": "a test"}, "scene": 0,
  "nodes": [{"name": "fore arm"}, {"children": [0], "rotation": [1, 0, 0, 0], "mesh": 3},
            {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]}],
  "skins": [{"joints": [1, 0], "inverseBindMatrices": 9}],
  "buffers": [{"byteLength": 64}],
  "bufferViews": [{"buffer": 0, "byteOffset": 4, "byteLength": 60, "byteStride": 12}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"},
                {"bufferView": 0, "byteOffset": 8, "componentType": 5122, "normalized": true,
                 "count": 2, "type": "VEC4"}],
  "animations": [{"samplers": [{"input": 0, "output": 1, "interpolation": "STEP"}],
                  "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}},
                               {"sampler": 0, "target": {"node": 0, "path": "weights"}},
                               {"sampler": 0, "target": {"path": "scale"}}]}]
})";

TEST(GltfDocument, ReadsNodesSkinsAndAnimations) {
  const absl::StatusOr<GltfDocument> document =
      ParseGltf(absl::StrCat("\xEF\xBB\xBF\n", kArm), "a.gltf");
  ASSERT_TRUE(document.ok()) << document.status();
  ASSERT_EQ(document->nodes.size(), 3u);
  EXPECT_EQ(document->nodes[0].name, "fore arm");
  EXPECT_EQ(document->nodes[0].parent, 1);
  EXPECT_EQ(document->nodes[0].depth, 1);
  EXPECT_EQ(document->nodes[1].name, "node 1");
  EXPECT_EQ(document->nodes[1].rotation.x, 1);
  EXPECT_EQ(document->nodes[1].rotation.w, 0);
  ASSERT_TRUE(document->nodes[2].matrix.has_value());
  EXPECT_EQ((*document->nodes[2].matrix)[13], 6);
  EXPECT_THAT(document->skins[0].joints, ElementsAre(1, 0));
  ASSERT_EQ(document->animations.size(), 1u);
  EXPECT_EQ(document->animations[0].name, "animation 0");
  ASSERT_EQ(document->animations[0].channels.size(), 1u);
  EXPECT_EQ(document->animations[0].channels[0].interpolation, GltfInterpolation::kStep);
  EXPECT_EQ(document->animations[0].channels[0].values, 1);
  EXPECT_EQ(document->accessors[1].offset, 8u);
  EXPECT_TRUE(document->accessors[1].normalized);
  EXPECT_EQ(document->views[0].stride, 12u);
  EXPECT_FALSE(document->binary.has_value());
}

TEST(GltfDocument, ReadsTheChunksOfABinaryFile) {
  const absl::StatusOr<GltfDocument> document =
      ParseGltf(test::BinaryGltf(kArm, "12345678"), "a.glb");
  ASSERT_TRUE(document.ok()) << document.status();
  EXPECT_EQ(document->nodes.size(), 3u);
  EXPECT_EQ(document->binary, "12345678");
}

TEST(GltfDocument, RejectsOtherKindsOfFiles) {
  EXPECT_THAT(ParseError(""), HasSubstr("a.gltf: expected glTF, a JSON object or binary"));
  EXPECT_THAT(ParseError(""), HasSubstr("got an empty file"));
  EXPECT_THAT(ParseError("glT"), HasSubstr("got another kind of file"));
  EXPECT_THAT(ParseError("HIERARCHY"), HasSubstr("got another kind of file"));
}

TEST(GltfDocument, RejectsInvalidBinaryFiles) {
  std::string binary = test::BinaryGltf(kArm, "1234");
  EXPECT_THAT(ParseError(binary.substr(0, 11)),
              HasSubstr("binary glTF: header: expected 12 bytes, got fewer"));
  EXPECT_THAT(ParseError(binary.substr(0, 100)), HasSubstr("bytes, got 100"));
  std::string first = binary;
  first[4] = 1;
  EXPECT_THAT(ParseError(first), HasSubstr("version: expected 2, got 1"));
  std::string chunk = binary;
  chunk[15] = 127;
  EXPECT_THAT(ParseError(chunk), HasSubstr("bytes, got fewer"));
  std::string type = binary;
  type[16] = 'X';
  EXPECT_THAT(ParseError(type), HasSubstr("first chunk: expected JSON, got another type"));
  std::string tail = binary + "abcd";
  tail[8] = static_cast<char>(tail[8] + 4);
  EXPECT_THAT(ParseError(tail), HasSubstr("chunk header: expected 8 bytes, got fewer"));
}

TEST(GltfDocument, NamesThePlaceOfAnError) {
  EXPECT_THAT(ParseError("{}"), HasSubstr("a.gltf: asset: missing"));
  EXPECT_THAT(ParseError(R"({"asset": {"version": "1.0"}})"),
              HasSubstr("a.gltf: asset.version: expected 2.0, got \"1.0\""));
  EXPECT_THAT(ParseError(With(R"("nodes": [{}, {"rotation": [0, 0, 1]}])")),
              HasSubstr("nodes[1].rotation: expected 4 numbers, got 3"));
  EXPECT_THAT(ParseError(With(R"("nodes": [{"translation": [0, "a", 1]}])")),
              HasSubstr("nodes[0].translation: expected a number within +-1e+07, got \"a\""));
  EXPECT_THAT(ParseError(With(R"("nodes": [{"scale": [0, 1e30, 1]}])")),
              HasSubstr("nodes[0].scale: expected a number within +-1e+07, got 1e+30"));
  EXPECT_THAT(ParseError(With(R"("nodes": [{"children": [1]}])")),
              HasSubstr("nodes[0].children: expected an index below 1, got 1"));
  EXPECT_THAT(ParseError(With(R"("nodes": [{"children": [-1]}])")), HasSubstr("an index below"));
  EXPECT_THAT(ParseError(With(R"("nodes": 7)")), HasSubstr("nodes: expected an array"));
  EXPECT_THAT(ParseError(With(R"("skins": [{"joints": []}])")),
              HasSubstr("joints: expected 1 to 1024 joints, got 0"));
  EXPECT_THAT(ParseError(With(R"("bufferViews": [{"buffer": 0, "byteLength": 4}])")),
              HasSubstr("bufferViews[0].buffer: expected an index, but"));
  EXPECT_THAT(ParseError(With(R"("accessors": [{"componentType": 5126, "type": "VEC9"}])")),
              HasSubstr("accessors[0].type: expected SCALAR, VEC3, VEC4, ..., got \"VEC9\""));
  EXPECT_THAT(ParseError(With(R"("animations": [{"channels": [{"sampler": 0}]}])")),
              HasSubstr("animations[0].channels[0].sampler: expected an index, but"));
  EXPECT_THAT(ParseError(With(R"("extensionsRequired": ["EXT_meshopt_compression"])")),
              HasSubstr("export without compression"));
}

TEST(GltfDocument, RejectsInvalidChannels) {
  std::string text = kArm;
  text.replace(text.find("STEP"), 4, "CURL");
  EXPECT_THAT(
      ParseError(text),
      HasSubstr("animations[0].samplers[0].interpolation: expected LINEAR, STEP or CUBICSPLINE"));
  text = kArm;
  text.replace(text.find("weights"), 7, "rotation");
  EXPECT_THAT(ParseError(text), HasSubstr("channels[1].target.path: expected one channel"));
}

TEST(GltfDocument, RejectsNodesThatAreNotTrees) {
  EXPECT_THAT(ParseError(With(R"("nodes": [{"children": [2]}, {"children": [2]}, {}])")),
              HasSubstr("nodes[1].children: expected one parent for node 2, got two"));
  EXPECT_THAT(ParseError(With(R"("nodes": [{"children": [1]}, {"children": [0]}, {}])")),
              HasSubstr("nodes: expected trees, got a cycle"));
  EXPECT_THAT(ParseError(With(R"("nodes": [{"children": [0]}])")),
              HasSubstr("nodes: expected trees, got a cycle"));
  std::string chain;
  for (int i = 1; i < 2000; ++i) absl::StrAppend(&chain, "{\"children\": [", i, "]},");
  EXPECT_THAT(ParseError(With(absl::StrCat("\"nodes\": [", chain, "{}]"))),
              HasSubstr("nodes: expected at most 1024 levels, got more"));
}

}  // namespace
}  // namespace duet::formats::gltf
