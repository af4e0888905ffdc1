#include "model/checkpoint/manifest.h"

#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "gtest/gtest.h"
#include "model/engine/windows.h"
#include "tests/support/architectures.h"
#include "tests/support/matchers.h"
#include "tests/support/tiny_checkpoint.h"

namespace duet::checkpoint {
namespace {

using nlohmann::json;
using test::CompleteManifest;
using test::TinyManifest;

// Matches INVALID_ARGUMENT with these words.
auto IsInvalid(const std::string& words) {
  return StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(words));
}

// Parses the text of a manifest in which the value at a JSON pointer is replaced.
absl::Status ParseEdited(const Manifest& manifest, const std::string& pointer, const json& value) {
  json root = json::parse(SerializeManifest(manifest));
  root[json::json_pointer(pointer)] = value;
  return ParseManifest(root.dump()).status();
}

json CompleteJson() { return json::parse(SerializeManifest(CompleteManifest())); }

// The manifest after it is written and read.
Manifest RoundTrip(const Manifest& manifest) {
  const std::string text = SerializeManifest(manifest);
  const absl::StatusOr<Manifest> read = ParseManifest(text);
  EXPECT_THAT(read, IsOk());
  if (!read.ok()) return {};
  EXPECT_EQ(SerializeManifest(*read), text);
  return *read;
}

TEST(Manifest, RoundTrip) {
  const Manifest wanted = CompleteManifest(), got = RoundTrip(wanted);
  EXPECT_EQ(got.format_version, kCheckpointFormatVersion);
  EXPECT_EQ(got.model.classes, wanted.model.classes);
  EXPECT_TRUE(got.model.accepts_follower_start);
  EXPECT_EQ(std::get<PaperArchitecture>(got.architecture).encoder_hidden, 2);
  EXPECT_EQ(got.weights.sha256, wanted.weights.sha256);
  EXPECT_EQ(got.training, wanted.training);
  EXPECT_EQ(got.metrics, wanted.metrics);
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

TEST(Manifest, KeepsNumbersExactly) {
  Manifest manifest = CompleteManifest();
  manifest.model.frame_rate_hz = 29.97;
  manifest.metrics["third"] = 1.0 / 3;
  manifest.metrics["large"] = -1.7976931348623157e308;
  const Manifest read = RoundTrip(manifest);
  EXPECT_EQ(read.model.frame_rate_hz, 29.97);
  EXPECT_EQ(read.metrics, manifest.metrics);
}

TEST(Manifest, TermsAndDigestReachTheDescription) {
  Manifest manifest = CompleteManifest();
  manifest.model.terms = "For research only.";
  const Manifest read = RoundTrip(manifest);
  EXPECT_EQ(read.model.terms, "For research only.");
  EXPECT_EQ(read.model.weights_sha256, manifest.weights.sha256);
  const absl::StatusOr<Manifest> silent = ParseManifest(SerializeManifest(CompleteManifest()));
  ASSERT_THAT(silent, IsOk());
  EXPECT_EQ(silent->model.terms, "");
}

TEST(Manifest, DefaultSeedsAreWholeNumbers) {
  Manifest manifest = CompleteManifest();
  EXPECT_THAT(RoundTrip(manifest).model.default_seeds, IsEmpty());
  manifest.model.default_seeds = {3, 18446744073709551615u};
  EXPECT_THAT(RoundTrip(manifest).model.default_seeds, ElementsAre(3, 18446744073709551615u));
  for (const json& seed : {json(-1), json(0.5), json("1")}) {
    EXPECT_THAT(ParseEdited(CompleteManifest(), "/default_seeds", {7, seed}),
                IsInvalid("default_seeds[1]: expected a whole number from 0, got"));
  }
}

TEST(Manifest, LookaheadLeavesAWindowRoomToAdvance) {
  Manifest manifest = CompleteManifest();
  EXPECT_THAT(SerializeManifest(manifest), testing::Not(testing::HasSubstr("lookahead")));
  const int window = manifest.model.window_frames;
  manifest.model.lookahead_frames = window - engine::SettledOverlap(window) - 1;
  const Manifest read = RoundTrip(manifest);
  EXPECT_EQ(read.model.lookahead_frames, manifest.model.lookahead_frames);
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

// A value of a field, and the error that it causes.
struct BadField {
  const char* pointer;  // JSON pointer
  const char* value;    // JSON
  const char* why;
};

void ExpectRejected(const Manifest& manifest, std::initializer_list<BadField> fields) {
  for (const BadField& one : fields) {
    EXPECT_THAT(ParseEdited(manifest, one.pointer, json::parse(one.value)), IsInvalid(one.why))
        << one.pointer << " = " << one.value;
  }
}

TEST(Manifest, RejectsBadFieldsByName) {
  ExpectRejected(
      CompleteManifest(),
      {{"/format_version", "3", "format_version: expected"},
       {"/format_version", "0", "format_version: expected"},
       {"/name", "\"\"", "name: expected 1 to 64"},
       {"/name", "\"../x\"", "got \"../x\""},
       {"/name", "\"0123456789012345678901234567890123456789012345678901234567890123x\"", "name:"},
       {"/version", "0", "version: expected a whole number"},
       {"/version", "4294967297", "version: expected a whole number"},
       {"/frame_rate_hz", "0", "frame_rate_hz: expected a number from 1 to 240, got 0"},
       {"/frame_rate_hz", "241", "frame_rate_hz: expected a number from 1 to 240, got 241"},
       {"/window_frames", "1", "window_frames: expected a whole number"},
       {"/window_frames", "8.5", "window_frames: expected a whole number"},
       {"/classes", "[]", "classes: expected at least one class"},
       {"/classes", "[\"a\",\"a\"]", "classes: \"a\" is repeated"},
       {"/classes", "[1]", "classes: expected non-empty strings, got 1"},
       {"/standardisation", "\"none\"",
        "standardisation: expected \"leader_root_and_yaw\" or "
        "\"leader_start_and_yaw\", got \"none\""},
       {"/skeleton/joint_names", "[\"torso\",\"torso\",\"right_hip\"]",
        "joint_names: \"torso\" is repeated"},
       {"/skeleton/joint_names", "[]", "expected one of skeleton.joint_names"},
       {"/skeleton/root", "\"tail\"",
        "skeleton.root: expected one of skeleton.joint_names, got \"tail\""},
       {"/skeleton/root", "\"left_hip\"", "skeleton.bones"},
       {"/skeleton/bones/0/1", "\"tail\"",
        "skeleton.bones[0]: expected one of skeleton.joint_names, got \"tail\""},
       {"/skeleton/bones/0", "[\"torso\",\"left_hip\",\"torso\"]",
        "skeleton.bones[0]: expected a pair"},
       {"/skeleton/bones", "[[\"torso\",\"left_hip\"]]",
        "skeleton.bones: expected 2 to connect 3 joints, got 1"},
       {"/skeleton/bones", R"([["left_hip","right_hip"],["right_hip","left_hip"]])",
        "skeleton.bones"},
       {"/skeleton/parts", "[]", "skeleton.parts: expected at least one, got none"},
       {"/skeleton/parts/0/joints", "[]", "expected at least one joint"},
       {"/skeleton/parts/1/joints", R"(["left_hip","left_hip"])",
        "skeleton.parts[1].joints: \"left_hip\" is repeated"},
       {"/skeleton/parts/1/joints", "[\"tail\"]",
        "skeleton.parts[1].joints: expected one of skeleton.joint_names, got \"tail\""},
       {"/skeleton/parts/1/name", "\"trunk\"", "\"trunk\" is repeated or reserved"},
       {"/skeleton/parts/1/name", "\"whole_body\"", "\"whole_body\" is repeated or reserved"},
       {"/skeleton/parts/1/name", "\"a/b\"", "parts[1].name: expected 1 to 64 letters"},
       {"/generator/variant", "\"other\"",
        "generator.variant: expected \"paper\", \"released\" or \"unlabelled\", got \"other\""},
       {"/generator/follower_start", "1",
        "generator.follower_start: expected true or false, got 1"},
       {"/generator/base_pose", "\"yes\"",
        "generator.base_pose: expected true or false, got \"yes\""},
       {"/generator/slice_features", "-1", "generator.slice_features: expected a whole number"},
       {"/generator/encoder_hidden", "0", "generator.encoder_hidden: expected a whole number"},
       {"/generator/encoder_hidden", "4097", "generator.encoder_hidden: expected a whole number"},
       {"/generator/encoder_hidden", "4096",
        "generator: expected sizes of at most 536870912 bytes"},
       {"/generator/attention", "0", "generator.attention: expected a whole number"},
       {"/weights/file", "\"../weights\"", "weights.file: expected 1 to 64 letters"},
       {"/weights/file", "\"/etc/passwd\"", "weights.file"},
       {"/weights/file", "\"..\"", "got \"..\""},
       {"/weights/file", "\"a/b\"", "got \"a/b\""},
       {"/weights/file", "\"a\\\\b\"", "weights.file"},
       {"/weights/file", "\"a\\u0000b\"", "weights.file"},
       {"/weights/bytes", "0", "weights.bytes: expected a whole number"},
       {"/weights/bytes", "536870913",
        "weights.bytes: expected a whole number from 1 to 536870912, got 536870913"},
       {"/weights/sha256", "\"abc\"",
        "weights.sha256: expected 64 digits of lower-case hex, got \"abc\""},
       {"/weights/sha256", "\"AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA\"",
        "lower-case hex"},
       {"/created", "\"yesterday\"", "created: expected a time as in RFC 3339, got \"yesterday\""},
       {"/training/epochs", "7", "training.epochs: expected a string"},
       {"/metrics/afd.kick", "\"good\"", "metrics.afd.kick: expected a number"}});
}

TEST(Manifest, ANewerFormatIsNamedBeforeItsNewFields) {
  json root = CompleteJson();
  root["format_version"] = 3;
  root["new_field"] = true;
  EXPECT_THAT(ParseManifest(root.dump()), IsInvalid("format_version: expected a whole number"));
}

Manifest FlowManifest() {
  Manifest manifest = CompleteManifest();
  FlowArchitecture flow;
  flow.width = 12;
  flow.blocks = 2;
  flow.heads = 3;
  flow.feed_forward = 20;
  flow.reach = 7;
  flow.offset_scale = 0.25;
  flow.noise = {3.5, 0.5, 6, 0.03};
  flow.steps = 4;
  flow.guidance = 1.25;
  flow.fade_frames = 2;
  manifest.architecture = flow;
  return manifest;
}

TEST(FlowManifest, RoundTrip) {
  const Manifest read = RoundTrip(FlowManifest());
  ASSERT_TRUE(std::holds_alternative<FlowArchitecture>(read.architecture));
  const auto& flow = std::get<FlowArchitecture>(read.architecture);
  EXPECT_EQ(flow.width, 12);
  EXPECT_EQ(flow.heads, 3);
  EXPECT_EQ(flow.offset_scale, 0.25);
  EXPECT_EQ(flow.noise.white, 0.03);
  EXPECT_EQ(flow.guidance, 1.25);
  EXPECT_EQ(flow.fade_frames, 2);
  EXPECT_TRUE(read.model.samples);
  EXPECT_TRUE(read.model.accepts_follower_start);
}

TEST(FlowManifest, HiddenFramesAreAnotherFeatureOfEveryFrame) {
  Manifest manifest = FlowManifest();
  auto& flow = std::get<FlowArchitecture>(manifest.architecture);
  const int64_t without = FrameFeatureCount(manifest, flow);
  EXPECT_FALSE(json::parse(SerializeManifest(manifest))["generator"].contains("hidden_frames"));
  flow.hidden_frames = true;
  EXPECT_EQ(FrameFeatureCount(manifest, flow), without + 1);
  EXPECT_TRUE(std::get<FlowArchitecture>(RoundTrip(manifest).architecture).hidden_frames);
}

// Version 1 had no kinds: all its generators are the paper's.
TEST(FlowManifest, PaperGeneratorDoesNotSample) {
  Manifest manifest = TinyManifest();
  manifest.weights = FlowManifest().weights;
  for (const int version : {kCheckpointFormatVersion, 1}) {
    manifest.format_version = version;
    EXPECT_EQ(json::parse(SerializeManifest(manifest))["generator"].contains("kind"), version > 1);
    const Manifest read = RoundTrip(manifest);
    EXPECT_TRUE(std::holds_alternative<PaperArchitecture>(read.architecture));
    EXPECT_FALSE(read.model.samples);
  }
}

TEST(FlowManifest, RejectsByName) {
  ExpectRejected(
      FlowManifest(),
      {{"/generator/kind", "\"wave\"",
        "generator.kind: expected \"paper\" or \"flow\", got \"wave\""},
       {"/generator/kind", "\"paper\"", "generator.variant"},
       {"/generator/heads", "5", "generator.heads: expected a divisor of the width 12, got 5"},
       {"/generator/width", "0", "generator.width: expected"},
       {"/generator/steps", "0", "generator.steps: expected"},
       {"/generator/offset_scale", "0", "generator.offset_scale"},
       {"/generator/noise/white", "-1", "generator.noise.white"},
       {"/generator/noise/colour", "1", "generator.noise: unknown field \"colour\""},
       {"/generator/more", "1", "generator: unknown field \"more\""},
       {"/generator/frame_labels", "true",
        "generator.guidance: expected 1 with frame_labels, got 1.25"},
       {"/format_version", "1", "generator"}});
}

std::map<std::string, std::vector<int64_t>> ShapesOf(const Manifest& manifest) {
  std::map<std::string, std::vector<int64_t>> shapes;
  for (const TensorSpec& spec : ExpectedTensors(manifest)) shapes[spec.name] = spec.shape;
  return shapes;
}

TEST(FlowManifest, SizesDetermineTheTensors) {
  const std::map<std::string, std::vector<int64_t>> shapes = ShapesOf(FlowManifest());
  using Shape = std::vector<int64_t>;
  EXPECT_EQ(shapes.at("frames.weight"), (Shape{12, 9 * 3 + 5}));
  EXPECT_EQ(shapes.at("start.weight"), (Shape{12, 3 + 9 + 2}));
  EXPECT_EQ(shapes.at("label.weight"), (Shape{12, 2}));
  EXPECT_EQ(shapes.at("block1.attention.weight"), (Shape{36, 12}));
  EXPECT_EQ(shapes.at("block1.distance"), (Shape{3, 15}));
  EXPECT_EQ(shapes.at("block0.expand.weight"), (Shape{20, 12}));
  EXPECT_EQ(shapes.at("output.weight"), (Shape{9, 12}));
  EXPECT_EQ(shapes.at("base.poses"), (Shape{2, 9}));
  EXPECT_EQ(shapes.at("noise.roots"), (Shape{2, 9, 9}));
  EXPECT_EQ(shapes.count("block2.distance"), 0u);
}

TEST(FlowManifest, FrameLabelsAreAnInputOfEveryFrame) {
  Manifest manifest = FlowManifest();
  EXPECT_FALSE(json::parse(SerializeManifest(manifest))["generator"].contains("frame_labels"));
  auto& flow = std::get<FlowArchitecture>(manifest.architecture);
  flow.frame_labels = true;
  flow.guidance = 1;
  const Manifest read = RoundTrip(manifest);
  EXPECT_TRUE(std::get<FlowArchitecture>(read.architecture).frame_labels);
  const std::map<std::string, std::vector<int64_t>> shapes = ShapesOf(read);
  EXPECT_EQ(shapes.at("frames.weight"), (std::vector<int64_t>{12, 9 * 3 + 5 + 2}));
  EXPECT_EQ(shapes.count("label.weight"), 0u);
}

// A manifest with every optional field of its classes and bodies.
Manifest ManifestWithHabits() {
  Manifest manifest = CompleteManifest();  // of a model with the classes kick and hug
  manifest.model.touching_classes = {"kick"};
  manifest.model.hand_contacts = {{"hug", 0.25}};
  manifest.model.trunk_contacts = {
      {"hug", manifest.model.skeleton.joint_names[0], {0.5f, 1, -0.25f}}};
  manifest.model.facing_classes = {{"hug", 64}};
  manifest.model.bone_ratios.assign(manifest.model.skeleton.bones.size(), 0.9);
  return manifest;
}

TEST(HabitsInManifest, RoundTrip) {
  const engine::ModelDescription wanted = ManifestWithHabits().model;
  const engine::ModelDescription got = RoundTrip(ManifestWithHabits()).model;
  EXPECT_EQ(got.touching_classes, wanted.touching_classes);
  ASSERT_THAT(got.hand_contacts, SizeIs(1));
  EXPECT_EQ(got.hand_contacts[0].interaction_class, "hug");
  EXPECT_EQ(got.hand_contacts[0].metres, 0.25);
  ASSERT_THAT(got.trunk_contacts, SizeIs(1));
  EXPECT_EQ(got.trunk_contacts[0].interaction_class, "hug");
  EXPECT_EQ(got.trunk_contacts[0].hand, wanted.skeleton.joint_names[0]);
  EXPECT_EQ(got.trunk_contacts[0].place, (motion::Vec3{0.5f, 1, -0.25f}));
  ASSERT_THAT(got.facing_classes, SizeIs(1));
  EXPECT_EQ(got.facing_classes[0].interaction_class, "hug");
  EXPECT_EQ(got.facing_classes[0].degrees, 64);
  EXPECT_EQ(got.bone_ratios, wanted.bone_ratios);
  const engine::ModelDescription without = RoundTrip(CompleteManifest()).model;
  EXPECT_THAT(without.hand_contacts, IsEmpty());
  EXPECT_THAT(without.facing_classes, IsEmpty());
  EXPECT_THAT(without.bone_ratios, IsEmpty());
}

TEST(HabitsInManifest, BodiesTouchInAHugIfTheFieldIsAbsent) {
  json silent = CompleteJson();
  EXPECT_THAT(ParseManifest(silent.dump())->model.touching_classes, IsEmpty());
  silent.erase("touching_classes");
  EXPECT_THAT(ParseManifest(silent.dump())->model.touching_classes, ElementsAre("hug"));
  silent["classes"] = {"kick", "bow"};
  EXPECT_THAT(ParseManifest(silent.dump())->model.touching_classes, IsEmpty());
}

TEST(HabitsInManifest, RejectsByName) {
  ExpectRejected(
      ManifestWithHabits(),
      {{"/touching_classes", R"(["hug","dance"])",
        "touching_classes: expected one of classes, got \"dance\""},
       {"/touching_classes", R"(["hug","hug"])", "repeated"},
       {"/hand_contacts", R"({"bow": 0.1})", "hand_contacts: expected one of classes, got \"bow\""},
       {"/hand_contacts", R"({"hug": 3})", "hand_contacts.hug"},
       {"/trunk_contacts/0", "1", "trunk_contacts[0]: expected an object, got 1"},
       {"/trunk_contacts/0/class", R"("bow")", "trunk_contacts[0].class: expected one of classes"},
       {"/trunk_contacts/0/hand", R"("tail")",
        "trunk_contacts[0].hand: expected one of skeleton.joint_names, got \"tail\""},
       {"/trunk_contacts/0/up", "3", "trunk_contacts[0].up"},
       {"/facing_classes", R"({"walk": 60})",
        "facing_classes: expected one of classes, got \"walk\""},
       {"/facing_classes", R"({"hug": 181})", "facing_classes.hug"},
       {"/bone_ratios/1", "0", "bone_ratios[1]: expected a number from 0.1"},
       {"/bone_ratios/1", "\"long\"", "got \"long\""},
       {"/bone_ratios", "[0.9]", "(one for each bone), got"},
       {"/bone_ratios", "[0.9, 0.9, 0.9]", "bone_ratios"}});
}

// Checkpoints of earlier versions have fields of stages that are gone.
TEST(Manifest, ReadsFormerFieldsAndDoesNotWriteThemAgain) {
  json root = CompleteJson();
  const json former = {{"turning_classes", {{"hug", 240}}},
                       {"steps_in_time", true},
                       {"hip_height", 0.88},
                       {"astride_seconds", 0.6},
                       {"held_out_seconds", 1.2},
                       {"strikes", {{"hug", "fist"}}}};
  root.update(former);
  const absl::StatusOr<Manifest> read = ParseManifest(root.dump());
  ASSERT_THAT(read, IsOk());
  const json again = json::parse(SerializeManifest(*read));
  for (const auto& field : former.items()) EXPECT_FALSE(again.contains(field.key()));
}

// Three joints: 2 (3 + 1) + 1 features.
std::vector<double> Numbers(double first) {
  std::vector<double> numbers;
  for (int i = 0; i < 9; ++i) numbers.push_back(first + i / 7.0);
  return numbers;
}

Manifest DirectedManifest() {
  Manifest manifest = CompleteManifest();
  static_cast<engine::AngleRegression&>(manifest.model.partner_direction.emplace()) = {
      Numbers(-0.3), Numbers(0.1), Numbers(-1), Numbers(0.2)};
  return manifest;
}

// With a correction, to which each of the manifest's classes adds something.
Manifest CorrectedManifest() {
  Manifest manifest = DirectedManifest();
  engine::DirectionCorrection& correction = manifest.model.partner_direction->correction.emplace();
  static_cast<engine::AngleRegression&>(correction) = {Numbers(0), Numbers(2), Numbers(3),
                                                       Numbers(4)};
  for (std::size_t c = 0; c < manifest.model.classes.size(); ++c) {
    const double first = static_cast<double>(c);
    correction.classes.push_back({Numbers(5 + first), Numbers(-first)});
  }
  return manifest;
}

TEST(DirectionManifest, RoundTrip) {
  const Manifest read = RoundTrip(CorrectedManifest());
  ASSERT_TRUE(read.model.partner_direction.has_value());
  EXPECT_EQ(read.model.partner_direction->mean, Numbers(-0.3));
  EXPECT_EQ(read.model.partner_direction->deviation, Numbers(0.1));
  EXPECT_EQ(read.model.partner_direction->cosine, Numbers(-1));
  EXPECT_EQ(read.model.partner_direction->sine, Numbers(0.2));
  ASSERT_TRUE(read.model.partner_direction->correction.has_value());
  const engine::DirectionCorrection& correction = *read.model.partner_direction->correction;
  EXPECT_EQ(correction.mean, Numbers(0));
  EXPECT_EQ(correction.sine, Numbers(4));
  ASSERT_EQ(correction.classes.size(), read.model.classes.size());
  EXPECT_EQ(correction.classes[1].cosine, Numbers(6));
  EXPECT_EQ(correction.classes[1].sine, Numbers(-1));
  EXPECT_FALSE(RoundTrip(DirectedManifest()).model.partner_direction->correction.has_value());
  EXPECT_FALSE(RoundTrip(CompleteManifest()).model.partner_direction.has_value());
}

TEST(DirectionManifest, RejectsByName) {
  ExpectRejected(
      CorrectedManifest(),
      {{"/partner_direction", "1", "partner_direction"},
       {"/partner_direction", "{}", "partner_direction.mean"},
       {"/partner_direction/mean", "[1,2,3,4,5,6,7,8]",
        "partner_direction.mean: expected 9 numbers (two for each joint, three more), got 8"},
       {"/partner_direction/sine", "[1,2,3,4,5,6,7,8,9,10]", "partner_direction.sine"},
       {"/partner_direction/deviation/3", "0", "partner_direction.deviation[3]: expected a number"},
       {"/partner_direction/cosine/0", "\"x\"", "partner_direction.cosine[0]: expected a number"},
       {"/partner_direction/cosine/8", "1e9", "partner_direction.cosine[8]"},
       {"/partner_direction/tangent", "[1]", "partner_direction: unknown field \"tangent\""},
       {"/partner_direction/correction", "1", "partner_direction.correction"},
       {"/partner_direction/correction/mean", "1", "partner_direction.correction.mean"},
       {"/partner_direction/correction/classes", "[]",
        "partner_direction.correction.classes: expected one object for each of the"},
       {"/partner_direction/correction/classes/1", "3",
        "partner_direction.correction.classes[1]: expected an object, got 3"},
       {"/partner_direction/correction/classes/1/sine/2", "\"x\"",
        "partner_direction.correction.classes[1].sine[2]: expected a number"},
       {"/partner_direction/correction/classes/1/tangent", "1",
        "partner_direction.correction.classes[1]: unknown field \"tangent\""}});
}

TEST(DirectionManifest, NeedsHips) {
  json root = json::parse(SerializeManifest(DirectedManifest()));
  root["skeleton"].erase("left_hip");
  root["skeleton"].erase("right_hip");
  EXPECT_THAT(ParseManifest(root.dump()), StatusIs(absl::StatusCode::kInvalidArgument,
                                                   HasSubstr("partner_direction: expected none")));
  root.erase("partner_direction");
  EXPECT_THAT(ParseManifest(root.dump()), IsOk());
}

Manifest ManifestWithLeaders() {
  Manifest manifest = CompleteManifest();
  manifest.model.leader_statistics = engine::LeaderStatistics{
      {{"root_height", 0.95, 1.0 / 3}, {"mean_joint_speed", -0.125, 0.5}}, 1.4};
  return manifest;
}

TEST(LeaderStatisticsInManifest, RoundTrip) {
  Manifest manifest = ManifestWithLeaders();
  const Manifest read = RoundTrip(manifest);
  ASSERT_TRUE(read.model.leader_statistics.has_value());
  const engine::LeaderStatistics& leaders = *read.model.leader_statistics;
  ASSERT_THAT(leaders.features, SizeIs(2));
  EXPECT_EQ(leaders.features[0].name, "root_height");
  EXPECT_EQ(leaders.features[0].mean, 0.95);
  EXPECT_EQ(leaders.features[0].deviation, 1.0 / 3);
  EXPECT_EQ(leaders.features[1].mean, -0.125);
  EXPECT_EQ(leaders.scale, 1.4);
  EXPECT_FALSE(RoundTrip(CompleteManifest()).model.leader_statistics.has_value());
  manifest.architecture = FlowManifest().architecture;
  EXPECT_TRUE(RoundTrip(manifest).model.leader_statistics.has_value());
}

TEST(LeaderStatisticsInManifest, RejectsByName) {
  ExpectRejected(ManifestWithLeaders(),
                 {{"/leader_statistics", "3", "leader_statistics: expected an object, got 3"},
                  {"/leader_statistics/scale", "0", "leader_statistics.scale: expected"},
                  {"/leader_statistics/more", "0", "leader_statistics: unknown field \"more\""},
                  {"/leader_statistics/features", "[]",
                   "leader_statistics.features: expected at least one feature, got none"},
                  {"/leader_statistics/features/1", "7",
                   "leader_statistics.features[1]: expected an object, got 7"},
                  {"/leader_statistics/features/1/deviation", "0",
                   "leader_statistics.features[1].deviation: expected"},
                  {"/leader_statistics/features/0/mean", "\"much\"",
                   "leader_statistics.features[0].mean: expected"},
                  {"/leader_statistics/features/0/median", "1",
                   "leader_statistics.features[0]: unknown field \"median\""},
                  {"/leader_statistics/features/1/name", "\"root_height\"",
                   "leader_statistics.features[1].name: \"root_height\" is repeated"},
                  // The tiny skeleton has no hands.
                  {"/leader_statistics/features/0/name", "\"hand_reach\"",
                   "leader_statistics.features[0].name: expected one of mean_joint_speed, "
                   "highest_joint_speed"}});
  // A reader of only version 1 would reject them.
  Manifest older = ManifestWithLeaders();
  older.format_version = 1;
  EXPECT_THAT(ParseManifest(SerializeManifest(older)), IsInvalid("leader_statistics"));
}

}  // namespace
}  // namespace duet::checkpoint
