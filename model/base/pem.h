#ifndef DUET_MODEL_BASE_PEM_H_
#define DUET_MODEL_BASE_PEM_H_

#include <memory>
#include <string>
#include <vector>

// OpenSSL's types, whose headers no other header should need.
struct x509_st;
struct evp_pkey_st;

namespace duet::base {

struct FreeCertificate {
  void operator()(x509_st* certificate) const;
};
struct FreePrivateKey {
  void operator()(evp_pkey_st* key) const;
};
using Certificate = std::unique_ptr<x509_st, FreeCertificate>;
using PrivateKey = std::unique_ptr<evp_pkey_st, FreePrivateKey>;

// The certificates in PEM text, in its order. Anything else in the text is skipped.
std::vector<Certificate> ReadCertificates(const std::string& pem);

// The private key in PEM text. Null if there is none, or if it has a password.
PrivateKey ReadPrivateKey(const std::string& pem);

// Both are not null.
bool IsKeyOf(const Certificate& certificate, const PrivateKey& key);

}  // namespace duet::base

#endif  // DUET_MODEL_BASE_PEM_H_
