#include "server/security/access_list.h"

#include <algorithm>
#include <set>
#include <string>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"

namespace duet::server::security {
namespace {

constexpr std::size_t kMaxNameBytes = 64;
constexpr std::size_t kDigestCharacters = 64;
constexpr double kMaxCallsPerSecond = 1e6;

bool IsName(absl::string_view text) {
  return !text.empty() && text.size() <= kMaxNameBytes &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return absl::ascii_isalnum(c) || c == '-' || c == '_' || c == '.';
         });
}

bool IsDigest(absl::string_view text) {
  return text.size() == kDigestCharacters &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return absl::ascii_isxdigit(c); });
}

// What stands before and after the first `separator`; an empty second part where there is none.
std::pair<absl::string_view, absl::string_view> Split(absl::string_view word, char separator) {
  return absl::StrSplit(word, absl::MaxSplits(separator, 1));
}

absl::Status Wanted(absl::string_view what, absl::string_view came, absl::string_view wanted) {
  return absl::InvalidArgumentError(
      absl::StrCat(what, " is ", base::Quoted(came), ", wanted ", wanted));
}

absl::Status ReadRoles(absl::string_view word, Caller& caller) {
  for (const absl::string_view role : absl::StrSplit(word, ',')) {
    if (role == RoleName(Role::kSynthesise)) {
      caller.roles.insert(Role::kSynthesise);
    } else if (role == RoleName(Role::kAdmin)) {
      caller.roles.insert(Role::kAdmin);
    } else {
      return Wanted("a role", role, "synthesise, admin or both with a comma between them");
    }
  }
  return absl::OkStatus();
}

absl::Status ReadLimit(absl::string_view name, absl::string_view text, Caller& caller) {
  double value = 0;
  const bool number = base::ParseNumber(text, &value);
  if (name == "calls_per_second") {
    if (!number || value <= 0 || value > kMaxCallsPerSecond) {
      return Wanted(name, text, "a number above 0 and up to a million");
    }
    caller.limits.calls_per_second = value;
    return absl::OkStatus();
  }
  int frames = 0;
  if (!base::ParseInteger(text, &frames) || frames < 1) {
    return Wanted(name, text, "a whole number of 1 or more");
  }
  caller.limits.frames_in_flight = frames;
  return absl::OkStatus();
}

absl::Status ReadWord(absl::string_view word, Caller& caller) {
  if (const auto [name, value] = Split(word, '=');
      name == "calls_per_second" || name == "frames_in_flight") {
    return ReadLimit(name, value, caller);
  }
  const auto [kind, value] = Split(word, ':');
  if (kind == "sha256") {
    // Not quoted: whoever took a token for its digest must not find it in a log.
    if (!IsDigest(value)) {
      return absl::InvalidArgumentError(
          absl::StrCat("sha256: has ", value.size(),
                       " characters, wanted the 64 hexadecimal digits of a token's SHA-256"));
    }
    caller.token_digests.push_back(absl::AsciiStrToLower(value));
    return absl::OkStatus();
  }
  if (kind == "cert" && !value.empty()) {
    caller.certificate_names.emplace_back(value);
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      "a word is none of sha256:DIGEST, cert:NAME, calls_per_second=N, frames_in_flight=N");
}

absl::StatusOr<Caller> ReadCaller(absl::string_view line) {
  const std::vector<absl::string_view> words =
      absl::StrSplit(line, absl::ByAnyChar(" \t"), absl::SkipEmpty());
  if (words.size() < 3) {
    return absl::InvalidArgumentError(absl::StrCat(
        "has ", words.size(), " words, wanted a name, its roles and sha256:DIGEST or cert:NAME"));
  }
  Caller caller;
  caller.name = std::string(words[0]);
  if (!IsName(words[0])) {
    return Wanted("the name", words[0], "1 to 64 letters, digits, '-', '_' and '.'");
  }
  absl::Status status = ReadRoles(words[1], caller);
  for (std::size_t i = 2; i < words.size() && status.ok(); ++i) status = ReadWord(words[i], caller);
  if (!status.ok()) return status;
  if (caller.token_digests.empty() && caller.certificate_names.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(caller.name, " is known by nothing, wanted sha256:DIGEST or cert:NAME"));
  }
  return caller;
}

// What callers may not share: two callers of one token would be one by chance.
class Taken {
 public:
  absl::Status Take(const Caller& caller) {
    if (!names_.insert(caller.name).second) return Twice("the name", caller.name);
    for (const std::string& digest : caller.token_digests) {
      if (!digests_.insert(digest).second) return Twice("a token of", caller.name);
    }
    for (const std::string& name : caller.certificate_names) {
      if (!certificates_.insert(name).second) return Twice("the certificate name", name);
    }
    return absl::OkStatus();
  }

 private:
  static absl::Status Twice(absl::string_view what, absl::string_view name) {
    return absl::InvalidArgumentError(
        absl::StrCat(what, " ", base::Quoted(name), " stands here a second time"));
  }

  std::set<std::string> names_;
  std::set<std::string> digests_;
  std::set<std::string> certificates_;
};

}  // namespace

absl::StatusOr<std::vector<Caller>> ParseAccessList(std::string_view text,
                                                    std::string_view source) {
  const absl::string_view file(source.data(), source.size());
  std::vector<Caller> callers;
  Taken taken;
  base::LineReader lines(base::SkipByteOrderMark({text.data(), text.size()}));
  for (absl::string_view line; lines.Next(&line);) {
    line = absl::StripAsciiWhitespace(line);
    if (line.empty() || line.front() == '#') continue;
    absl::StatusOr<Caller> caller = ReadCaller(line);
    const absl::Status status = caller.ok() ? taken.Take(*caller) : caller.status();
    if (!status.ok()) return base::ErrorAt(file, lines.number(), status.message());
    callers.push_back(*std::move(caller));
    if (callers.size() > kMaxCallers) {
      return base::ErrorAt(file, lines.number(),
                           absl::StrCat("wanted at most ", kMaxCallers, " callers"));
    }
  }
  return callers;
}

}  // namespace duet::server::security
