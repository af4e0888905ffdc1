#ifndef DUET_MODEL_FORMATS_ASF_AMC_MOTION_H_
#define DUET_MODEL_FORMATS_ASF_AMC_MOTION_H_

#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "model/formats/asf/asf_skeleton.h"
#include "model/retargeting/rotation.h"

namespace duet::formats::asf {

// The motion of a skeleton as stored in an .amc file.
struct AmcMotion {
  int frame_count = 0;
  // Lengths in the file's unit, angles in radians. [frames, freedoms of all bones in their order]
  std::vector<float> values;
};

// Parses the motion of `skeleton`. Every frame must have every bone that can move exactly once.
//
// Errors: INVALID_ARGUMENT "source:line: ...: expected ..., got ...".
absl::StatusOr<AmcMotion> ParseAmc(absl::string_view text, absl::string_view source,
                                   const AsfSkeleton& skeleton);

// Computes the start of each bone, and the end of each bone without children, by forward
// kinematics.
class AsfKinematics {
 public:
  // Both arguments must outlive the kinematics.
  AsfKinematics(const AsfSkeleton& skeleton, const AmcMotion& motion);
  // Returns the starts of all bones, then the ends of the bones in `ends`.
  std::vector<retargeting::Vec3d> Positions(int frame) const;
  // Bones without children, in order.
  const std::vector<int>& ends() const { return ends_; }

 private:
  const AsfSkeleton& skeleton_;
  const AmcMotion& motion_;
  std::size_t freedoms_ = 0;  // of all bones
  std::vector<int> ends_;
};

}  // namespace duet::formats::asf

#endif  // DUET_MODEL_FORMATS_ASF_AMC_MOTION_H_
