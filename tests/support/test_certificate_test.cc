#include "tests/support/test_certificate.h"

#include <gtest/gtest.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <memory>
#include <string>

namespace duet::test {
namespace {

using Certificate = std::unique_ptr<X509, decltype(&X509_free)>;

Certificate Read(const std::string& pem) {
  const std::unique_ptr<BIO, decltype(&BIO_free)> bio(
      BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())), BIO_free);
  return {PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr), X509_free};
}

bool Vouches(const TestCertificate& signer, const TestCertificate& certificate) {
  return X509_verify(Read(certificate.certificate).get(),
                     X509_get0_pubkey(Read(signer.certificate).get())) == 1;
}

TEST(TestCertificateTest, IsVouchedForByItsSignerAlone) {
  const TestCertificate authority = MakeTestCertificate("authority.test");
  const TestCertificate other = MakeTestCertificate("authority.test");
  const TestCertificate issued = MakeTestCertificate("duet.test", {&authority});
  EXPECT_TRUE(Vouches(authority, authority));
  EXPECT_TRUE(Vouches(authority, issued));
  EXPECT_FALSE(Vouches(other, issued));
}

TEST(TestCertificateTest, IsValidWhenItIsToBe) {
  const Certificate now = Read(MakeTestCertificate("duet.test").certificate);
  EXPECT_LT(X509_cmp_current_time(X509_get0_notBefore(now.get())), 0);
  EXPECT_GT(X509_cmp_current_time(X509_get0_notAfter(now.get())), 0);
  const Certificate past =
      Read(MakeTestCertificate("duet.test", {nullptr, -7200, -3600}).certificate);
  EXPECT_LT(X509_cmp_current_time(X509_get0_notAfter(past.get())), 0);
}

}  // namespace
}  // namespace duet::test
