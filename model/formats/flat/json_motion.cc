#include "model/formats/flat/json_motion.h"

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/json_events.h"
#include "model/base/strict_json.h"
#include "model/base/text.h"
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

bool ReadPosition(const Json& value, motion::Vec3* position) {
  if (!value.is_array() || value.size() != 3) return false;
  float* const axes[] = {&position->x, &position->y, &position->z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!value[axis].is_number()) return false;
    const double number = value[axis].get<double>();
    if (!(std::abs(number) <= motion::kMaxCoordinate)) return false;
    *axes[axis] = static_cast<float>(number);
  }
  return true;
}

// Appends one frame. Records an error and returns false if it is invalid.
bool ReadFrame(const Json& frame, const std::string& field, base::ObjectReader* reader,
               motion::Clip* clip) {
  const std::size_t joints = clip->joint_names.size();
  if (!frame.is_array() || frame.size() != joints) {
    reader->Fail(
        field, absl::StrCat("expected a list of ", joints, " positions, got ", base::Shown(frame)));
    return false;
  }
  std::vector<motion::Vec3> pose(joints);
  for (std::size_t joint = 0; joint < joints; ++joint) {
    if (!ReadPosition(frame[joint], &pose[joint])) {
      reader->Fail(
          absl::StrCat(field, "[", joint, "]"),
          absl::StrCat("expected finite numbers [x, y, z], got ", base::Shown(frame[joint])));
      return false;
    }
  }
  clip->Append(pose);
  return true;
}

// Places in a document, as depths of nlohmann::json's parser callback.
constexpr int kFieldDepth = 1, kFrameDepth = 2, kPositionDepth = 3, kNumberDepth = 4;
// One more than a valid frame or position may have. The element that makes it invalid is kept; all
// further elements are dropped.
constexpr std::size_t kMostInPosition = 4, kMostInFrame = motion::kMaxFileJoints + 1;

// The index of a field in kPeople; -1 for any other field.
int PersonIndex(const std::string& key) {
  for (std::size_t i = 0; i < std::size(kPeople); ++i) {
    if (key == kPeople[i]) return static_cast<int>(i);
  }
  return -1;
}

// Reads the positions of a document with valid frames, without building JSON values. Stops at the
// first invalid frame.
class PositionReader : public nlohmann::json_sax<Json> {
 public:
  // `people` has the joint names and must outlive the reader.
  explicit PositionReader(std::vector<motion::Clip>* people) : people_(*people) {
    pose_.reserve(people_[0].joint_names.size());
  }

