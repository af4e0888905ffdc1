#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/formats/gltf/gltf_document.h"
#include "tests/formats/gltf/gltf_fixture.h"
#include "tests/support/matchers.h"

namespace duet::formats::gltf {
namespace {

absl::StatusOr<std::string> NoFiles(const std::string& name) {
  return absl::NotFoundError(name + ": no such file");
}

absl::StatusOr<std::vector<float>> Read(const std::string& content, int components,
                                        const GltfFileReader& read_file = NoFiles) {
  const absl::StatusOr<GltfDocument> document = ParseGltf(content, "a.glb");
  EXPECT_TRUE(document.ok()) << document.status();
  return GltfBuffers(*document, read_file).Read(0, components);
}

std::string ReadError(const std::string& content, int components) {
  const absl::StatusOr<std::vector<float>> values = Read(content, components);
  EXPECT_EQ(values.status().code(), absl::StatusCode::kInvalidArgument) << values.status();
  return std::string(values.status().message());
}

class Buffers : public ::testing::Test {
 protected:
  Buffers() { builder_.AddAccessor({1, 2, 3, 4, 5, 6}, "VEC3"); }
  nlohmann::json& Accessor() { return builder_.json()["accessors"][0]; }
  nlohmann::json& View() { return builder_.json()["bufferViews"][0]; }
  nlohmann::json& Buffer() { return builder_.json()["buffers"][0]; }

