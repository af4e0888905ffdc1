#ifndef DUET_TESTS_SUPPORT_TEST_CERTIFICATE_H_
#define DUET_TESTS_SUPPORT_TEST_CERTIFICATE_H_

#include <string>

namespace duet::test {

// A certificate and its private key; PEM.
struct TestCertificate {
  std::string certificate;
  std::string private_key;
};

struct TestCertificateOptions {
  const TestCertificate* signer = nullptr;  // null: it vouches for itself
  // Seconds from now.
  long valid_from = -1800;
  long valid_until = 1800;
};

// For the host `name`. Another one at every call.
TestCertificate MakeTestCertificate(const std::string& name,
                                    const TestCertificateOptions& options = {});

}  // namespace duet::test

#endif  // DUET_TESTS_SUPPORT_TEST_CERTIFICATE_H_
