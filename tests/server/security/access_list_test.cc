#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "server/security/secret_files.h"
#include "tests/support/matchers.h"

namespace duet::server::security {
namespace {

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;
const std::string kDigestA(64, 'a');
const std::string kDigestB(64, 'b');

absl::StatusOr<std::vector<Caller>> Parse(const std::string& text) {
  return ParseAccessList(text, "access");
}

TEST(AccessListTest, ParsesCallersAndSkipsComments) {
  const auto callers =
      Parse(absl::StrCat("# who may call\n\n", "studio-a\tsynthesise  sha256:", kDigestA,
                         " sha256:", kDigestB, " calls_per_second=2.5\r\n",
                         "ops admin,synthesise cert:ops.example cert:spiffe://duet/ops\n"));
  ASSERT_THAT(callers, IsOk());
  ASSERT_EQ(callers->size(), 2u);
  const Caller& studio = callers->front();
  EXPECT_EQ(studio.name, "studio-a");
  EXPECT_THAT(studio.roles, ElementsAre(Role::kSynthesise));
  EXPECT_THAT(studio.token_digests, ElementsAre(kDigestA, kDigestB));
  EXPECT_EQ(studio.calls_per_second, 2.5);
  const Caller& ops = callers->back();
  EXPECT_THAT(ops.roles, ElementsAre(Role::kSynthesise, Role::kAdmin));
  EXPECT_THAT(ops.certificate_names, ElementsAre("ops.example", "spiffe://duet/ops"));
  EXPECT_FALSE(ops.calls_per_second.has_value());
}

TEST(AccessListTest, AcceptsDigestsInUpperCase) {
  const auto callers = Parse(absl::StrCat("a synthesise sha256:", std::string(64, 'F')));
  ASSERT_THAT(callers, IsOk());
  EXPECT_THAT(callers->front().token_digests, ElementsAre(std::string(64, 'f')));
}

TEST(AccessListTest, RejectsAListWithoutCallers) {
  for (const char* text : {"", "\n", "# closed\n"}) {
    EXPECT_THAT(Parse(text), StatusIs(kInvalid, StartsWith("access: expected at least one caller, "
                                                           "got none; ")))
        << text;
  }
}

TEST(AccessListTest, ReportsEveryWrongLine) {
  const std::string good = absl::StrCat(" synthesise sha256:", kDigestA, "\n");
  EXPECT_THAT(Parse(absl::StrCat("a\nb dance cert:b\n", "c", good, "c", good)),
              StatusIs(kInvalid, AllOf(StartsWith("access:1: expected a name"),
                                       HasSubstr("\naccess:2: expected the role synthesise"),
                                       HasSubstr("\naccess:4: expected each name once, got \"c\""),
                                       Not(HasSubstr("access:3:")))));
  std::string many;
  for (int i = 0; i < 100; ++i) many += "nonsense\n";
  EXPECT_THAT(Parse(many), StatusIs(kInvalid, AllOf(HasSubstr("\naccess:20: "),
                                                    Not(HasSubstr("\naccess:21: ")))));
}

TEST(AccessListTest, RejectsCertificateNamesWithoutClientAuthorities) {
  const std::string text =
      absl::StrCat("a synthesise sha256:", kDigestA, "\n", "b synthesise cert:b.example\n");
  EXPECT_THAT(ParseAccessList(text, "access", /*certificates=*/true), IsOk());
  EXPECT_THAT(ParseAccessList(text, "access", /*certificates=*/false),
              StatusIs(kInvalid,
                       "access:2: expected no cert: without tls_client_ca_file, got "
                       "\"cert:b.example\"; set tls_client_ca_file, or give b a token"));
}

TEST(AccessListTest, ErrorNamesTheLine) {
  const std::string good = absl::StrCat(" synthesise sha256:", kDigestA);
  const auto refused = [](const std::string& line, const std::string& why) {
    EXPECT_THAT(Parse("#\n" + line),
                StatusIs(kInvalid, AllOf(HasSubstr("access:2: "), HasSubstr(why))))
        << line;
  };
  refused("a", "got 1 word");
  refused("a synthesise", "got 2 words");
  refused("a/b" + good, "got \"a/b\"");
  refused(std::string(65, 'a') + good, "1 to 64");
  refused(absl::StrCat("a reader sha256:", kDigestA),
          "expected the role synthesise, admin or both with a comma between them, got \"reader\"");
  refused(absl::StrCat("a synthesise, sha256:", kDigestA), "got \"\"");
  refused("a synthesise calls_per_second=3",
          "expected sha256:DIGEST or cert:NAME for a, got neither");
  refused("a synthesise cert:", "another word");
  refused("a" + good + " quota=3", "another word");
  for (const char* rate : {"0", "-1", "nan", "inf", "many", "", "1000001"}) {
    refused(absl::StrCat("a", good, " calls_per_second=", rate), "expected calls_per_second as");
  }
}

TEST(AccessListTest, ErrorDoesNotRepeatAToken) {
  EXPECT_THAT(Parse("a synthesise sha256:hunter2"),
              StatusIs(kInvalid, AllOf(HasSubstr("got 7 characters"), Not(HasSubstr("hunter2")))));
  EXPECT_THAT(Parse("a synthesise hunter2"), StatusIs(kInvalid, Not(HasSubstr("hunter2"))));
}

TEST(AccessListTest, RejectsSharedNamesAndCredentials) {
  const std::string first = absl::StrCat("a synthesise cert:x sha256:", kDigestA, "\n");
  EXPECT_THAT(Parse(first + "a synthesise cert:y"), StatusIs(kInvalid, HasSubstr("second time")));
  EXPECT_THAT(Parse(first + "b synthesise cert:x"), StatusIs(kInvalid, HasSubstr("second time")));
  EXPECT_THAT(Parse(absl::StrCat(first, "b admin sha256:", kDigestA)),
              StatusIs(kInvalid, AllOf(HasSubstr("second time"), Not(HasSubstr(kDigestA)))));
}

TEST(AccessListTest, AcceptsAtMostAThousandCallers) {
  std::string text;
  for (int i = 0; i < 1000; ++i) absl::StrAppend(&text, "c", i, " synthesise cert:n", i, "\n");
  EXPECT_THAT(Parse(text), IsOk());
  EXPECT_THAT(Parse(text + "more synthesise cert:more"),
              StatusIs(kInvalid, HasSubstr("at most 1000 callers")));
}

}  // namespace
}  // namespace duet::server::security
