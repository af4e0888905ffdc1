#include "model/formats/research/smpl_motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/types/span.h"
#include "model/formats/research/body_joints.h"
#include "model/formats/research/npz_numbers.h"
#include "model/formats/research/placement.h"
#include "model/formats/research/smpl_body.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::research {
namespace {

using retargeting::Quaternion;
using retargeting::Vec3d;

constexpr std::size_t kPoseNumbers = 3 * std::size_t{kBodyJoints};

// Three numbers for each joint or frame.
struct SmplMotion {
  int frames = 0;
  std::vector<double> poses;  // [frames, kPoseNumbers]
  std::vector<double> trans;  // [frames, 3]
  std::vector<double> betas;
  double frame_rate_hz = 0;
};

// The first of these arrays that the archive has.
std::optional<std::string> FirstOf(const NpzArchive& archive,
                                   std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (archive.Has(name)) return name;
  }
  return std::nullopt;
}

// The numbers of each frame.
std::size_t WidthOf(const NpzNumbers& numbers) {
  return numbers.shape.empty() || numbers.shape[0] < 1
             ? 0
             : numbers.values.size() / static_cast<std::size_t>(numbers.shape[0]);
}

class SmplReader {
 public:
  explicit SmplReader(const NpzArchive& archive) : archive_(archive) {}

  absl::StatusOr<SmplMotion> Read() {
    absl::Status status = archive_.Has("poses") ? ReadPoses() : ReadParts();
    if (status.ok()) status = ReadTrans();
    if (status.ok()) status = ReadBetas();
    if (status.ok()) status = ReadRate();
    if (!status.ok()) return status;
    return std::move(motion_);
  }

 private:
  absl::Status ReadPoses() {
    const absl::StatusOr<NpzNumbers> poses = ReadNumbers(archive_, "poses");
    if (!poses.ok()) return poses.status();
    if (poses->shape.size() < 2 || WidthOf(*poses) < kPoseNumbers) {
      return WrongShape(*poses, "(frames, 66 or more)");
    }
    absl::Status status = SetFrames(*poses);
    if (!status.ok()) return status;
    for (int frame = 0; frame < motion_.frames; ++frame) Append(*poses, frame, kPoseNumbers);
    return absl::OkStatus();
  }

  absl::Status ReadParts() {
    const std::optional<std::string> root = FirstOf(archive_, {"root_orient", "global_orient"});
    const std::optional<std::string> body = FirstOf(archive_, {"pose_body", "body_pose"});
    if (!root || !body) return archive_.Read("poses").status();  // names the arrays that there are
    const absl::StatusOr<NpzNumbers> root_pose = ReadNumbers(archive_, *root);
    if (!root_pose.ok()) return root_pose.status();
    const absl::StatusOr<NpzNumbers> body_pose = ReadNumbers(archive_, *body);
    if (!body_pose.ok()) return body_pose.status();
    if (WidthOf(*root_pose) != 3) return WrongShape(*root_pose, "(frames, 3)");
    absl::Status status = SetFrames(*root_pose);
    if (!status.ok()) return status;
    if (WidthOf(*body_pose) < kPoseNumbers - 3 || body_pose->shape[0] != motion_.frames) {
      return WrongShape(
          *body_pose, absl::StrCat("(", motion_.frames, ", 63) or (", motion_.frames, ", 21, 3)"));
    }
    for (int frame = 0; frame < motion_.frames; ++frame) {
      Append(*root_pose, frame, 3);
      Append(*body_pose, frame, kPoseNumbers - 3);
    }
    return absl::OkStatus();
  }

  absl::Status SetFrames(const NpzNumbers& numbers) {
    motion_.frames = numbers.shape[0];
    if (motion_.frames <= motion::kMaxMotionFrames) return absl::OkStatus();
    return absl::InvalidArgumentError(absl::StrCat(numbers.name, ": expected 1 to ",
                                                   motion::kMaxMotionFrames, " frames, got ",
                                                   motion_.frames));
  }

  void Append(const NpzNumbers& numbers, int frame, std::size_t count) {
    const double* const row =
        numbers.values.data() + static_cast<std::size_t>(frame) * WidthOf(numbers);
    motion_.poses.insert(motion_.poses.end(), row, row + count);
  }

  absl::Status ReadTrans() {
    const std::optional<std::string> name = FirstOf(archive_, {"trans", "transl"});
    if (!name) {
      motion_.trans.resize(3 * static_cast<std::size_t>(motion_.frames));
      return absl::OkStatus();
    }
    absl::StatusOr<NpzNumbers> trans = ReadNumbers(archive_, *name);
    if (!trans.ok()) return trans.status();
    if (WidthOf(*trans) != 3 || trans->shape[0] != motion_.frames) {
      return WrongShape(*trans, absl::StrCat("(", motion_.frames, ", 3)"));
    }
    motion_.trans = std::move(trans->values);
    return absl::OkStatus();
  }

