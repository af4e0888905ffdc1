#include "model/formats/research/layout.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "model/formats/flat/npy_array.h"
#include "model/formats/research/body_joints.h"
#include "model/formats/research/humanml3d_features.h"
#include "model/formats/research/intergen_features.h"
#include "model/motion/motion_limits.h"
#include "model/motion/resample.h"

namespace duet::formats::research {
namespace {

using flat::NpyNumbers;

struct Row {
  Layout layout;
  const char* name;
  double frame_rate_hz;
};
constexpr Row kRows[] = {{Layout::kHumanMl3d, "humanml3d", 20},
                         {Layout::kHumanMl3dFeatures, "humanml3d-263", 20},
                         {Layout::kInterGen, "intergen", 30},
                         {Layout::kInterGenFeatures, "intergen-262", 30},
                         {Layout::kInterX, "inter-x", 30}};

constexpr int kBodyWidth = 3 * kBodyJoints;
// InterHuman: 62 positions, then 51 rotations as six numbers.
constexpr int kInterHumanWidth = 62 * 3 + 51 * 6;

bool IsBody(int joints) {
  return joints == kBodyJoints || joints == 24 || joints == 52 || joints == 55;
}

// Where the values of people and frames are in an array of people, frames and numbers.
struct Blocks {
  int people = 1, frames = 0, width = 0;
  bool side_by_side = false;  // the people are in one row

  std::size_t At(int person, int frame) const {
    const auto row = side_by_side ? static_cast<std::size_t>(frame) * people + person
                                  : static_cast<std::size_t>(person) * frames + frame;
    return row * static_cast<std::size_t>(width);
  }
};

class LayoutParser {
 public:
  LayoutParser(Layout layout, const NpyNumbers& numbers, absl::string_view source)
      : layout_(layout), numbers_(numbers), source_(source) {}

  absl::StatusOr<motion::RecordedMotion> Parse() {
    const std::optional<Blocks> blocks = Find();
    if (!blocks) return WrongShape();
    if (blocks->frames < 1 || blocks->frames > motion::kMaxMotionFrames) {
      return absl::InvalidArgumentError(absl::StrCat(source_, ": shape: expected 1 to ",
                                                     motion::kMaxMotionFrames, " frames, got ",
                                                     blocks->frames));
    }
    motion::RecordedMotion motion;
    if (blocks->width == kInterHumanWidth) motion.coordinates.up_axis = motion::UpAxis::kZUp;
    for (int person = 0; person < blocks->people; ++person) {
      absl::StatusOr<motion::Clip> clip = layout_ == Layout::kHumanMl3dFeatures
                                              ? ReadFeatures(*blocks, person)
                                              : ReadPositions(*blocks, person);
      if (!clip.ok()) return clip.status();
      motion.people.push_back(*std::move(clip));
    }
    return motion;
  }

 private:
  std::optional<Blocks> Find() const {
    const std::vector<int>& shape = numbers_.shape();
    switch (layout_) {
      case Layout::kHumanMl3dFeatures:
        return FindRows(shape, kHumanMl3dWidth, 1);
      case Layout::kInterGenFeatures:
        return FindRows(shape, kInterGenWidth, 2);
      case Layout::kInterGen:
        if (const auto rows = FindRows(shape, kInterHumanWidth, 1)) return rows;
        break;
      case Layout::kHumanMl3d:
      case Layout::kInterX:
        break;
    }
    return FindPositions(shape);
  }

  // [frames, width], [people, frames, width] or [frames, people * width].
  static std::optional<Blocks> FindRows(const std::vector<int>& shape, int width, int most_people) {
    const std::size_t rank = shape.size();
    if (rank == 2 && most_people == 2 && shape[1] == 2 * width) {
      return Blocks{2, shape[0], width, true};
    }
    if (rank < 2 || rank > 3 || shape[rank - 1] != width) return std::nullopt;
    const int people = rank == 3 ? shape[0] : 1;
    if (people < 1 || people > most_people) return std::nullopt;
    return Blocks{people, shape[rank - 2], width, false};
  }

  static std::optional<Blocks> FindPositions(const std::vector<int>& shape) {
    const std::size_t rank = shape.size();
    if (rank == 2) return FindRows(shape, kBodyWidth, 1);
    if (rank < 3 || rank > 4 || shape[rank - 1] != 3 || !IsBody(shape[rank - 2])) {
      return std::nullopt;
    }
    const int people = rank == 4 ? shape[0] : 1;
    if (people < 1 || people > 2) return std::nullopt;
    return Blocks{people, shape[rank - 3], 3 * shape[rank - 2], false};
  }

