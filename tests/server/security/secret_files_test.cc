#include "server/security/secret_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "model/base/sha256.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_certificate.h"

namespace duet::server::security {
namespace {

namespace fs = std::filesystem;

using test::MakeTestCertificate;
using test::TemporaryFolder;
using test::TestCertificate;
using test::TestCertificateOptions;
using test::WriteTestFile;

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;
const std::string kDigestA(64, 'a');

absl::StatusOr<std::vector<Caller>> Parse(const std::string& text) {
  return ParseAccessList(text, "access");
}

TEST(AccessListTest, ParsesCallersAndSkipsComments) {
  const auto callers =
      Parse(absl::StrCat("# who may call\n\n", "studio-a\tsynthesise  sha256:", kDigestA,
                         " sha256:", std::string(64, 'B'), " calls_per_second=2.5\r\n",
                         "ops admin,synthesise cert:ops.example cert:spiffe://duet/ops\n"));
  ASSERT_THAT(callers, IsOk());
  ASSERT_EQ(callers->size(), 2u);
  const Caller& studio = callers->front();
  EXPECT_EQ(studio.name, "studio-a");
  EXPECT_THAT(studio.roles, ElementsAre(Role::kSynthesise));
  EXPECT_THAT(studio.token_digests, ElementsAre(kDigestA, std::string(64, 'b')));
  EXPECT_EQ(studio.calls_per_second, 2.5);
  const Caller& ops = callers->back();
  EXPECT_THAT(ops.roles, ElementsAre(Role::kSynthesise, Role::kAdmin));
  EXPECT_THAT(ops.certificate_names, ElementsAre("ops.example", "spiffe://duet/ops"));
  EXPECT_FALSE(ops.calls_per_second.has_value());
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
  for (const char* token : {"a synthesise sha256:hunter2", "a synthesise hunter2"}) {
    EXPECT_THAT(Parse(token), StatusIs(kInvalid, Not(HasSubstr("hunter2")))) << "no secret";
  }
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

class TlsMaterialTest : public ::testing::Test {
 protected:
  absl::StatusOr<absl::Time> Check() const { return CheckTlsMaterial(material_); }

  const TestCertificate authority_ = MakeTestCertificate("authority.test");
  const TestCertificate server_ = MakeTestCertificate("duet.test", {&authority_});
  TlsMaterial material_{server_.certificate, server_.private_key, authority_.certificate};
};

TEST_F(TlsMaterialTest, ReturnsTheEndOfTheValidity) {
  const absl::StatusOr<absl::Time> until = Check();
  ASSERT_THAT(until, IsOk());
  EXPECT_GT(*until, absl::Now() + absl::Minutes(20));
  EXPECT_LT(*until, absl::Now() + absl::Minutes(40));
}

TEST_F(TlsMaterialTest, ChecksTheFirstCertificateOfAChain) {
  material_.certificate_chain += authority_.certificate;
  EXPECT_THAT(Check(), IsOk());
  material_.certificate_chain = authority_.certificate + server_.certificate;
  EXPECT_THAT(Check(), StatusIs(kInvalid, HasSubstr("got another certificate's key")));
}

TEST_F(TlsMaterialTest, ErrorNamesTheFileThatIsNotPem) {
  for (const char* nonsense : {"", "nonsense", "-----BEGIN CERTIFICATE-----\nAAAA\n"}) {
    TlsMaterial material = material_;
    material.certificate_chain = nonsense;
    EXPECT_THAT(CheckTlsMaterial(material),
                StatusIs(kInvalid, HasSubstr("tls_certificate_file: expected PEM")));
    material = material_;
    material.private_key = nonsense;
    EXPECT_THAT(CheckTlsMaterial(material),
                StatusIs(kInvalid, HasSubstr("tls_key_file: expected a private key in PEM")));
  }
  material_.client_authorities = "nonsense";
  EXPECT_THAT(Check(), StatusIs(kInvalid, HasSubstr("tls_client_ca_file: expected PEM")));
}

TEST_F(TlsMaterialTest, RejectsACertificateThatIsNotValidNow) {
  for (const TestCertificateOptions& time : {TestCertificateOptions{&authority_, -7200, -3600},
                                             TestCertificateOptions{&authority_, 3600, 7200}}) {
    const TestCertificate other = MakeTestCertificate("duet.test", time);
    material_.certificate_chain = other.certificate;
    material_.private_key = other.private_key;
    EXPECT_THAT(Check(), StatusIs(kInvalid, HasSubstr("expected a certificate that is valid now")));
  }
}

TEST_F(TlsMaterialTest, ErrorNamesAMissingFileAndItsSetting) {
  const TemporaryFolder folder;
  WriteTestFile(folder / "cert.pem", "c");
  WriteTestFile(folder / "key.pem", "k");
  const absl::StatusOr<TlsMaterial> read =
      ReadTlsMaterial({folder / "cert.pem", folder / "key.pem", {}});
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->certificate_chain, "c");
  EXPECT_EQ(read->private_key, "k");
  EXPECT_THAT(ReadTlsMaterial({folder / "cert.pem", folder / "none.pem", {}}),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("tls_key_file: ")));
}

std::string Line(const std::string& name) {
  return absl::StrCat(name, " synthesise sha256:", base::Sha256Hex(name), "\n");
}

class SecretFilesTest : public ::testing::Test {
 protected:
  void WritePair(const TestCertificate& pair) {
    WriteTestFile(folder_ / "cert.pem", pair.certificate);
    WriteTestFile(folder_ / "key.pem", pair.private_key);
  }
  absl::Status Open() {
    absl::StatusOr<std::unique_ptr<SecretFiles>> files = SecretFiles::Open(options_);
    if (files.ok()) files_ = *std::move(files);
    return files.status();
  }
  void UseAccess(const std::string& text) {
    options_.access = folder_ / "access";
    WriteTestFile(options_.access, text);
  }
  void UseTls() {
    options_.tls = {folder_ / "cert.pem", folder_ / "key.pem", {}};
    WritePair(first_);
  }
  bool Knows(const std::string& name) const {
    return files_->access()
        ->Admit({true, base::Sha256Hex(name), {}}, Role::kSynthesise)
        .status.ok();
  }
  std::string Shown() const {
    return files_->certificates()->current().material->certificate_chain;
  }

