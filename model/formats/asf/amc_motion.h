#ifndef DUET_MODEL_FORMATS_ASF_AMC_MOTION_H_
#define DUET_MODEL_FORMATS_ASF_AMC_MOTION_H_

#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/asf/asf_skeleton.h"
#include "model/retargeting/rotation.h"

namespace duet::formats::asf {

// The motion of a skeleton as an .amc file has it.
struct AmcMotion {
  int frame_count = 0;
  // Lengths in the file's unit, angles in radians. [frames, freedoms of all bones in their order]
  std::vector<float> values;
};

// Reads the motion of `skeleton`: every bone that can move, once in every frame.
//
// Errors: INVALID_ARGUMENT "source:line: ... came ..., wanted ..."
absl::StatusOr<AmcMotion> ParseAmc(absl::string_view text, absl::string_view source,
                                   const AsfSkeleton& skeleton);

// Where each bone starts, and for a bone without another below it where it ends, through forward
// kinematics.
class AsfKinematics {
 public:
  // Both outlive the kinematics.
  AsfKinematics(const AsfSkeleton& skeleton, const AmcMotion& motion);
  // [bones, then the ends of `ends`]
  std::vector<retargeting::Vec3d> Positions(int frame) const;
  // Bones without another below, in order.
  const std::vector<int>& ends() const { return ends_; }

 private:
  const AsfSkeleton& skeleton_;
  const AmcMotion& motion_;
  std::size_t freedoms_ = 0;  // of all bones
  std::vector<int> ends_;
};

}  // namespace duet::formats::asf

#endif  // DUET_MODEL_FORMATS_ASF_AMC_MOTION_H_