  absl::Status WrongShape() const {
    const char* expected = "(frames, 22, 3) or (2, frames, 22, 3)";
    if (layout_ == Layout::kHumanMl3dFeatures) expected = "(frames, 263)";
    if (layout_ == Layout::kInterGenFeatures) {
      expected = "(frames, 262), (2, frames, 262) or (frames, 524)";
    }
    if (layout_ == Layout::kInterGen) {
      expected = "(frames, 22, 3), (2, frames, 22, 3) or (frames, 492)";
    }
    return absl::InvalidArgumentError(absl::StrCat(source_, ": shape: expected ", expected,
                                                   " for layout ", LayoutName(layout_), ", got (",
                                                   absl::StrJoin(numbers_.shape(), ", "), ")"));
  }

  absl::Status NotAPosition(int frame, double value) const {
    return absl::InvalidArgumentError(
        absl::StrCat(source_, ": frame ", frame, ": expected finite numbers, got ", value));
  }

  absl::StatusOr<motion::Clip> ReadPositions(const Blocks& blocks, int person) const {
    motion::Clip clip;
    clip.joint_names = BodySkeleton().joint_names;
    clip.poses = motion::Poses(blocks.frames, kBodyJoints);
    for (int frame = 0; frame < blocks.frames; ++frame) {
      std::size_t at = blocks.At(person, frame);
      for (motion::Vec3& position : clip.poses[frame]) {
        for (float* axis : {&position.x, &position.y, &position.z}) {
          const double value = numbers_.at(at++);
          if (!(std::abs(value) <= motion::kMaxCoordinate)) return NotAPosition(frame, value);
          *axis = static_cast<float>(value);
        }
      }
    }
    return clip;
  }

  absl::StatusOr<motion::Clip> ReadFeatures(const Blocks& blocks, int person) const {
    std::vector<double> features;
    for (int frame = 0; frame < blocks.frames; ++frame) {
      const std::size_t at = blocks.At(person, frame);
      for (std::size_t i = 0; i < kHumanMl3dWidth; ++i) {
        const double value = numbers_.at(at + i);
        if (!(std::abs(value) <= motion::kMaxCoordinate)) return NotAPosition(frame, value);
        features.push_back(value);
      }
    }
    motion::Clip clip = ToClip(FromHumanMl3dFeatures(features), 0);
    for (std::size_t i = 0; i < clip.poses.all().size(); ++i) {
      const motion::Vec3 position = clip.poses.all()[i];
      for (const float axis : {position.x, position.y, position.z}) {
        if (!(std::abs(axis) <= static_cast<float>(motion::kMaxCoordinate))) {
          return NotAPosition(static_cast<int>(i) / kBodyJoints, static_cast<double>(axis));
        }
      }
    }
    return clip;
  }

