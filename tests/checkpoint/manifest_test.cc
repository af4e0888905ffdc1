#include "model/checkpoint/manifest.h"

#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "gtest/gtest.h"
#include "model/engine/window_plan.h"
#include "tests/checkpoint/edited_manifest.h"
#include "tests/support/architectures.h"
#include "tests/support/matchers.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::checkpoint {
namespace {

using test::CompleteManifest;

using nlohmann::json;

json CompleteJson() { return json::parse(SerializeManifest(CompleteManifest())); }

TEST(Manifest, RoundTrip) {
  const Manifest wanted = CompleteManifest();
  const absl::StatusOr<Manifest> got = ParseManifest(SerializeManifest(wanted));
  ASSERT_THAT(got, IsOk());
  EXPECT_EQ(got->format_version, kCheckpointFormatVersion);
  EXPECT_EQ(got->model.name, wanted.model.name);
  EXPECT_EQ(got->model.version, wanted.model.version);
  EXPECT_EQ(got->model.description, wanted.model.description);
  EXPECT_EQ(got->model.frame_rate_hz, wanted.model.frame_rate_hz);
  EXPECT_EQ(got->model.window_frames, wanted.model.window_frames);
  EXPECT_EQ(got->model.classes, wanted.model.classes);
  EXPECT_TRUE(got->model.accepts_follower_start);
  const auto& paper = std::get<PaperArchitecture>(got->architecture);
  EXPECT_EQ(paper.variant, GeneratorVariant::kPaper);
  EXPECT_TRUE(paper.follower_start);
  EXPECT_EQ(paper.slice_features, 1);
  EXPECT_EQ(paper.encoder_hidden, 2);
  EXPECT_EQ(paper.attention, 2);
  EXPECT_TRUE(paper.base_pose);
  EXPECT_EQ(got->standardisation, motion::StandardOrigin::kEveryFrame);
  EXPECT_EQ(got->weights.file, wanted.weights.file);
  EXPECT_EQ(got->weights.bytes, wanted.weights.bytes);
  EXPECT_EQ(got->weights.sha256, wanted.weights.sha256);
  EXPECT_EQ(got->git_revision, wanted.git_revision);
  EXPECT_EQ(got->created, wanted.created);
  EXPECT_EQ(got->training, wanted.training);
  EXPECT_EQ(got->metrics, wanted.metrics);
}

TEST(Manifest, SkeletonRoundTrip) {
  Manifest manifest = CompleteManifest();
  manifest.model.skeleton = motion::SbuSkeleton();
  manifest.parts = motion::SbuParts();
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  const motion::Skeleton got = read->model.skeleton, wanted = motion::SbuSkeleton();
  EXPECT_EQ(got.joint_names, wanted.joint_names);
  EXPECT_EQ(got.bones, wanted.bones);
  EXPECT_EQ(read->parts, motion::SbuParts());
  EXPECT_EQ(got.root, wanted.root);
  EXPECT_EQ(got.hips, wanted.hips);
  EXPECT_EQ(got.feet, wanted.feet);
}

TEST(Manifest, WritesChoicesByName) {
  Manifest manifest = CompleteManifest();
  const struct {
    GeneratorVariant variant;
    const char* name;
  } variants[] = {{GeneratorVariant::kPaper, "paper"},
                  {GeneratorVariant::kReleased, "released"},
                  {GeneratorVariant::kUnlabelled, "unlabelled"}};
  for (const auto& one : variants) {
    test::PaperOf(manifest).variant = one.variant;
    const std::string text = SerializeManifest(manifest);
    EXPECT_EQ(json::parse(text)["generator"]["variant"], one.name);
    EXPECT_EQ(std::get<PaperArchitecture>(ParseManifest(text)->architecture).variant, one.variant);
  }
  const struct {
    motion::StandardOrigin origin;
    const char* name;
  } origins[] = {{motion::StandardOrigin::kEveryFrame, "leader_root_and_yaw"},
                 {motion::StandardOrigin::kFirstFrame, "leader_start_and_yaw"}};
  for (const auto& one : origins) {
    manifest.standardisation = one.origin;
    const std::string text = SerializeManifest(manifest);
    EXPECT_EQ(json::parse(text)["standardisation"], one.name);
    EXPECT_EQ(ParseManifest(text)->standardisation, one.origin);
  }
}

TEST(Manifest, FollowerStartDeterminesWhatTheModelAccepts) {
  Manifest manifest = CompleteManifest();
  test::PaperOf(manifest).follower_start = false;
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_FALSE(read->model.accepts_follower_start);
}

TEST(Manifest, KeepsNumbersExactly) {
  Manifest manifest = CompleteManifest();
  manifest.model.frame_rate_hz = 29.97;
  manifest.metrics["third"] = 1.0 / 3;
  manifest.metrics["large"] = -1.7976931348623157e308;
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->model.frame_rate_hz, 29.97);
  EXPECT_EQ(read->metrics, manifest.metrics);
}