  const TemporaryFolder folder_;
  const TestCertificate first_ = MakeTestCertificate("duet.test");
  const TestCertificate second_ = MakeTestCertificate("duet.test");
  SecretFiles::Options options_;
  std::unique_ptr<SecretFiles> files_;
};

TEST_F(SecretFilesTest, ReportsEveryMistakeAtTheStart) {
  UseAccess("# nobody\n");
  UseTls();
  WriteTestFile(folder_ / "key.pem", second_.private_key);
  options_.tls.client_ca = folder_ / "ca.pem";
  WriteTestFile(options_.tls.client_ca, "nonsense");
  EXPECT_THAT(Open(),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr("tls_key_file: "), HasSubstr("\ntls_client_ca_file: "),
                             HasSubstr("\naccess_file: "),
                             HasSubstr("expected at least one caller, got none"))));
  options_.tls = {folder_ / "no.pem", folder_ / "no.key", folder_ / "no.ca"};
  EXPECT_THAT(Open(), StatusIs(absl::StatusCode::kNotFound,
                               AllOf(HasSubstr("tls_certificate_file: "), HasSubstr("no.key"),
                                     HasSubstr("no.ca"))));
}

TEST_F(SecretFilesTest, WaitsUntilAListHasSettled) {
  UseAccess(Line("a"));
  UseTls();
  ASSERT_THAT(Open(), IsOk());
  EXPECT_THAT(files_->Look(), IsEmpty());
  for (const char* unfinished : {"", "b synth"}) {
    WriteTestFile(options_.access, unfinished);
    EXPECT_THAT(files_->Look(), IsEmpty());
    EXPECT_TRUE(Knows("a"));
  }
  WriteTestFile(options_.access, Line("b"));
  EXPECT_THAT(files_->Look(), IsEmpty());
  ASSERT_EQ(files_->Look().size(), 1u);
  EXPECT_TRUE(Knows("b"));
  WritePair(second_);
  EXPECT_THAT(files_->Look(), IsEmpty());
  ASSERT_EQ(files_->Look().size(), 1u);
  EXPECT_EQ(Shown(), second_.certificate);
  EXPECT_THAT(files_->Look(), IsEmpty());
}

TEST_F(SecretFilesTest, ReportsAnInvalidListOnceAndKeepsTheOldOne) {
  UseAccess(Line("a"));
  ASSERT_THAT(Open(), IsOk());
  EXPECT_THAT(files_->Refresh(), IsEmpty());
  for (const auto& [text, mistake] :
       {std::pair<std::string, std::string>{Line("b") + "nonsense\n", "access:2: "},
        {"", "expected at least one caller, got none"}}) {
    WriteTestFile(options_.access, text);
    const std::vector<Reload> changes = files_->Refresh();
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_EQ(changes[0].kind, "access");
    EXPECT_THAT(changes[0].status, StatusIs(kInvalid, HasSubstr(mistake)));
    EXPECT_TRUE(Knows("a"));
    EXPECT_THAT(files_->Refresh(), IsEmpty()) << "reported once";
    EXPECT_EQ(files_->state(), changes[0].status) << "but it stays refused";
  }
  fs::remove(options_.access);
  const std::vector<Reload> changes = files_->Refresh();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_THAT(changes[0].status, StatusIs(absl::StatusCode::kNotFound, HasSubstr("access_file: ")));
  WriteTestFile(options_.access, Line("b"));
  EXPECT_EQ(files_->Refresh().size(), 1u);
  EXPECT_THAT(files_->state(), IsOk());
  EXPECT_FALSE(Knows("a"));
  EXPECT_TRUE(Knows("b"));
}

TEST_F(SecretFilesTest, AppliesACertificateOnlyWithItsKey) {
  UseTls();
  ASSERT_THAT(Open(), IsOk());
  EXPECT_EQ(Shown(), first_.certificate);
  WriteTestFile(folder_ / "cert.pem", second_.certificate);
  std::vector<Reload> changes = files_->Refresh();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0].kind, "tls");
  EXPECT_THAT(changes[0].status,
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("another certificate's key")));
  EXPECT_EQ(Shown(), first_.certificate);
  WriteTestFile(folder_ / "key.pem", second_.private_key);
  changes = files_->Refresh();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_THAT(changes[0].status, IsOk());
  EXPECT_EQ(Shown(), second_.certificate);
}

TEST_F(SecretFilesTest, ExpiredCertificateIsNotApplied) {
  UseTls();
  ASSERT_THAT(Open(), IsOk());
  const absl::Time end = files_->certificate_end();
  WritePair(MakeTestCertificate("duet.test", {nullptr, -7200, -3600}));
  ASSERT_EQ(files_->Refresh().size(), 1u);
  EXPECT_EQ(Shown(), first_.certificate);
  EXPECT_EQ(files_->certificate_end(), end);
  WritePair(MakeTestCertificate("duet.test", {nullptr, -1800, 86400}));
  ASSERT_EQ(files_->Refresh().size(), 1u);
  EXPECT_GT(files_->certificate_end(), end);
}

}  // namespace
}  // namespace duet::server::security
