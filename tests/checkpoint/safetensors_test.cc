#include "model/checkpoint/safetensors.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "absl/strings/str_cat.h"
#include "gtest/gtest.h"
#include "tests/support/matchers.h"

namespace duet::checkpoint {
namespace {

std::vector<Tensor> TwoTensors() {
  return {{"b", {2, 2}, {1, 2, 3, 4}}, {"a", {3}, {-1, 0.5f, 1e-30f}}};
}

// A file with this header and this many zero bytes of data.
std::string File(const std::string& header, std::size_t data_bytes) {
  const uint64_t length = header.size();
  std::string file(8, '\0');
  std::memcpy(file.data(), &length, 8);
  return file + header + std::string(data_bytes, '\0');
}

auto Refused(const std::string& why) {
  return StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(why));
}

TEST(Safetensors, RoundTrip) {
  const absl::StatusOr<std::vector<Tensor>> read =
      ParseSafetensors(SerializeSafetensors(TwoTensors(), {{"format", "pt"}}));
  ASSERT_THAT(read, IsOk());
  ASSERT_EQ(read->size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ((*read)[i].name, TwoTensors()[i].name);
    EXPECT_EQ((*read)[i].shape, TwoTensors()[i].shape);
    EXPECT_EQ((*read)[i].values, TwoTensors()[i].values);
  }
}

TEST(Safetensors, WritesThePublishedLayout) {
  const std::string file = SerializeSafetensors({{"a", {2}, {1, -2}}});
  const std::string header = "{\"a\":{\"dtype\":\"F32\",\"shape\":[2],\"data_offsets\":[0,8]}}";
  ASSERT_EQ(file.size() % 8, 0u);
  EXPECT_EQ(file[0], static_cast<char>((header.size() + 7) / 8 * 8));
  EXPECT_EQ(file.substr(1, 7), std::string(7, '\0'));
  EXPECT_EQ(file.substr(8, header.size()), header);
  EXPECT_EQ(file.substr(file.size() - 8), std::string("\0\0\x80\x3f\0\0\0\xc0", 8));
}

TEST(Safetensors, AcceptsTensorsInAnyOrderOfTheHeader) {
  const absl::StatusOr<std::vector<Tensor>> read =
      ParseSafetensors(File(R"({"z":{"data_offsets":[4,8],"dtype":"F32","shape":[]},)"
                            R"("a":{"shape":[1],"dtype":"F32","data_offsets":[0,4]}}   )",
                            8));
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ((*read)[0].name, "a");
  EXPECT_EQ((*read)[1].name, "z");
}

TEST(Safetensors, TruncatedAtAnyLengthIsDataLoss) {
  const std::string file = SerializeSafetensors(TwoTensors());
  for (std::size_t size = 0; size < file.size(); ++size) {
    EXPECT_EQ(ParseSafetensors(file.substr(0, size)).status().code(), absl::StatusCode::kDataLoss)
        << size;
  }
}

TEST(Safetensors, RejectsABadHeaderLength) {
  std::string file = SerializeSafetensors(TwoTensors());
  file.resize((1 << 20) + 100);
  const uint64_t too_long = (1 << 20) + 1;
  std::memcpy(file.data(), &too_long, 8);
  EXPECT_THAT(ParseSafetensors(file), Refused("expected at most 1048576 bytes, got 1048577"));
  std::memset(file.data(), 0xff, 8);
  EXPECT_THAT(ParseSafetensors(file), Refused("got 18446744073709551615"));
  std::memset(file.data(), 0, 8);
  EXPECT_THAT(ParseSafetensors(file), Refused("not a JSON object"));
}

struct BadHeader {
  const char* what;
  const char* header;
  const char* why;
};

class SafetensorsHeader : public ::testing::TestWithParam<BadHeader> {};

TEST_P(SafetensorsHeader, IsRejectedByName) {
  EXPECT_THAT(ParseSafetensors(File(GetParam().header, 8)), Refused(GetParam().why));
}

INSTANTIATE_TEST_SUITE_P(
    Bad, SafetensorsHeader,
    ::testing::Values(
        BadHeader{"not_json", "{\"a\"", "header: not JSON"},
        BadHeader{"tensor_twice",
                  R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]},)"
                  R"("a":{"dtype":"F32","shape":[1],"data_offsets":[4,8]}})",
                  "\"a\" is repeated"},
        BadHeader{"not_an_object", R"({"a":[]})", "tensor \"a\": expected an object, got []"},
        BadHeader{"no_dtype", R"({"a":{"shape":[2],"data_offsets":[0,8]}})", "dtype: missing"},
        BadHeader{"other_dtype", R"({"a":{"dtype":"F64","shape":[1],"data_offsets":[0,8]}})",
                  "tensor \"a\".dtype: expected \"F32\", got \"F64\""},
        BadHeader{"unknown_field",
                  R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8],"x":1}})",
                  "unknown field \"x\""},
        BadHeader{"zero_size", R"({"a":{"dtype":"F32","shape":[0],"data_offsets":[0,0]}})",
                  "\"a\".shape: expected whole numbers from 1"},
        BadHeader{"huge_size",
                  R"({"a":{"dtype":"F32","shape":[9223372036854775808],"data_offsets":[0,8]}})",
                  "\"a\".shape: expected whole numbers"},
        BadHeader{"nine_dimensions",
                  R"({"a":{"dtype":"F32","shape":[1,1,1,1,1,1,1,2,1],"data_offsets":[0,8]}})",
                  "at most 8 values"},
        BadHeader{"product_overflows_to_8",
                  // 4 * 2 * (2^62 + 1) * 4 wraps to 32, 4 * 4611686018427387906 to 8.
                  R"({"a":{"dtype":"F32","shape":[4611686018427387906],"data_offsets":[0,8]}})",
                  "the bytes of the shape [4611686018427387906], got 8"},
        BadHeader{"shape_too_large", R"({"a":{"dtype":"F32","shape":[3],"data_offsets":[0,8]}})",
                  "the bytes of the shape [3], got 8"},
        BadHeader{"one_offset", R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[8]}})",
                  "a begin and an end"},
        BadHeader{"offsets_reversed", R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[8,0]}})",
                  "a begin and an end"},
        BadHeader{"gap_at_the_start", R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[4,8]}})",
                  "expected a begin at 0, the end of the previous, got 4"},
        BadHeader{"overlap",
                  R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]},)"
                  R"("b":{"dtype":"F32","shape":[1],"data_offsets":[4,8]}})",
                  "expected a begin at 8, the end of the previous, got 4"},
        BadHeader{"unused_bytes", R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}})",
                  "no bytes after the last tensor, got 4"},
        BadHeader{"metadata_not_an_object", R"({"__metadata__":1})",
                  "__metadata__: expected an object, got 1"},
        BadHeader{"metadata_not_strings", R"({"__metadata__":{"x":1}})",
                  "__metadata__.x: expected a string"}),
    [](const ::testing::TestParamInfo<BadHeader>& bad) { return bad.param.what; });

TEST(Safetensors, DeclaringMoreBytesThanPresentIsDataLoss) {
  const std::string file = File(R"({"a":{"dtype":"F32","shape":[2305843009213693951],)"
                                R"("data_offsets":[0,9223372036854775804]}})",
                                8);
  EXPECT_THAT(ParseSafetensors(file),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("bytes, as declared, got 8")));
}

}  // namespace
}  // namespace duet::checkpoint
