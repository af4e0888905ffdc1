#ifndef DUET_MODEL_RETARGETING_READING_REPORT_H_
#define DUET_MODEL_RETARGETING_READING_REPORT_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace duet::retargeting {

// The origin of a setting of a motion file.
enum class Origin {
  kGiven,    // specified by the caller
  kFile,     // stated by the file
  kGuessed,  // inferred from the motion
  kDefault,  // used if nothing else determines it
};
inline absl::string_view OriginName(Origin origin) {
  return origin == Origin::kGiven     ? "given"
         : origin == Origin::kFile    ? "file"
         : origin == Origin::kGuessed ? "guessed"
                                      : "default";
}

struct Setting {
  std::string value;  // "30 Hz", "centimetres", "y-up"
  Origin origin = Origin::kFile;
  std::string why;  // may be empty
};

// The source of a joint of the skeleton in the file.
struct JointReading {
  struct Part {
    std::string name;  // of the file
    float weight = 1;
  };
  std::string joint;        // of the skeleton
  std::vector<Part> parts;  // the joint is their weighted mean; empty if it is missing
  Origin origin = Origin::kFile;
  std::string why;  // empty if the joint was found by its name
};

// "Spine1", or "0.50 Head + 0.50 HeadTop".
std::string DescribeParts(const std::vector<JointReading::Part>& parts);

// A line for each joint that was chosen among several, or placed:
// "torso: mixamorig:Spine1 (the spine joint nearest to half way from hips to neck)".
std::vector<std::string> JointNotes(const std::vector<JointReading>& joints);

// How a motion file was read. If reading failed, it holds everything up to the failure.
struct ReadingReport {
  std::string format;  // "BVH"
  int people = 0;      // in the file
  std::vector<std::string> file_joints;
  std::optional<Setting> frame_rate, unit, up_axis;  // absent: unknown
  std::vector<JointReading> joints;                  // [skeleton joints]
  std::vector<std::string> remarks;                  // other decisions, and warnings

  // What was inferred, for people who see nothing else of the report: one line each.
  std::vector<std::string> Notes() const;
};

}  // namespace duet::retargeting

#endif  // DUET_MODEL_RETARGETING_READING_REPORT_H_
