#include "tests/fuzz/promises.h"

#include <algorithm>
#include <cstddef>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"

namespace duet::fuzz {
namespace {

// A file of a hundred mistakes may have a line for each.
constexpr std::size_t kLongestMessage = std::size_t{1} << 16;

bool IsPlain(absl::string_view message) {
  return std::all_of(message.begin(), message.end(), [](unsigned char c) {
    return c == '\n' || c >= 0x80 || absl::ascii_isprint(c);
  });
}

}  // namespace

Broken CheckRefusal(const absl::Status& status, std::initializer_list<absl::StatusCode> codes) {
  if (status.ok()) return "";
  if (std::find(codes.begin(), codes.end(), status.code()) == codes.end()) {
    return absl::StrCat("a refusal has an unexpected code: ", status.ToString());
  }
  if (status.message().empty()) return "a refusal says nothing";
  if (status.message().size() > kLongestMessage) {
    return absl::StrCat("a refusal has ", status.message().size(), " bytes");
  }
  if (!IsPlain(status.message())) {
    return absl::StrCat("a refusal has control characters: ", absl::CHexEscape(status.message()));
  }
  return "";
}

std::vector<absl::string_view> Parts(absl::string_view input, int count) {
  std::vector<absl::string_view> parts = absl::StrSplit(input, absl::MaxSplits('\0', count - 1));
  parts.resize(static_cast<std::size_t>(count));
  return parts;
}

}  // namespace duet::fuzz
