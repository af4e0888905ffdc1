#include "tests/support/test_certificate.h"

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <memory>

#include "gtest/gtest.h"

namespace duet::test {
namespace {

using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
using Certificate = std::unique_ptr<X509, decltype(&X509_free)>;

template <typename Write>
std::string ToPem(const Write& write) {
  const std::unique_ptr<BIO, decltype(&BIO_free)> memory(BIO_new(BIO_s_mem()), BIO_free);
  EXPECT_EQ(write(memory.get()), 1);
  char* text = nullptr;
  const auto size = BIO_get_mem_data(memory.get(), &text);
  return {text, static_cast<size_t>(size)};
}

void AddExtension(X509* certificate, int kind, const std::string& value) {
  const std::unique_ptr<X509_EXTENSION, decltype(&X509_EXTENSION_free)> extension(
      X509V3_EXT_conf_nid(nullptr, nullptr, kind, value.c_str()), X509_EXTENSION_free);
  EXPECT_EQ(X509_add_ext(certificate, extension.get(), -1), 1);
}

std::unique_ptr<BIO, decltype(&BIO_free)> Reading(const std::string& pem) {
  return {BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())), BIO_free};
}

// Has `certificate` vouched for by `signer`.
void Sign(X509* certificate, const TestCertificate& signer) {
  const Certificate issuer(
      PEM_read_bio_X509(Reading(signer.certificate).get(), nullptr, nullptr, nullptr), X509_free);
  const Key key(
      PEM_read_bio_PrivateKey(Reading(signer.private_key).get(), nullptr, nullptr, nullptr),
      EVP_PKEY_free);
  X509_set_issuer_name(certificate, X509_get_subject_name(issuer.get()));
  EXPECT_GT(X509_sign(certificate, key.get(), EVP_sha256()), 0);
}

}  // namespace

TestCertificate MakeTestCertificate(const std::string& name,
                                    const TestCertificateOptions& options) {
  const Key key(EVP_EC_gen("P-256"), EVP_PKEY_free);
  const Certificate certificate(X509_new(), X509_free);
  X509_set_version(certificate.get(), 2);  // counted from 0: version 3
  ASN1_INTEGER_set(X509_get_serialNumber(certificate.get()), 1);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), options.valid_from);
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), options.valid_until);
  X509_set_pubkey(certificate.get(), key.get());
  X509_NAME* subject = X509_get_subject_name(certificate.get());
  X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
  X509_set_issuer_name(certificate.get(), subject);
  AddExtension(certificate.get(), NID_basic_constraints,
               options.signer == nullptr ? "critical,CA:TRUE" : "critical,CA:FALSE");
  AddExtension(certificate.get(), NID_subject_alt_name, "DNS:" + name);
  if (options.signer == nullptr) {
    EXPECT_GT(X509_sign(certificate.get(), key.get(), EVP_sha256()), 0);
  } else {
    Sign(certificate.get(), *options.signer);
  }
  return {ToPem([&](BIO* out) { return PEM_write_bio_X509(out, certificate.get()); }),
          ToPem([&](BIO* out) {
            return PEM_write_bio_PrivateKey(out, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
          })};
}

}  // namespace duet::test