TEST(Manifest, KeepsAnyText) {
  Manifest manifest = CompleteManifest();
  manifest.model.description = "two people, \"hug\"\n\xC3\xA9\x01";
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->model.description, manifest.model.description);
}

TEST(Manifest, TermsAndDigestReachTheDescription) {
  Manifest manifest = CompleteManifest();
  manifest.model.terms = "For research only.";
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->model.terms, "For research only.");
  EXPECT_EQ(read->model.weights_sha256, manifest.weights.sha256);
  const absl::StatusOr<Manifest> silent = ParseManifest(SerializeManifest(CompleteManifest()));
  ASSERT_THAT(silent, IsOk());
  EXPECT_EQ(silent->model.terms, "");
}

TEST(Manifest, LookaheadLeavesAWindowRoomToAdvance) {
  Manifest manifest = CompleteManifest();
  EXPECT_THAT(SerializeManifest(manifest), testing::Not(testing::HasSubstr("lookahead")));
  const int window = manifest.model.window_frames;
  manifest.model.lookahead_frames = window - engine::SettledOverlap(window) - 1;
  const absl::StatusOr<Manifest> read = ParseManifest(SerializeManifest(manifest));
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->model.lookahead_frames, manifest.model.lookahead_frames);
  ++manifest.model.lookahead_frames;
  EXPECT_THAT(ParseManifest(SerializeManifest(manifest)),
              StatusIs(absl::StatusCode::kInvalidArgument, testing::HasSubstr("lookahead_frames")));
}

TEST(Manifest, IsFreeForAllUsesOnlyIfItSaysSo) {
  Manifest manifest = CompleteManifest();
  const std::string silent = SerializeManifest(manifest);
  EXPECT_THAT(silent, testing::Not(testing::HasSubstr("free_for_all_uses")));
  ASSERT_THAT(ParseManifest(silent), IsOk());
  EXPECT_FALSE(ParseManifest(silent)->model.free_for_all_uses);
  manifest.model.free_for_all_uses = true;
  const std::string free = SerializeManifest(manifest);
  ASSERT_THAT(ParseManifest(free), IsOk());
  EXPECT_TRUE(ParseManifest(free)->model.free_for_all_uses);
  const std::string stated = "\"free_for_all_uses\": true";
  ASSERT_THAT(free, testing::HasSubstr(stated));
  std::string text = free;
  text.replace(text.find(stated), stated.size(), "\"free_for_all_uses\": \"yes\"");
  EXPECT_THAT(ParseManifest(text), IsInvalid("free_for_all_uses"));
}

TEST(Manifest, TruncatedAtAnyLengthIsRejected) {
  const std::string text = SerializeManifest(CompleteManifest());
  const std::size_t last_brace = text.rfind('}');
  for (std::size_t size = 0; size <= last_brace; ++size) {
    EXPECT_THAT(ParseManifest(text.substr(0, size)), IsInvalid("manifest: not")) << size;
  }
}

TEST(Manifest, RejectsAnOversizeText) {
  std::string text = SerializeManifest(CompleteManifest());
  text.resize(kMaxManifestBytes, ' ');
  EXPECT_THAT(ParseManifest(text), IsOk());
  EXPECT_THAT(ParseManifest(text + " "), IsInvalid("expected at most 1048576 bytes, got 1048577"));
}

TEST(Manifest, RejectsRepeatedFields) {
  std::string text = SerializeManifest(CompleteManifest());
  text.insert(text.rfind('}'), ",\"version\": 4");
  EXPECT_THAT(ParseManifest(text), IsInvalid("\"version\" is repeated"));
}

// Visits every object inside `value`, the root first; `path` is for messages.
void ForEachObject(json& value, const std::string& path,
                   const std::function<void(json&, const std::string&)>& visit) {
  if (!value.is_structured()) return;
  if (value.is_object()) visit(value, path);
  for (auto& [key, child] : value.items())
    ForEachObject(child, absl::StrCat(path, "/", key), visit);
}

bool IsFreeMap(const std::string& path) { return path == "/training" || path == "/metrics"; }

