#ifndef DUET_SERVER_SERVICE_REQUEST_FIELDS_H_
#define DUET_SERVER_SERVICE_REQUEST_FIELDS_H_

#include <google/protobuf/repeated_field.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "duet/v1/motion.pb.h"
#include "duet/v1/synthesis.pb.h"
#include "model/base/text.h"
#include "model/engine/model_description.h"
#include "model/motion/coordinates.h"
#include "model/motion/poses.h"
#include "model/motion/vec3.h"
#include "server/service/refusals.h"
#include "server/service/validator.h"

namespace duet::server::service {

// A longer list of joint names is rejected as a whole, without a violation for each name.
inline constexpr int kMaxJointNames = 1024;

// The layout of flat positions [frames, joints, 3].
struct PositionFormat {
  int joint_count = 0;      // as sent
  std::vector<int> joints;  // for each joint sent, its index in the model; empty if unknown
  std::optional<motion::Coordinates> coordinates;  // absent if unknown
};

// The components of a message that has x, y and z.
template <typename Message>
google::protobuf::RepeatedField<float> Components(const Message& message) {
  google::protobuf::RepeatedField<float> xyz;
  for (const float value : {message.x(), message.y(), message.z()}) xyz.Add(value);
  return xyz;
}
template <typename Message>
std::string XyzText(const Message& message) {
  return absl::StrCat("(", message.x(), ", ", message.y(), ", ", message.z(), ")");
}

// Whether all joints of a pose are in one place: a tracker has lost the person.
bool IsPoint(absl::Span<const motion::Vec3> pose);

// Reads and checks the fields that clips and live sessions have in common, one by one. Each method
// adds every invalid field to the violations; its result is then meaningless.
class RequestFields {
 public:
  // `prefix`: precedes every field, such as "start.". The other arguments outlive the reader.
  RequestFields(const engine::ModelDescription& model, const RequestLimits& limits,
                std::string prefix)
      : model_(model), limits_(limits), violations_(std::move(prefix)) {}

  Violations& violations() { return violations_; }

  // Requires at most `most` elements of a repeated field.
  bool AtMost(absl::string_view field, int most, int count);
  // Requires a whole number of `min` to `max`. `hint` follows the range.
  bool Whole(absl::string_view field, uint32_t value, int min, int max,
             absl::string_view hint = "");
  // Requires a finite number in [min, max].
  void Number(absl::string_view field, float value, float min, float max);
  // Requires finite values. Lists the first few that are not, and counts the others.
  bool Finite(absl::string_view field, const google::protobuf::RepeatedField<float>& values);

  // The leader's unit and axis; absent if they are invalid.
  std::optional<motion::Coordinates> Coordinates(const v1::Motion& leader);
  // Returns the index in the model of each joint of the leader. Empty unless the names are the
  // model's joints in any order.
  std::vector<int> Joints(const v1::Motion& leader);
  // Checks frame rate, frame count and duration.
  void Timing(const v1::Motion& leader);

  // Converts flat positions to world poses in the model's joint order; without `frames`, one pose.
  // No frames if a value is missing, not finite or exceeds
  // RequestLimits::max_abs_coordinate_metres, or if the format is not completely known.
  motion::Poses Positions(absl::string_view field,
                          const google::protobuf::RepeatedField<float>& values,
                          std::optional<uint32_t> frames, const PositionFormat& format);
  // Requires poses, in metres, of about a person's size: others are in another unit than the
  // declared one. Single lost joints and frames do not matter: a tracker that has lost the person
  // reports most joints in one place, even in most of the frames. But in some frame, some joint
  // must be elsewhere. Accepts poses without frames.
  void Size(absl::string_view field, const motion::Poses& poses);

  // Reads a label vector in the model's class order: [classes].
  std::vector<float> LabelVector(absl::string_view field, const v1::LabelVector& label_vector);

 private:
  bool Count(absl::string_view field, int values, std::optional<uint32_t> frames, int joints);

  const engine::ModelDescription& model_;
  const RequestLimits& limits_;
  Violations violations_;
};

}  // namespace duet::server::service

#endif  // DUET_SERVER_SERVICE_REQUEST_FIELDS_H_
