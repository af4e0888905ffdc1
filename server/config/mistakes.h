#ifndef DUET_SERVER_CONFIG_MISTAKES_H_
#define DUET_SERVER_CONFIG_MISTAKES_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/string_view.h"
#include "server/config/settings.h"

namespace duet::server::config {

// Collects every mistake of a configuration, one line each:
// "field: expected ..., got ... (source, if known); hint".
class Mistakes {
 public:
  // `sources` outlives this object.
  explicit Mistakes(const SettingSources& sources) : sources_(sources) {}

  // `got` may quote a user's text as it is.
  void Add(absl::string_view field, absl::string_view expected, absl::string_view got,
           absl::string_view hint = "");
  // `message` begins with the field and a colon; it may quote a user's text as it is.
  void Add(const std::string& message, absl::string_view hint = "");

  std::vector<std::string> Take() { return std::move(lines_); }

 private:
  const SettingSources& sources_;
  std::vector<std::string> lines_;
};

}  // namespace duet::server::config

#endif  // DUET_SERVER_CONFIG_MISTAKES_H_
