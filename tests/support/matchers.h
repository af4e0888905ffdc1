#ifndef DUET_TESTS_SUPPORT_MATCHERS_H_
#define DUET_TESTS_SUPPORT_MATCHERS_H_

#include "gmock/gmock.h"
#include "tests/support/status_matchers.h"

// The matchers that many tests use. Tests are in namespaces within duet, so they need no
// using-declarations of their own.

namespace duet {

using test::IsOk;
using test::StatusIs;

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::DoubleEq;
using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::EndsWith;
using ::testing::Field;
using ::testing::FloatEq;
using ::testing::FloatNear;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::Pair;
using ::testing::Pointwise;
using ::testing::SizeIs;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

}  // namespace duet

#endif  // DUET_TESTS_SUPPORT_MATCHERS_H_
