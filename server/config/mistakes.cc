#include "server/config/mistakes.h"

#include <cstddef>

#include "absl/strings/str_cat.h"
#include "model/base/printable.h"

namespace duet::server::config {
namespace {

constexpr std::size_t kMaxLineBytes = 1000;

}  // namespace

void Mistakes::Add(absl::string_view field, absl::string_view expected, absl::string_view got,
                   absl::string_view hint) {
  Add(absl::StrCat(field, ": expected ", expected, ", got ", got), hint);
}

void Mistakes::Add(const std::string& message, absl::string_view hint) {
  const auto source = sources_.find(message.substr(0, message.find(':')));
  std::string line = base::Printable(message, kMaxLineBytes);
  if (source != sources_.end()) absl::StrAppend(&line, " (", source->second, ")");
  if (!hint.empty()) absl::StrAppend(&line, "; ", hint);
  lines_.push_back(std::move(line));
}

}  // namespace duet::server::config