  absl::Status ReadBetas() {
    if (!archive_.Has("betas")) return absl::OkStatus();
    absl::StatusOr<NpzNumbers> betas = ReadNumbers(archive_, "betas");
    if (!betas.ok()) return betas.status();
    if (betas->shape.size() != 1 && betas->shape.size() != 2) {
      return WrongShape(*betas, "(shapes) or (1, shapes)");
    }
    if (betas->shape.size() == 2) betas->values.resize(WidthOf(*betas));
    motion_.betas = std::move(betas->values);
    return absl::OkStatus();
  }

  absl::Status ReadRate() {
    const std::optional<std::string> name =
        FirstOf(archive_, {"mocap_framerate", "mocap_frame_rate", "fps"});
    if (!name) return absl::OkStatus();
    const absl::StatusOr<NpzNumbers> rate = ReadNumbers(archive_, *name);
    if (!rate.ok()) return rate.status();
    if (rate->values.size() != 1) return WrongShape(*rate, "one number");
    motion_.frame_rate_hz = rate->values[0];
    return motion::CheckFrameRate(rate->name, motion_.frame_rate_hz);
  }

  const NpzArchive& archive_;
  SmplMotion motion_;
};

Quaternion FromAxisTimesAngle(const double* v) {
  const Vec3d rotation{v[0], v[1], v[2]};
  const double angle = Norm(rotation);
  if (angle < 1e-12) return {};
  return retargeting::AxisAngle(rotation * (1 / angle), angle);
}

std::vector<motion::Vec3> Pose(const SmplMotion& motion, const BodyPose& rest, int frame) {
  const double* const poses = motion.poses.data() + static_cast<std::size_t>(frame) * kPoseNumbers;
  const double* const trans = motion.trans.data() + static_cast<std::size_t>(frame) * 3;
  std::vector<Quaternion> world(kBodyJoints);
  BodyPose at(kBodyJoints);
  std::vector<motion::Vec3> pose;
  for (std::size_t joint = 0; joint < kBodyJoints; ++joint) {
    const Quaternion local = FromAxisTimesAngle(poses + 3 * joint);
    if (joint == 0) {
      world[0] = local;
      at[0] = rest[0] + Vec3d{trans[0], trans[1], trans[2]};
    } else {
      const auto parent = static_cast<std::size_t>(BodyParents()[joint]);
      world[joint] = world[parent] * local;
      at[joint] = at[parent] + Rotate(world[parent], rest[joint] - rest[parent]);
    }
    pose.push_back(ToFloat(at[joint]));
  }
  return pose;
}

// The directory of an archive with hundreds of arrays.
constexpr std::streamoff kDirectoryBytes = std::streamoff{1} << 16;

}  // namespace

bool MayBeSmplMotion(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file.tellg();
  if (!file || size <= 0) return false;
  std::string end(static_cast<std::size_t>(std::min(size, kDirectoryBytes)), '\0');
  file.seekg(size - static_cast<std::streamoff>(end.size()));
  if (!file.read(end.data(), static_cast<std::streamsize>(end.size()))) return false;
  for (const char* name : {"poses.npy", "pose_body.npy", "body_pose.npy"}) {
    if (absl::StrContains(end, name)) return true;
  }
  return false;
}

absl::StatusOr<motion::Clip> FromSmpl(const NpzArchive& motion, const NpzArchive& model,
                                      const retargeting::CharacterOptions& options) {
  absl::StatusOr<SmplMotion> read = SmplReader(motion).Read();
  if (!read.ok()) return read.status();
  const absl::StatusOr<BodyPose> rest = RestJoints(model, read->betas);
  if (!rest.ok()) return rest.status();
  retargeting::Character character;
  character.tree.names = BodySkeleton().joint_names;
  character.tree.parents = BodyParents();
  for (std::size_t joint = 0; joint < kBodyJoints; ++joint) {
    const int parent = BodyParents()[joint];
    character.tree.offsets.push_back(
        parent < 0 ? Vec3d{} : (*rest)[joint] - (*rest)[static_cast<std::size_t>(parent)]);
  }
  character.frame_count = read->frames;
  character.frame_rate_hz = read->frame_rate_hz;
  character.stated_metres_per_unit = 1;
  character.stated_by = "the body model";
  character.pose = [&](int frame) { return Pose(*read, *rest, frame); };
  if (options.report != nullptr) {
    options.report->people = 1;
    if (read->frame_rate_hz > 0) {
      options.report->frame_rate = retargeting::Setting{absl::StrCat(read->frame_rate_hz, " Hz"),
                                                        retargeting::Origin::kFile, ""};
    }
  }
  return ToClip(character, motion.source(), options);
}

}  // namespace duet::formats::research