  bool null() override { return Outside(); }
  bool boolean(bool) override { return Outside(); }
  bool string(string_t&) override { return Outside(); }
  bool binary(binary_t&) override { return Outside(); }
  bool number_integer(number_integer_t value) override { return Add(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return Add(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return Add(value); }
  bool start_object(std::size_t) override { return Open(Outside()); }
  bool end_object() override { return Close(); }

  bool key(string_t& name) override {
    if (depth_ != kFieldDepth) return true;
    const int person = PersonIndex(name);
    clip_ = person >= 0 && person < static_cast<int>(people_.size())
                ? &people_[static_cast<std::size_t>(person)]
                : nullptr;
    return true;
  }

  bool start_array(std::size_t) override {
    if (clip_ == nullptr) return Open(true);
    if (depth_ == kFrameDepth) pose_.clear();
    numbers_ = 0;
    return Open(depth_ < kNumberDepth);
  }

  bool end_array() override {
    Close();
    if (clip_ == nullptr || depth_ == kFieldDepth) return true;
    if (depth_ == kPositionDepth) {
      pose_.push_back({numbers_at_[0], numbers_at_[1], numbers_at_[2]});
      return numbers_ == 3 && pose_.size() <= clip_->joint_names.size();
    }
    if (pose_.size() != clip_->joint_names.size()) return false;
    clip_->Append(pose_);
    return clip_->frame_count() <= motion::kMaxMotionFrames;
  }

  bool parse_error(std::size_t, const std::string&, const Json::exception&) override {
    return false;
  }

 private:
  bool Open(bool good) {
    ++depth_;
    return good;
  }
  bool Close() {
    --depth_;
    return true;
  }
  // Whether a value that is neither a number nor an array may occur here.
  bool Outside() const { return clip_ == nullptr || depth_ == 0; }

  bool Add(double value) {
    if (clip_ == nullptr) return true;
    if (depth_ != kNumberDepth || numbers_ == 3 || !(std::abs(value) <= motion::kMaxCoordinate)) {
      return false;
    }
    numbers_at_[numbers_++] = static_cast<float>(value);
    return true;
  }

  std::vector<motion::Clip>& people_;
  motion::Clip* clip_ = nullptr;  // of the current field; null for fields other than people
  int depth_ = 0;
  std::vector<motion::Vec3> pose_;
  float numbers_at_[3] = {};
  std::size_t numbers_ = 0;
};

// Reports the error in a document that PositionReader stopped at. Removes each frame from the
// document as soon as it is parsed, so that memory does not grow with the text: "[]," is 3 bytes of
// text and 50 in memory.
class FrameReader {
 public:
  // `people` has the joint names. Both arguments must outlive this object.
  FrameReader(base::ObjectReader* reader, std::vector<motion::Clip>* people)
      : reader_(*reader), people_(*people) {}

  bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    if (depth == kFieldDepth && event == Event::key) {
      person_ = PersonIndex(parsed.get_ref<const std::string&>());
      frame_ = 0;
    }
    if (depth < kFrameDepth) return true;
    if (person_ < 0 || person_ >= static_cast<int>(people_.size()) || !reader_.ok()) return false;
    const bool begins = event == Event::array_start || event == Event::object_start;
    const bool ends = event == Event::array_end || event == Event::object_end;
    if (depth > kNumberDepth) return false;
    if (event == Event::key) return true;
    if (depth == kNumberDepth) return ends || ++in_position_ <= kMostInPosition;
    if (depth == kPositionDepth) {
      if (begins) in_position_ = 0;
      return ends || ++in_frame_ <= kMostInFrame;
    }
    if (begins) {
      in_frame_ = 0;
      return true;
    }
    Take(parsed);
    return false;
  }

 private:
  void Take(const Json& frame) {
    const char* field = kPeople[person_];
    if (frame_ == motion::kMaxMotionFrames) {
      reader_.Fail(field, absl::StrCat("expected at most ", frame_, " frames, got more"));
      return;
    }
    ReadFrame(frame, absl::StrCat(field, "[", frame_, "]"), &reader_,
              &people_[static_cast<std::size_t>(person_)]);
    ++frame_;
  }

  base::ObjectReader& reader_;
  std::vector<motion::Clip>& people_;
  int person_ = -1;
  int frame_ = 0;
  std::size_t in_frame_ = 0, in_position_ = 0;
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
  const std::vector<motion::Clip> empty = *people;
  if (!reader->ok()) return;
  PositionReader positions(people);
  const absl::string_view document = base::SkipByteOrderMark(text);
  if (base::ReadJsonEvents({document.data(), document.size()}, &positions)) return;
  *people = empty;
  const Json rest = Json::parse(text.begin(), text.end(), FrameReader(reader, people), false);
  if (rest.is_discarded()) reader->Fail("frames", "expected JSON");
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

std::string FormatJsonMotion(const motion::ClipPair& pair, const motion::Skeleton& skeleton,
                             const motion::JointRotations* rotations) {
  std::string text = FormatSettings(pair.leader, skeleton);
  AppendPerson(kPeople[0], pair.leader, &text);
  AppendPerson(kPeople[1], pair.follower, &text);
  if (rotations != nullptr) AppendRotations(*rotations, &text);
  return text + "}\n";
}

std::string FormatJsonMotion(const motion::Clip& person, const motion::Skeleton& skeleton) {
  std::string text = FormatSettings(person, skeleton);
  AppendPerson(kPeople[0], person, &text);
  return text + "}\n";
}

}  // namespace duet::formats::flat