TEST(Manifest, RejectsEveryFieldThatIsMissing) {
  json root = CompleteJson();
  root.erase("touching_classes");  // older checkpoints have none
  int fields = 0;
  ForEachObject(root, "", [&](json& object, const std::string& path) {
    if (IsFreeMap(path)) return;
    const json whole = object;
    for (const auto& [key, value] : whole.items()) {
      object.erase(key);
      EXPECT_THAT(ParseManifest(root.dump()), IsInvalid(absl::StrCat(key, ": missing"))) << path;
      object = whole;
      ++fields;
    }
  });
  EXPECT_EQ(fields, 15 + 8 + 2 * 2 + 7 + 3);
  EXPECT_THAT(ParseManifest(root.dump()), IsOk());
}

TEST(Manifest, RejectsEveryUnknownField) {
  json root = CompleteJson();
  ForEachObject(root, "", [&](json& object, const std::string& path) {
    if (IsFreeMap(path)) return;
    object["surprise"] = 1;
    EXPECT_THAT(ParseManifest(root.dump()), IsInvalid("unknown field \"surprise\"")) << path;
    object.erase("surprise");
  });
}

TEST(Manifest, RejectsEveryFieldOfAWrongType) {
  json root = CompleteJson();
  // For each field, at least one of these has the wrong type.
  const json values[] = {nullptr, json::object({{"x", json::array()}}), json::array({nullptr})};
  ForEachObject(root, "", [&](json& object, const std::string& path) {
    const json whole = object;
    for (const auto& [key, ignored] : whole.items()) {
      for (const json& value : values) {
        object[key] = value;
        const absl::StatusOr<Manifest> read = ParseManifest(root.dump());
        EXPECT_THAT(read, IsInvalid("")) << path << "/" << key << " = " << value;
      }
      object = whole;
    }
  });
}

struct BadField {
  const char* what;
  const char* pointer;  // JSON pointer of the field to replace
  const char* value;    // JSON
  const char* why;
};

class ManifestField : public ::testing::TestWithParam<BadField> {};

TEST_P(ManifestField, IsRejectedByName) {
  EXPECT_THAT(ParseEdited(CompleteManifest(), GetParam().pointer, json::parse(GetParam().value)),
              IsInvalid(GetParam().why));
}

