#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
#include "model/formats/flat/flat_files.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::flat {
namespace {

using Json = nlohmann::json;

constexpr char kFormat[] = "duet-motion";
constexpr int kVersion = 1;
// Duet's documents have object, people, frames and positions. More depth would only cost memory.
constexpr int kMaxDepth = 8;
constexpr std::size_t kMaxNameBytes = 64;
constexpr const char* kPeople[] = {"leader", "follower"};

// Joint names and settings: a motion without people.
motion::RecordedMotion ReadSettings(base::ObjectReader* reader, motion::Clip* empty) {
  motion::RecordedMotion motion;
  if (reader->Has("format")) {
    const std::string format = reader->String("format", kMaxNameBytes);
    if (format != kFormat) {
      reader->Fail("format", absl::StrCat("expected ", base::Quoted(kFormat), ", got ",
                                          base::Quoted(format)));
    }
  }
  if (reader->Has("version")) reader->Int("version", kVersion, kVersion);
  if (reader->Has("frame_rate_hz")) {
    empty->frame_rate_hz = reader->Number("frame_rate_hz", 0, motion::kMaxFrameRateHz);
    if (reader->ok()) reader->Update(motion::CheckFrameRate("frame_rate_hz", empty->frame_rate_hz));
  }
  if (reader->Has("unit")) {
    motion.coordinates.unit =
        reader->Choice("unit", motion::ParseLengthUnit, motion::kLengthUnitNames);
    motion.says_unit = true;
  }
  if (reader->Has("up_axis")) {
    motion.coordinates.up_axis =
        reader->Choice("up_axis", motion::ParseUpAxis, motion::kUpAxisNames);
    motion.says_up_axis = true;
  }
  empty->joint_names = reader->Strings("joint_names", motion::kMaxFileJoints);
  if (empty->joint_names.empty())
    reader->Fail("joint_names", "expected at least one name, got none");
  return motion;
}

// Depths within a document: a person's list of frames, a frame, a position.
constexpr int kFieldDepth = 1, kFrameDepth = 2, kPositionDepth = 3, kNumberDepth = 4;

// The index of a field in kPeople; -1 for any other field.
int PersonIndex(const std::string& key) {
  for (std::size_t i = 0; i < std::size(kPeople); ++i) {
    if (key == kPeople[i]) return static_cast<int>(i);
  }
  return -1;
}

// Reads the positions of a document without building JSON values, so that memory does not grow with
// the text: "[]," is 3 bytes of text and 50 in memory. Stops at the first invalid frame.
class PositionReader : public nlohmann::json_sax<Json> {
 public:
  // `people` has the joint names. Errors are recorded in `reader`. Both must outlive this object.
  PositionReader(base::ObjectReader* reader, std::vector<motion::Clip>* people)
      : reader_(*reader), people_(*people) {
    pose_.reserve(people_[0].joint_names.size());
  }

