#include "model/base/request_id.h"

#include <algorithm>
#include <cstddef>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "model/base/text.h"

namespace duet::base {
namespace {

constexpr std::size_t kMaxBytes = 128;  // as in kRequestIdForm

}  // namespace

bool IsRequestId(absl::string_view text) {
  return !text.empty() && text.size() <= kMaxBytes &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return absl::ascii_isgraph(c); });
}

absl::Status CheckRequestId(absl::string_view text) {
  if (IsRequestId(text)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("expected ", kRequestIdForm, ", got ", Quoted(text),
                   text.size() > kMaxBytes ? absl::StrCat(" of ", text.size(), " bytes") : ""));
}

}  // namespace duet::base
