#ifndef DUET_CLIENT_CLI_VALUE_SYNTAX_H_
#define DUET_CLIENT_CLI_VALUE_SYNTAX_H_

#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/batch/level.h"
#include "client/batch/pins.h"
#include "client/batch/text_values.h"
#include "client/cli/synthesize_arguments.h"
#include "client/request.h"
#include "model/motion/beat.h"
#include "model/motion/coordinates.h"

namespace duet::client::cli {

// The syntax of the program's flag values. Errors: INVALID_ARGUMENT "expected ..., got ...". The
// server checks whether a class exists and a weight is in range.

// As in recipes and manifests.
using batch::ParseDirection;
using batch::ParseLevel;
using batch::ParseModelChoice;
using batch::ParsePin;
using batch::ParsePoint;
using batch::ParseSeed;

// "kick=0.5", or "kick" for a weight of 1
absl::StatusOr<ClassWeight> ParseClassWeight(absl::string_view text);

// "30:kick=1,hug=0": weights at a frame; "8b:kick=1" and "8.5b:kick=1": at a position in beats
absl::StatusOr<KeyframeArgument> ParseKeyframe(absl::string_view text);

// "180", or "180,0.25" with the time of the first beat in seconds, at most one beat before 0
absl::StatusOr<motion::Beat> ParseBeat(absl::string_view text);

// "left_hand=LeftWrist": a joint of the model, and the file's joint that it is read from
absl::StatusOr<std::pair<std::string, std::string>> ParseJointPair(absl::string_view text);

// "0.5": a number from 0 to 2
absl::StatusOr<float> ParseVariety(absl::string_view text);

// "job-7": as model/base/request_id.h says
absl::StatusOr<std::string> ParseRequestId(absl::string_view text);

// "millimetres", "z-up": as ParseLengthUnit and ParseUpAxis know them
absl::StatusOr<motion::LengthUnit> ParseUnit(absl::string_view text);
absl::StatusOr<motion::UpAxis> ParseAxis(absl::string_view text);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_VALUE_SYNTAX_H_
