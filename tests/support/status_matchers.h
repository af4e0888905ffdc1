#ifndef DUET_TESTS_SUPPORT_STATUS_MATCHERS_H_
#define DUET_TESTS_SUPPORT_STATUS_MATCHERS_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "gmock/gmock.h"

namespace duet::test {

inline const absl::Status& StatusOf(const absl::Status& status) { return status; }
template <typename T>
const absl::Status& StatusOf(const absl::StatusOr<T>& result) {
  return result.status();
}

// Matches an OK Status or StatusOr:  ASSERT_THAT(ReadCheckpoint(folder), IsOk());
MATCHER(IsOk, negation ? "is an error" : "is OK") {
  *result_listener << StatusOf(arg);
  return StatusOf(arg).ok();
}

// Matches an error by its code and message:
//   EXPECT_THAT(ParseManifest(text), StatusIs(absl::StatusCode::kInvalidArgument,
//                                             HasSubstr("classes")));
MATCHER_P2(StatusIs, code, message,
           absl::StrCat(negation ? "is not " : "is ", absl::StatusCodeToString(code),
                        " with a message that ",
                        ::testing::DescribeMatcher<std::string>(message, negation))) {
  *result_listener << StatusOf(arg);
  return StatusOf(arg).code() == code &&
         ::testing::Matches(message)(std::string(StatusOf(arg).message()));
}

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_STATUS_MATCHERS_H_
