#include "server/security/secret_files.h"

#include <cstddef>

#include "absl/strings/str_cat.h"
#include "model/base/file.h"
#include "server/common/error_details.h"
#include "server/security/access_list.h"

namespace duet::server::security {
namespace {

constexpr std::size_t kMaxAccessBytes = std::size_t{1} << 20;

}  // namespace

absl::StatusOr<std::unique_ptr<SecretFiles>> SecretFiles::Open(Options options) {
  std::unique_ptr<SecretFiles> files(new SecretFiles(std::move(options)));
  if (!files->options_.access.empty()) {
    files->access_ = std::make_unique<AccessControl>(*files->options_.clock);
  }
  files->Refresh();
  const absl::Status state = files->state();
  if (!state.ok()) return state;
  return files;
}

std::vector<Reload> SecretFiles::Refresh() { return Read(/*settled=*/false); }

std::vector<Reload> SecretFiles::Look() { return Read(/*settled=*/true); }

std::vector<Reload> SecretFiles::Read(bool settled) {
  std::vector<Reload> changes;
  common::MutexLock lock(mutex_);
  if (!options_.access.empty()) {
    const absl::StatusOr<std::string> text = ReadAccess();
    if (seen_access_.Changed(text, settled)) {
      access_state_ = TakeAccess(text);
      changes.push_back({"access", access_state_});
    }
  }
  if (!options_.tls.certificate.empty()) {
    const absl::StatusOr<TlsMaterial> material = ReadTlsMaterial(options_.tls);
    if (seen_tls_.Changed(material, settled)) {
      tls_state_ = TakeTls(material);
      changes.push_back({"tls", tls_state_});
    }
  }
  return changes;
}

absl::StatusOr<std::string> SecretFiles::ReadAccess() const {
  absl::StatusOr<std::string> text =
      base::ReadFile(options_.access, kMaxAccessBytes, "an access file");
  if (text.ok()) return text;
  return absl::Status(text.status().code(), absl::StrCat("access_file: ", text.status().message()));
}

absl::Status SecretFiles::TakeAccess(const absl::StatusOr<std::string>& text) {
  if (!text.ok()) return text.status();
  absl::StatusOr<std::vector<Caller>> callers =
      ParseAccessList(*text, absl::StrCat("access_file: ", options_.access.string()),
                      {/*certificates=*/!options_.tls.client_ca.empty()});
  if (!callers.ok()) return callers.status();
  access_->Replace(*std::move(callers));
  return absl::OkStatus();
}

absl::Status SecretFiles::TakeTls(const absl::StatusOr<TlsMaterial>& material) {
  if (!material.ok()) return material.status();
  const absl::StatusOr<absl::Time> end = CheckTlsMaterial(*material, options_.now());
  if (!end.ok()) return end.status();
  certificate_end_ = *end;
  if (certificates_ == nullptr) {
    certificates_ = std::make_unique<TlsCertificates>(*material);
  } else {
    certificates_->Replace(*material);
  }
  return absl::OkStatus();
}

absl::Status SecretFiles::state() const {
  common::MutexLock lock(mutex_);
  return common::Join({tls_state_, access_state_});
}

absl::Time SecretFiles::certificate_end() const {
  common::MutexLock lock(mutex_);
  return certificate_end_;
}

}  // namespace duet::server::security
