#include "server/security/access_list.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "model/base/counted.h"
#include "model/base/text.h"
#include "server/common/error_details.h"

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

// Splits a word at the first `separator`. The second part is empty if there is none.
std::pair<absl::string_view, absl::string_view> Split(absl::string_view word, char separator) {
  return absl::StrSplit(word, absl::MaxSplits(separator, 1));
}

absl::Status Expected(absl::string_view expected, absl::string_view got) {
  return absl::InvalidArgumentError(
      absl::StrCat("expected ", expected, ", got ", base::Quoted(got)));
}

absl::Status ReadRoles(absl::string_view word, Caller& caller) {
  for (const absl::string_view role : absl::StrSplit(word, ',')) {
    if (role == RoleName(Role::kSynthesise)) {
      caller.roles.insert(Role::kSynthesise);
    } else if (role == RoleName(Role::kAdmin)) {
      caller.roles.insert(Role::kAdmin);
    } else {
      return Expected("the role synthesise, admin or both with a comma between them", role);
    }
  }
  return absl::OkStatus();
}

absl::Status ReadLimit(absl::string_view name, absl::string_view text, Caller& caller) {
  double value = 0;
  const bool number = base::ParseNumber(text, &value);
  if (name == "calls_per_second") {
    if (!number || value <= 0 || value > kMaxCallsPerSecond) {
      return Expected("calls_per_second as a number above 0 and up to a million", text);
    }
    caller.limits.calls_per_second = value;
    return absl::OkStatus();
  }
  int frames = 0;
  if (!base::ParseInteger(text, &frames) || frames < 1) {
    return Expected("frames_in_flight as a whole number of 1 or more", text);
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
    // Not quoted, because an operator may have entered the token instead of its digest.
    if (!IsDigest(value)) {
      return absl::InvalidArgumentError(absl::StrCat(
          "expected the 64 hexadecimal digits of a token's SHA-256 after sha256:, got ",
          value.size(), " characters; printf %s TOKEN | sha256sum prints them"));
    }
    caller.token_digests.push_back(absl::AsciiStrToLower(value));
    return absl::OkStatus();
  }
  if (kind == "cert" && !value.empty()) {
    caller.certificate_names.emplace_back(value);
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      "expected sha256:DIGEST, cert:NAME, calls_per_second=N or frames_in_flight=N, got another "
      "word; it is not repeated here because it may be a token");
}

absl::StatusOr<Caller> ReadCaller(absl::string_view line) {
  const std::vector<absl::string_view> words =
      absl::StrSplit(line, absl::ByAnyChar(" \t"), absl::SkipEmpty());
  if (words.size() < 3) {
    return absl::InvalidArgumentError(
        absl::StrCat("expected a name, its roles and sha256:DIGEST or cert:NAME, got ",
                     base::Counted(words.size(), "word")));
  }
  Caller caller;
  caller.name = std::string(words[0]);
  if (!IsName(words[0])) {
    return Expected("a name of 1 to 64 letters, digits, '-', '_' and '.'", words[0]);
  }
  absl::Status status = ReadRoles(words[1], caller);
  for (std::size_t i = 2; i < words.size() && status.ok(); ++i) status = ReadWord(words[i], caller);
  if (!status.ok()) return status;
  if (caller.token_digests.empty() && caller.certificate_names.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat("expected sha256:DIGEST or cert:NAME for ", caller.name, ", got neither"));
  }
  return caller;
}

// Names and credentials that callers may not share: a shared token would not identify a caller.
class Taken {
 public:
  absl::Status Take(const Caller& caller) {
    if (!names_.insert(caller.name).second) return Twice("each name", caller.name);
    for (const std::string& digest : caller.token_digests) {
      if (!digests_.insert(digest).second) return Twice("each token", caller.name);
    }
    for (const std::string& name : caller.certificate_names) {
      if (!certificates_.insert(name).second) return Twice("each certificate name", name);
    }
    return absl::OkStatus();
  }

 private:
  static absl::Status Twice(absl::string_view what, absl::string_view name) {
    return absl::InvalidArgumentError(
        absl::StrCat("expected ", what, " once, got ", base::Quoted(name), " a second time"));
  }

  std::set<std::string> names_;
  std::set<std::string> digests_;
  std::set<std::string> certificates_;
};

// A certificate's name identifies no caller if clients have no certificates.
absl::Status CheckRules(const Caller& caller, const AccessListRules& rules) {
  if (rules.certificates || caller.certificate_names.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("expected no cert: without tls_client_ca_file, got ",
                   base::Quoted("cert:" + caller.certificate_names.front()),
                   "; set tls_client_ca_file, or give ", caller.name, " a token"));
}

// Collects the callers of a file and its mistakes.
class Reader {
 public:
  Reader(absl::string_view source, const AccessListRules& rules) : source_(source), rules_(rules) {}

  void Read(int number, absl::string_view line) {
    absl::StatusOr<Caller> caller = ReadCaller(line);
    absl::Status status = caller.status();
    if (status.ok()) status = taken_.Take(*caller);
    if (status.ok()) status = CheckRules(*caller, rules_);
    if (!status.ok()) return Fail(base::ErrorAt(source_, number, status.message()));
    callers_.push_back(*std::move(caller));
    if (callers_.size() != kMaxCallers + 1) return;
    Fail(
        base::ErrorAt(source_, number, absl::StrCat("expected at most ", kMaxCallers, " callers")));
  }

  absl::StatusOr<std::vector<Caller>> Take() {
    if (mistakes_.empty() && callers_.empty()) {
      Fail(absl::InvalidArgumentError(
          absl::StrCat(source_,
                       ": expected at least one caller, got none; without the setting "
                       "access_file everybody may synthesise")));
    }
    if (absl::Status status = common::Join(mistakes_); !status.ok()) return status;
    return std::move(callers_);
  }

 private:
  void Fail(absl::Status mistake) {
    if (mistakes_.size() < kMaxAccessMistakes) mistakes_.push_back(std::move(mistake));
  }

  const absl::string_view source_;
  const AccessListRules rules_;
  Taken taken_;
  std::vector<Caller> callers_;
  std::vector<absl::Status> mistakes_;
};

}  // namespace

absl::StatusOr<std::vector<Caller>> ParseAccessList(std::string_view text, std::string_view source,
                                                    const AccessListRules& rules) {
  Reader reader({source.data(), source.size()}, rules);
  base::LineReader lines(base::SkipByteOrderMark({text.data(), text.size()}));
  for (absl::string_view line; lines.Next(&line);) {
    line = absl::StripAsciiWhitespace(line);
    if (!line.empty() && line.front() != '#') reader.Read(lines.number(), line);
  }
  return reader.Take();
}

}  // namespace duet::server::security