INSTANTIATE_TEST_SUITE_P(
    Bad, ManifestField,
    ::testing::Values(
        BadField{"newer_format", "/format_version", "3", "format_version: expected"},
        BadField{"format_0", "/format_version", "0", "format_version: expected"},
        BadField{"name_empty", "/name", "\"\"", "name: expected 1 to 64"},
        BadField{"name_leaves", "/name", "\"../x\"", "got \"../x\""},
        BadField{"name_long", "/name",
                 "\"0123456789012345678901234567890123456789012345678901234567890123x\"", "name:"},
        BadField{"version_0", "/version", "0", "version: expected a whole number"},
        BadField{"version_huge", "/version", "4294967297", "version: expected a whole number"},
        BadField{"rate_0", "/frame_rate_hz", "0",
                 "frame_rate_hz: expected a number from 1 to 240, got 0"},
        BadField{"rate_241", "/frame_rate_hz", "241",
                 "frame_rate_hz: expected a number from 1 to 240, got 241"},
        BadField{"window_1", "/window_frames", "1", "window_frames: expected a whole number"},
        BadField{"window_fraction", "/window_frames", "8.5",
                 "window_frames: expected a whole number"},
        BadField{"no_classes", "/classes", "[]", "classes: expected at least one class"},
        BadField{"class_twice", "/classes", "[\"a\",\"a\"]", "classes: \"a\" is repeated"},
        BadField{"class_number", "/classes", "[1]", "classes: expected non-empty strings, got 1"},
        BadField{"other_standardisation", "/standardisation", "\"none\"",
                 "standardisation: expected \"leader_root_and_yaw\" or "
                 "\"leader_start_and_yaw\", got \"none\""},
        BadField{"joint_twice", "/skeleton/joint_names", "[\"torso\",\"torso\",\"right_hip\"]",
                 "joint_names: \"torso\" is repeated"},
        BadField{"no_joints", "/skeleton/joint_names", "[]",
                 "expected one of skeleton.joint_names"},
        BadField{"unknown_root", "/skeleton/root", "\"tail\"",
                 "skeleton.root: expected one of skeleton.joint_names, got \"tail\""},
        BadField{"root_is_a_leaf", "/skeleton/root", "\"left_hip\"", "skeleton.bones"},
        BadField{"bone_unknown", "/skeleton/bones/0/1", "\"tail\"",
                 "skeleton.bones[0]: expected one of skeleton.joint_names, got \"tail\""},
        BadField{"bone_of_three", "/skeleton/bones/0", "[\"torso\",\"left_hip\",\"torso\"]",
                 "skeleton.bones[0]: expected a pair"},
        BadField{"bone_missing", "/skeleton/bones", "[[\"torso\",\"left_hip\"]]",
                 "skeleton.bones: expected 2 to connect 3 joints, got 1"},
        BadField{"bones_in_a_circle", "/skeleton/bones",
                 R"([["left_hip","right_hip"],["right_hip","left_hip"]])", "skeleton.bones"},
        BadField{"no_parts", "/skeleton/parts", "[]",
                 "skeleton.parts: expected at least one, got none"},
        BadField{"part_empty", "/skeleton/parts/0/joints", "[]", "expected at least one joint"},
        BadField{"part_joint_twice", "/skeleton/parts/1/joints", R"(["left_hip","left_hip"])",
                 "skeleton.parts[1].joints: \"left_hip\" is repeated"},
        BadField{"part_joint_unknown", "/skeleton/parts/1/joints", "[\"tail\"]",
                 "skeleton.parts[1].joints: expected one of skeleton.joint_names, got \"tail\""},
        BadField{"part_twice", "/skeleton/parts/1/name", "\"trunk\"",
                 "\"trunk\" is repeated or reserved"},
        BadField{"part_reserved", "/skeleton/parts/1/name", "\"whole_body\"",
                 "\"whole_body\" is repeated or reserved"},
        BadField{"part_not_a_name", "/skeleton/parts/1/name", "\"a/b\"",
                 "parts[1].name: expected 1 to 64 letters"},
        BadField{
            "variant", "/generator/variant", "\"other\"",
            "generator.variant: expected \"paper\", \"released\" or \"unlabelled\", got \"other\""},
        BadField{"start_number", "/generator/follower_start", "1",
                 "generator.follower_start: expected true or false, got 1"},
        BadField{"base_text", "/generator/base_pose", "\"yes\"",
                 "generator.base_pose: expected true or false, got \"yes\""},
        BadField{"features_negative", "/generator/slice_features", "-1",
                 "generator.slice_features: expected a whole number"},
        BadField{"hidden_0", "/generator/encoder_hidden", "0",
                 "generator.encoder_hidden: expected a whole number"},
        BadField{"hidden_huge", "/generator/encoder_hidden", "4097",
                 "generator.encoder_hidden: expected a whole number"},
        BadField{"hidden_out_of_memory", "/generator/encoder_hidden", "4096",
                 "generator: expected sizes of at most 536870912 bytes"},
        BadField{"attention_0", "/generator/attention", "0",
                 "generator.attention: expected a whole number"},
        BadField{"file_elsewhere", "/weights/file", "\"../weights\"",
                 "weights.file: expected 1 to 64 letters"},
        BadField{"file_absolute", "/weights/file", "\"/etc/passwd\"", "weights.file"},
        BadField{"file_parent", "/weights/file", "\"..\"", "got \"..\""},
        BadField{"file_below", "/weights/file", "\"a/b\"", "got \"a/b\""},
        BadField{"file_backslash", "/weights/file", "\"a\\\\b\"", "weights.file"},
        BadField{"file_nul", "/weights/file", "\"a\\u0000b\"", "weights.file"},
        BadField{"bytes_0", "/weights/bytes", "0", "weights.bytes: expected a whole number"},
        BadField{"bytes_over_the_cap", "/weights/bytes", "536870913",
                 "weights.bytes: expected a whole number from 1 to 536870912, got 536870913"},
        BadField{"sha256_short", "/weights/sha256", "\"abc\"",
                 "weights.sha256: expected 64 digits of lower-case hex, got \"abc\""},
        BadField{"sha256_upper_case", "/weights/sha256",
                 "\"AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA\"",
                 "lower-case hex"},
        BadField{"created_elsewhen", "/created", "\"yesterday\"",
                 "created: expected a time as in RFC 3339, got \"yesterday\""},
        BadField{"training_number", "/training/epochs", "7", "training.epochs: expected a string"},
        BadField{"metric_text", "/metrics/afd.kick", "\"good\"",
                 "metrics.afd.kick: expected a number"}),
    [](const ::testing::TestParamInfo<BadField>& bad) { return bad.param.what; });

TEST(Manifest, ANewerFormatIsNamedBeforeItsNewFields) {
  json root = CompleteJson();
  root["format_version"] = 3;
  root["new_field"] = true;
  EXPECT_THAT(ParseManifest(root.dump()), IsInvalid("format_version: expected a whole number"));
}

TEST(Manifest, ANonFiniteMetricCannotBeRead) {
  Manifest manifest = CompleteManifest();
  manifest.metrics["afd.kick"] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(ParseManifest(SerializeManifest(manifest)),
              IsInvalid("metrics.afd.kick: expected a number"));
}

}  // namespace
}  // namespace duet::checkpoint