  test::GltfBuilder builder_;
};

TEST_F(Buffers, ReadFloats) {
  EXPECT_THAT(*Read(builder_.Binary(), 3), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(*Read(builder_.WithDataUri(), 3), ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST_F(Buffers, FollowOffsetsAndStrides) {
  Accessor()["byteOffset"] = 4;
  Accessor()["type"] = "SCALAR";
  View()["byteStride"] = 12;
  EXPECT_THAT(*Read(builder_.Binary(), 1), ElementsAre(2, 5));
  View()["byteOffset"] = 4;
  View()["byteLength"] = 20;
  EXPECT_THAT(*Read(builder_.Binary(), 1), ElementsAre(3, 6));
}

TEST_F(Buffers, ScaleNormalizedNumbers) {
  Accessor()["type"] = "SCALAR";
  Accessor()["count"] = 4;
  Accessor()["normalized"] = true;
  const auto read_as = [this](int type, const std::string& bytes) {
    builder_.buffer().replace(0, bytes.size(), bytes);
    Accessor()["componentType"] = type;
    return *Read(builder_.Binary(), 1);
  };
  EXPECT_THAT(read_as(5120, std::string("\x7f\x81\x80\x00", 4)), ElementsAre(1, -1, -1, 0));
  EXPECT_THAT(read_as(5121, std::string("\xff\x00\xff\x00", 4)), ElementsAre(1, 0, 1, 0));
  EXPECT_THAT(read_as(5122, std::string("\xff\x7f\x01\x80\x00\x80\x00\x00", 8)),
              ElementsAre(1, -1, -1, 0));
  EXPECT_THAT(read_as(5123, std::string("\xff\xff\x00\x00\xff\xff\x00\x00", 8)),
              ElementsAre(1, 0, 1, 0));
  Accessor()["normalized"] = false;
  EXPECT_THAT(ReadError(builder_.Binary(), 1),
              HasSubstr("accessors[0]: expected 1 floats or normalized whole numbers, got"));
}

TEST_F(Buffers, RejectValuesOfAnotherKind) {
  EXPECT_THAT(ReadError(builder_.Binary(), 4),
              HasSubstr("expected 4 floats or normalized whole numbers, got 3 of type 5126"));
  Accessor()["componentType"] = 5125;
  EXPECT_THAT(ReadError(builder_.Binary(), 3), HasSubstr("of type 5125"));
}

TEST_F(Buffers, AreZeroWithoutAView) {
  Accessor().erase("bufferView");
  EXPECT_THAT(*Read(builder_.Binary(), 3), ElementsAre(0, 0, 0, 0, 0, 0));
  Accessor()["count"] = 4294967295u;
  EXPECT_THAT(ReadError(builder_.Binary(), 3), HasSubstr("expected at most 67108864 values"));
}

TEST_F(Buffers, RejectSparseValues) {
  Accessor()["sparse"] = {{"count", 1}};
  EXPECT_THAT(ReadError(builder_.Binary(), 3),
              HasSubstr("accessors[0]: expected plain values, got sparse ones"));
}

TEST_F(Buffers, StayWithinTheirBytes) {
  const auto beyond = HasSubstr("expected values within the buffer");
  const std::string whole = builder_.json().dump();
  const auto with = [&](const char* part, const char* field, uint64_t value) {
    builder_.json() = nlohmann::json::parse(whole);
    builder_.json()[part][0][field] = value;
    return builder_.Binary();
  };
  const std::tuple<const char*, const char*, uint64_t> cases[] = {
      {"accessors", "count", 3},
      {"accessors", "count", 4294967295u},
      {"accessors", "byteOffset", 1},
      {"accessors", "byteOffset", 4294967295u},
      {"bufferViews", "byteOffset", 1},
      {"bufferViews", "byteOffset", 4294967295u},
      {"bufferViews", "byteLength", 23},
      {"bufferViews", "byteLength", 25},
      {"bufferViews", "byteStride", 13},
      {"bufferViews", "byteStride", 4},
      {"bufferViews", "byteStride", 4294967295u},
      {"buffers", "byteLength", 23}};
  for (const auto& [part, field, value] : cases) {
    EXPECT_THAT(ReadError(with(part, field, value), 3), beyond) << field << " " << value;
  }
  EXPECT_THAT(ReadError(with("buffers", "byteLength", 4294967295u), 3),
              HasSubstr("buffers[0]: expected the 4294967295 bytes of byteLength, got 24"));
}

TEST_F(Buffers, RejectValuesThatAreNotFinite) {
  for (float bad :
       {std::numeric_limits<float>::quiet_NaN(), 1e30f, -std::numeric_limits<float>::infinity()}) {
    test::GltfBuilder builder;
    builder.AddAccessor({1, 2, bad}, "VEC3");
    EXPECT_THAT(ReadError(builder.Binary(), 3),
                HasSubstr("accessors[0]: value 2: expected a finite number"));
  }
}

TEST_F(Buffers, ReadOnlyFilesInTheSameFolder) {
  for (const char* uri : {"../a.bin", "/etc/passwd", "b/a.bin", "%2e%2e%2fa.bin", "..", ".",
                          "file:a.bin", "http://x/a.bin", "a%00.bin", "c:\\\\a.bin"}) {
    EXPECT_THAT(ReadError(builder_.WithFile(uri), 3),
                HasSubstr("expected a file in the same folder"))
        << uri;
  }
  EXPECT_EQ(Read(builder_.WithFile("a.bin"), 3).status().code(), absl::StatusCode::kNotFound);
}

// The % of "50%.bin" need not be escaped; "50%25.bin" may be either file.
TEST_F(Buffers, ReadFilesWithAPercentSign) {
  for (const char* file : {"50%.bin", "50%25.bin", "%zz", "a%2"}) {
    const auto beside = [&](const std::string& name) {
      return name == file ? absl::StatusOr<std::string>(builder_.buffer()) : NoFiles(name);
    };
    EXPECT_THAT(Read(builder_.WithFile(file), 3, beside), IsOk()) << file;
  }
}

TEST_F(Buffers, RejectInvalidBase64) {
  for (const char* uri : {"data:", "data:;base64", "data:text/plain,abc", "data:;base64,!!!!"}) {
    EXPECT_THAT(ReadError(builder_.WithFile(uri), 3), HasSubstr("expected base64 data")) << uri;
  }
  EXPECT_THAT(ReadError(builder_.WithFile("data:;base64,AAAA"), 3), HasSubstr("byteLength, got 3"));
  EXPECT_THAT(ReadError(builder_.json().dump(), 3), HasSubstr("the file has no binary chunk"));
}

// Many accessors over the same bytes.
TEST_F(Buffers, RejectMoreValuesThanAMotionMayHave) {
  test::GltfBuilder builder;
  builder.AddAccessor(std::vector<float>(std::size_t{3} << 20, 1.0f), "VEC3");
  const absl::StatusOr<GltfDocument> document = ParseGltf(builder.Binary(), "a.glb");
  ASSERT_TRUE(document.ok()) << document.status();
  const GltfFileReader no_files = NoFiles;
  GltfBuffers buffers(*document, no_files);
  absl::Status status;
  int read = 0;
  for (; status.ok() && read < 100; ++read) status = buffers.Read(0, 3).status();
  EXPECT_EQ(read, 22);
  EXPECT_THAT(std::string(status.message()),
              HasSubstr("expected at most 67108864 values in all, got more"));
}

}  // namespace
}  // namespace duet::formats::gltf
