#include "server/security/secret_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
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
using test::WriteTestFile;

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
    return files_->access()->Decide({true, base::Sha256Hex(name), {}}, Role::kSynthesise).answer ==
           AccessControl::Answer::kAllowed;
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

TEST_F(SecretFilesTest, EmptiedListKeepsTheOldOne) {
  UseAccess(Line("a"));
  ASSERT_THAT(Open(), IsOk());
  EXPECT_THAT(files_->state(), IsOk());
  WriteTestFile(options_.access, "");
  EXPECT_THAT(files_->Look(), IsEmpty()) << "it may be being written";
  const std::vector<Reload> changes = files_->Look();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_THAT(changes[0].status, StatusIs(absl::StatusCode::kInvalidArgument,
                                          HasSubstr("expected at least one caller, got none")));
  EXPECT_TRUE(Knows("a"));
  EXPECT_THAT(files_->Refresh(), IsEmpty()) << "reported once";
  EXPECT_EQ(files_->state(), changes[0].status) << "but it stays refused";
  WriteTestFile(options_.access, Line("a"));
  ASSERT_EQ(files_->Refresh().size(), 1u);
  EXPECT_THAT(files_->state(), IsOk());
}

TEST_F(SecretFilesTest, AppliesARewrittenList) {
  UseAccess(Line("a"));
  ASSERT_THAT(Open(), IsOk());
  EXPECT_THAT(files_->Refresh(), IsEmpty());
  WriteTestFile(options_.access, Line("b"));
  const std::vector<Reload> changes = files_->Refresh();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0].kind, "access");
  EXPECT_THAT(changes[0].status, IsOk());
  EXPECT_FALSE(Knows("a"));
  EXPECT_TRUE(Knows("b"));
  EXPECT_THAT(files_->Refresh(), IsEmpty());
}

TEST_F(SecretFilesTest, WaitsUntilAListHasSettled) {
  UseAccess(Line("a"));
  UseTls();
  ASSERT_THAT(Open(), IsOk());
  EXPECT_THAT(files_->Look(), IsEmpty());
  for (const std::string& unfinished : {std::string(), std::string("b synth")}) {
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

TEST_F(SecretFilesTest, AppliesAListBehindAMovedLink) {
  // As Kubernetes mounts a secret: file -> ..data/file, ..data -> a dated folder.
  for (const char* day : {"monday", "tuesday"}) {
    fs::create_directory(folder_ / day);
    WriteTestFile(folder_ / day / "access", Line(day));
  }
  fs::create_directory_symlink("monday", folder_ / "..data");
  fs::create_symlink("..data/access", folder_ / "access");
  options_.access = folder_ / "access";
  ASSERT_THAT(Open(), IsOk());
  EXPECT_TRUE(Knows("monday"));
  fs::create_directory_symlink("tuesday", folder_ / "..next");
  fs::rename(folder_ / "..next", folder_ / "..data");
  EXPECT_EQ(files_->Refresh().size(), 1u);
  EXPECT_TRUE(Knows("tuesday"));
  EXPECT_FALSE(Knows("monday"));
}

TEST_F(SecretFilesTest, ReportsAnInvalidListOnceAndKeepsTheOldOne) {
  UseAccess(Line("a"));
  ASSERT_THAT(Open(), IsOk());
  WriteTestFile(options_.access, Line("b") + "nonsense\n");
  std::vector<Reload> changes = files_->Refresh();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_THAT(changes[0].status,
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("access:2: ")));
  EXPECT_TRUE(Knows("a"));
  EXPECT_FALSE(Knows("b"));
  EXPECT_THAT(files_->Refresh(), IsEmpty());
  fs::remove(options_.access);
  changes = files_->Refresh();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_THAT(changes[0].status, StatusIs(absl::StatusCode::kNotFound, HasSubstr("access_file: ")));
  EXPECT_THAT(files_->Refresh(), IsEmpty());
  EXPECT_TRUE(Knows("a"));
  WriteTestFile(options_.access, Line("b"));
  EXPECT_EQ(files_->Refresh().size(), 1u);
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