  bool null() override { return Other("null"); }
  bool boolean(bool) override { return Other("a boolean"); }
  bool string(string_t&) override { return Other("a string"); }
  bool binary(binary_t&) override { return Other("bytes"); }
  bool number_integer(number_integer_t value) override { return Add(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return Add(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return Add(value); }
  bool start_object(std::size_t) override { return Other("an object") && ++depth_ > 0; }
  bool end_object() override { return --depth_ >= 0; }

  bool key(string_t& name) override {
    if (depth_ != kFieldDepth) return true;
    const int person = PersonIndex(name);
    field_ = name;
    clip_ = person >= 0 && person < static_cast<int>(people_.size())
                ? &people_[static_cast<std::size_t>(person)]
                : nullptr;
    return true;
  }

  bool start_array(std::size_t) override {
    const int outer = depth_++;
    if (clip_ == nullptr) return true;
    if (outer == kFrameDepth && clip_->frame_count() == motion::kMaxMotionFrames) {
      return Fail(field_, absl::StrCat("expected at most ", clip_->frame_count(),
                                       " frames, got "
                                       "more"));
    }
    if (outer == kFrameDepth) pose_.clear();
    if (outer == kPositionDepth && pose_.size() == clip_->joint_names.size())
      return BadFrame("more");
    numbers_ = 0;
    return outer < kNumberDepth || BadPosition("a list");
  }

  bool end_array() override {
    --depth_;
    if (clip_ == nullptr || depth_ == kFieldDepth) return true;
    if (depth_ == kPositionDepth) {
      if (numbers_ != 3) return BadPosition(absl::StrCat(numbers_));
      pose_.push_back({numbers_at_[0], numbers_at_[1], numbers_at_[2]});
      return true;
    }
    if (pose_.size() != clip_->joint_names.size()) return BadFrame(absl::StrCat(pose_.size()));
    clip_->Append(pose_);
    return true;
  }

  bool parse_error(std::size_t, const std::string&, const Json::exception&) override {
    return false;
  }

 private:
  // Returns false.
  bool Fail(const std::string& field, const std::string& problem) {
    reader_.Fail(field, problem);
    return false;
  }
  std::string FrameField() const { return absl::StrCat(field_, "[", clip_->frame_count(), "]"); }
  bool BadFrame(absl::string_view got) {
    return Fail(FrameField(), absl::StrCat("expected a list of ", clip_->joint_names.size(),
                                           " positions, got ", got));
  }
  bool BadPosition(absl::string_view got) {
    return Fail(absl::StrCat(FrameField(), "[", pose_.size(), "]"),
                absl::StrCat("expected finite numbers [x, y, z], got ", got));
  }

  // A value that is neither an array nor, within a position, a number.
  bool Other(absl::string_view what) {
    if (clip_ == nullptr || depth_ <= kFieldDepth) return true;
    return depth_ == kFrameDepth ? BadFrame(what) : BadPosition(what);
  }

  bool Add(double value) {
    if (depth_ != kNumberDepth || clip_ == nullptr) return Other("a number");
    if (numbers_ == 3) return BadPosition("more");
    if (!(std::abs(value) <= motion::kMaxCoordinate)) return BadPosition(absl::StrCat(value));
    numbers_at_[numbers_++] = static_cast<float>(value);
    return true;
  }

  base::ObjectReader& reader_;
  std::vector<motion::Clip>& people_;
  motion::Clip* clip_ = nullptr;  // of the current field; null for fields other than people
  std::string field_;
  int depth_ = 0;
  std::vector<motion::Vec3> pose_;
  float numbers_at_[3] = {};
  std::size_t numbers_ = 0;
};

// Counts the fields that are lists of frames.
int CountPeople(base::ObjectReader* reader) {
  int people = 0;
  for (const char* person : kPeople) {
    if (people > 0 && !reader->Has(person)) break;
    reader->Array(person, motion::kMaxMotionFrames);
    ++people;
  }
  return people;
}

// [1, 2, 3]
void AppendNumbers(std::initializer_list<float> values, std::string* out) {
  char before = '[';
  for (float value : values) {
    *out += before;
    base::AppendNumber(out, value);
    before = ',';
  }
  *out += ']';
}

void AppendPerson(const char* field, const motion::Clip& clip, std::string* out) {
  absl::StrAppend(out, ",\n\"", field, "\": [");
  for (int frame = 0; frame < clip.frame_count(); ++frame) {
    *out += frame == 0 ? "\n[" : ",\n[";
    for (int joint = 0; joint < clip.joint_count(); ++joint) {
      const motion::Vec3 position = clip.at(frame, joint);
      if (joint > 0) *out += ", ";
      AppendNumbers({position.x, position.y, position.z}, out);
    }
    *out += ']';
  }
  *out += "]";
}

Json RigJson(const std::vector<motion::RestJoint>& rig) {
  Json joints = Json::array();
  for (const motion::RestJoint& joint : rig) {
    joints.push_back({{"name", joint.name},
                      {"parent", joint.parent},
                      {"offset", {joint.offset.x, joint.offset.y, joint.offset.z}},
                      {"joint", joint.joint}});
  }
  return joints;
}

void AppendRotations(const motion::JointRotations& rotations, std::string* out) {
  absl::StrAppend(out, ",\n\"rig\": ", RigJson(rotations.rig).dump(), ",\n\"rotations\": [");
  const std::size_t joints = rotations.rig.size();
  for (std::size_t i = 0; i < rotations.rotations.size(); ++i) {
    if (i % joints == 0) *out += i == 0 ? "\n[" : "],\n[";
    const motion::UnitQuaternion& q = rotations.rotations[i];
    if (i % joints > 0) *out += ", ";
    AppendNumbers({q.x, q.y, q.z, q.w}, out);
  }
  *out += rotations.rotations.empty() ? "]" : "]]";
}

// Formats the fields before those of the people.
std::string FormatSettings(const motion::Clip& clip, const motion::Skeleton& skeleton) {
  Json bones = Json::array();
  for (const motion::Bone& bone : skeleton.bones) bones.push_back({bone.parent, bone.child});
  std::string text = absl::StrCat("{\"format\": \"", kFormat, "\", \"version\": ", kVersion,
                                  ", \"frame_rate_hz\": ");
  base::AppendNumber(&text, clip.frame_rate_hz);
  absl::StrAppend(&text, ", \"unit\": \"", LengthUnitName(motion::LengthUnit::kMetres),
                  "\", \"up_axis\": \"", UpAxisName(motion::UpAxis::kYUp),
                  "\",\n\"joint_names\": ", Json(clip.joint_names).dump(),
                  ",\n\"bones\": ", bones.dump());
  return text;
}

// Requires a text that ParseHandwrittenJson accepts.
void ReadPeople(absl::string_view text, base::ObjectReader* reader,
                std::vector<motion::Clip>* people) {
  if (!reader->ok()) return;
  PositionReader positions(reader, people);
  const absl::string_view document = base::SkipByteOrderMark(text);
  if (Json::sax_parse(document.begin(), document.end(), &positions)) return;
  reader->Fail("frames", "expected JSON");
}

}  // namespace

absl::StatusOr<motion::RecordedMotion> ParseJsonMotion(absl::string_view text,
                                                       absl::string_view source) {
  const auto in_file = [source](const absl::Status& status) {
    return absl::InvalidArgumentError(absl::StrCat(source, ": ", status.message()));
  };
  const absl::StatusOr<Json> document =
      base::ParseHandwrittenJson(text, kMaxDepth, {std::begin(kPeople), std::end(kPeople)});
  if (!document.ok()) return in_file(document.status());
  base::ObjectReader reader(*document, "");
  motion::Clip empty;
  motion::RecordedMotion motion = ReadSettings(&reader, &empty);
  if (reader.ok()) {
    motion.people.assign(static_cast<std::size_t>(CountPeople(&reader)), empty);
    ReadPeople(text, &reader, &motion.people);
  }
  for (std::size_t i = 0; i < motion.people.size(); ++i) {
    if (motion.people[i].frame_count() == 0) {
      reader.Fail(kPeople[i], "expected at least 1 frame, got none");
    }
  }
  // Not Finish: other programs may add fields.
  if (!reader.ok()) return in_file(reader.status());
  return motion;
}

std::string FormatJsonMotion(const std::vector<motion::Clip>& people,
                             const motion::Skeleton& skeleton,
                             const motion::JointRotations* rotations) {
  std::string text = FormatSettings(people[0], skeleton);
  for (std::size_t i = 0; i < people.size(); ++i) AppendPerson(kPeople[i], people[i], &text);
  if (rotations != nullptr) AppendRotations(*rotations, &text);
  return text + "}\n";
}

}  // namespace duet::formats::flat
