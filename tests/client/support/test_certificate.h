#ifndef DUET_TESTS_CLIENT_SUPPORT_TEST_CERTIFICATE_H_
#define DUET_TESTS_CLIENT_SUPPORT_TEST_CERTIFICATE_H_

#include <string>

namespace duet::test {

// A certificate that vouches for itself, and its private key; PEM.
struct TestCertificate {
  std::string certificate;
  std::string private_key;
};

// For the host `name`; valid for an hour around now. Another one at every call.
TestCertificate MakeTestCertificate(const std::string& name);

}  // namespace duet::test

#endif  // DUET_TESTS_CLIENT_SUPPORT_TEST_CERTIFICATE_H_
