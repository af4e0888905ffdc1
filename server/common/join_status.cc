#include "server/common/join_status.h"

#include "absl/strings/str_cat.h"

namespace duet::server::common {

absl::Status Join(const std::vector<absl::Status>& statuses) {
  absl::Status joined;
  for (const absl::Status& status : statuses) {
    if (status.ok()) continue;
    joined = joined.ok() ? status
                         : absl::Status(joined.code(),
                                        absl::StrCat(joined.message(), "\n", status.message()));
  }
  return joined;
}

}  // namespace duet::server::common
