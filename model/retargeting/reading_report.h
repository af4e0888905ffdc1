#ifndef DUET_MODEL_RETARGETING_READING_REPORT_H_
#define DUET_MODEL_RETARGETING_READING_REPORT_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace duet::retargeting {

// Who decided something about a motion file.
enum class Origin {
  kGiven,    // whoever reads it, beside the file
  kFile,     // the file says it
  kGuessed,  // found from the motion
  kDefault,  // taken where nothing says otherwise
};
// "given", "file", "guessed" or "default".
absl::string_view OriginName(Origin origin);

struct Setting {
  std::string value;  // "30 Hz", "centimetres", "y-up"
  Origin origin = Origin::kFile;
  std::string why;  // may be empty
};

// Where a joint of the skeleton is found in the file.
struct JointReading {
  struct Part {
    std::string name;  // of the file
    float weight = 1;
  };
  std::string joint;        // of the skeleton
  std::vector<Part> parts;  // the joint is their weighted mean; none where it is missing
  Origin origin = Origin::kFile;
  std::string why;  // empty where the name alone says it
};

// How a motion file was understood. Filled in as far as reading came, also where it failed.
struct ReadingReport {
  std::string format;  // "BVH"
  int people = 0;      // in the file
  std::vector<std::string> file_joints;
  std::optional<Setting> frame_rate, unit, up_axis;  // absent: nothing says
  std::vector<JointReading> joints;                  // [skeleton joints]
  std::vector<std::string> remarks;                  // what else was decided, and warnings
};

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_READING_REPORT_H_
