#ifndef DUET_CLIENT_CLI_GRADE_REPORT_H_
#define DUET_CLIENT_CLI_GRADE_REPORT_H_

#include <string>

#include "client/result.h"
#include "nlohmann/json_fwd.hpp"

namespace duet::client::cli {

// One line, and a second one with the bad frames if there are any.
std::string DescribeGrade(const MotionGrade& grade);

// The fields have the names of duet.v1.MotionGrade. Shares are rounded to a millionth.
nlohmann::json GradeJson(const MotionGrade& grade);

}  // namespace duet::client::cli

#endif  // DUET_CLIENT_CLI_GRADE_REPORT_H_
