#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/security/secret_files.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_certificate.h"

namespace duet::server::security {
namespace {

using test::MakeTestCertificate;
using test::TemporaryFolder;
using test::TestCertificate;
using test::TestCertificateOptions;
using test::WriteTestFile;

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;

class TlsMaterialTest : public ::testing::Test {
 protected:
  absl::StatusOr<absl::Time> Check() const { return CheckTlsMaterial(material_, absl::Now()); }

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
    EXPECT_THAT(CheckTlsMaterial(material, absl::Now()),
                StatusIs(kInvalid, HasSubstr("tls_certificate_file: expected PEM")));
    material = material_;
    material.private_key = nonsense;
    EXPECT_THAT(CheckTlsMaterial(material, absl::Now()),
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

}  // namespace
}  // namespace duet::server::security