  Layout layout_;
  const NpyNumbers& numbers_;
  absl::string_view source_;
};

bool IsFeatures(Layout layout) {
  return layout == Layout::kHumanMl3dFeatures || layout == Layout::kInterGenFeatures;
}

std::vector<std::vector<BodyPose>> PosesOf(const std::vector<motion::Clip>& people) {
  std::vector<std::vector<BodyPose>> poses;
  for (const motion::Clip& person : people) poses.push_back(ToDouble(person));
  return poses;
}

// Names only the array of several people by its first size.
std::string FormatArray(std::vector<int> shape, std::size_t people,
                        const std::vector<float>& values) {
  if (people > 1) shape.insert(shape.begin(), static_cast<int>(people));
  return flat::FormatNpyArray(shape, values);
}

}  // namespace

absl::string_view LayoutName(Layout layout) {
  for (const Row& row : kRows) {
    if (row.layout == layout) return row.name;
  }
  return "";
}

std::optional<Layout> ParseLayout(absl::string_view name) {
  for (const Row& row : kRows) {
    if (row.name == name) return row.layout;
  }
  return std::nullopt;
}

double FrameRateOf(Layout layout) {
  for (const Row& row : kRows) {
    if (row.layout == layout) return row.frame_rate_hz;
  }
  return 0;
}

std::optional<Layout> GuessLayout(absl::string_view npy, std::string* why) {
  const absl::StatusOr<flat::NpyHeader> header = flat::ParseNpyHeader(npy, "");
  if (!header.ok()) return std::nullopt;
  const std::vector<int>& shape = header->shape;
  if (shape.size() < 2 || shape.size() > 3) return std::nullopt;
  const int width = shape.back();
  std::optional<Layout> layout;
  if (width == kInterGenWidth) layout = Layout::kInterGenFeatures;
  if (shape.size() == 2 && width == 2 * kInterGenWidth) layout = Layout::kInterGenFeatures;
  if (shape.size() == 2 && width == kHumanMl3dWidth) layout = Layout::kHumanMl3dFeatures;
  if (shape.size() == 2 && width == kInterHumanWidth) layout = Layout::kInterGen;
  if (layout) *why = absl::StrCat("only it has ", width, " numbers in a row");
  return layout;
}

absl::StatusOr<motion::RecordedMotion> ParseNpyOf(Layout layout, absl::string_view npy,
                                                  absl::string_view source) {
  const absl::StatusOr<NpyNumbers> numbers = NpyNumbers::Parse(npy, source);
  if (!numbers.ok()) return numbers.status();
  return LayoutParser(layout, *numbers, source).Parse();
}

absl::StatusOr<std::vector<motion::Clip>> ToLayout(Layout layout,
                                                   const std::vector<motion::Clip>& people,
                                                   std::vector<std::string>* notes) {
  if (layout == Layout::kHumanMl3dFeatures && people.size() != 1) {
    return absl::InvalidArgumentError(
        absl::StrCat("people: expected one for layout ", LayoutName(layout),
                     ", which does not hold where they are, got ", people.size()));
  }
  std::vector<motion::Clip> bodies;
  std::vector<std::string> placed;
  const double rate_hz = FrameRateOf(layout);
  for (const motion::Clip& person : people) {
    absl::StatusOr<motion::Clip> body = ToBody(person, &placed);
    if (!body.ok()) return body.status();
    if (body->frame_rate_hz != rate_hz && body->frame_count() > 1) {
      body->poses = motion::Resample(body->poses, body->frame_rate_hz, rate_hz);
    }
    body->frame_rate_hz = rate_hz;
    bodies.push_back(*std::move(body));
  }
  if (IsFeatures(layout) && bodies[0].frame_count() < 2) {
    return absl::InvalidArgumentError(absl::StrCat("frames: expected at least 2 for layout ",
                                                   LayoutName(layout), ", got ",
                                                   bodies[0].frame_count()));
  }
  if (notes == nullptr) return bodies;
  if (people[0].frame_rate_hz != rate_hz) {
    notes->push_back(absl::StrCat("resampled from ", people[0].frame_rate_hz, " Hz to the ",
                                  rate_hz, " Hz of layout ", LayoutName(layout)));
  }
  if (!placed.empty()) {
    notes->push_back(absl::StrCat("joints placed, which the motion does not have: ",
                                  absl::StrJoin(placed, ", ")));
  }
  return bodies;
}

std::string FormatNpyOf(Layout layout, const std::vector<motion::Clip>& people) {
  const int frames = people[0].frame_count();
  std::vector<float> values;
  const auto append = [&values](const std::vector<float>& more) {
    values.insert(values.end(), more.begin(), more.end());
  };
  if (layout == Layout::kHumanMl3dFeatures) {
    append(HumanMl3dFeatures(ToDouble(people[0])));
    return FormatArray({frames - 1, kHumanMl3dWidth}, 1, values);
  }
  if (layout == Layout::kInterGenFeatures) {
    for (const auto& placed : AtInterGenStart(PosesOf(people))) append(InterGenFeatures(placed));
    return FormatArray({frames - 1, kInterGenWidth}, people.size(), values);
  }
  for (const motion::Clip& person : people) {
    for (const motion::Vec3& position : person.poses.all()) {
      append({position.x, position.y, position.z});
    }
  }
  return FormatArray({frames, kBodyJoints, 3}, people.size(), values);
}

std::vector<motion::Clip> KeptBy(Layout layout, const std::vector<motion::Clip>& people) {
  const double rate_hz = FrameRateOf(layout);
  if (layout == Layout::kHumanMl3dFeatures) {
    return {ToClip(KeptByHumanMl3d(ToDouble(people[0])), rate_hz)};
  }
  if (layout != Layout::kInterGenFeatures) return people;
  std::vector<motion::Clip> kept;
  for (auto& placed : AtInterGenStart(PosesOf(people))) {
    placed.pop_back();
    kept.push_back(ToClip(placed, rate_hz));
  }
  return kept;
}

}  // namespace duet::formats::research
