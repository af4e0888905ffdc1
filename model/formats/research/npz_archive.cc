#include "model/formats/research/npz_archive.h"

#include <zlib.h>

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "model/base/text.h"
#include "model/motion/motion_limits.h"

namespace duet::formats::research {
namespace {

constexpr std::uint32_t kLocalHeader = 0x04034b50, kDirectoryEntry = 0x02014b50,
                        kDirectoryEnd = 0x06054b50;
constexpr std::size_t kLocalHeaderBytes = 30, kEntryBytes = 46, kEndBytes = 22;
constexpr std::size_t kLongestComment = 0xffff;
constexpr std::uint32_t kStored = 0, kDeflated = 8;
// More members than any body model has.
constexpr std::size_t kMostMembers = 4096;
constexpr std::size_t kMostNames = 24;  // in a message
// Deflate cannot compress further, so a member that states more is damaged.
constexpr std::uint64_t kLargestRatio = 1032;

std::uint32_t Number(absl::string_view bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = count; i > 0; --i) {
    value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i) - 1]);
  }
  return value;
}

// The place of the directory's end, which a comment may follow; npos if there is none.
std::size_t FindDirectoryEnd(absl::string_view bytes) {
  if (bytes.size() < kEndBytes) return absl::string_view::npos;
  const std::size_t last = bytes.size() - kEndBytes;
  const std::size_t first = last > kLongestComment ? last - kLongestComment : 0;
  for (std::size_t at = last + 1; at > first; --at) {
    if (Number(bytes, at - 1, 4) == kDirectoryEnd) return at - 1;
  }
  return absl::string_view::npos;
}

// False unless `packed` decompresses to exactly the bytes of `out`.
bool Inflate(absl::string_view packed, std::string* out) {
  z_stream stream = {};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return false;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(out->data());
  stream.avail_out = static_cast<uInt>(out->size());
  const int result = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  return result == Z_STREAM_END && stream.avail_out == 0 && stream.avail_in == 0;
}

}  // namespace

absl::Status NpzArchive::Error(absl::string_view message) const {
  return absl::InvalidArgumentError(absl::StrCat(source_, ": ", message));
}

absl::StatusOr<NpzArchive> NpzArchive::Parse(absl::string_view bytes, absl::string_view source) {
  NpzArchive archive;
  archive.source_ = std::string(source);
  archive.bytes_ = bytes;
  const std::size_t end = FindDirectoryEnd(bytes);
  if (end == absl::string_view::npos) {
    return archive.Error("expected an .npz archive (zip), got a file without its directory");
  }
  const std::size_t count = Number(bytes, end + 10, 2);
  std::size_t at = Number(bytes, end + 16, 4);
  if (count > kMostMembers) {
    return archive.Error(absl::StrCat("expected at most ", kMostMembers, " arrays, got ", count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (at > end || end - at < kEntryBytes || Number(bytes, at, 4) != kDirectoryEntry) {
      return archive.Error(absl::StrCat("directory: expected ", count, " entries, got ", i));
    }
    const std::size_t name_bytes = Number(bytes, at + 28, 2);
    const std::size_t all =
        kEntryBytes + name_bytes + Number(bytes, at + 30, 2) + Number(bytes, at + 32, 2);
    if (end - at < all) {
      return archive.Error(absl::StrCat("directory: expected ", count, " entries, got ", i));
    }
    absl::string_view name = bytes.substr(at + kEntryBytes, name_bytes);
    absl::ConsumeSuffix(&name, ".npy");
    archive.members_.emplace(
        std::string(name),
        Member{Number(bytes, at + 10, 2), Number(bytes, at + 16, 4), Number(bytes, at + 20, 4),
               Number(bytes, at + 24, 4), Number(bytes, at + 42, 4)});
    at += all;
  }
  return archive;
}

std::vector<std::string> NpzArchive::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, member] : members_) names.push_back(name);
  return names;
}

absl::StatusOr<absl::string_view> NpzArchive::Packed(const std::string& name,
                                                     const Member& member) const {
  const auto damaged = [this, &name] {
    return Error(absl::StrCat(name, ": expected an array in the archive, got damaged data"));
  };
  if (member.at > bytes_.size() || bytes_.size() - member.at < kLocalHeaderBytes ||
      Number(bytes_, member.at, 4) != kLocalHeader) {
    return damaged();
  }
  // The local header repeats the name, and may have other extra fields than the directory.
  const std::size_t begin = member.at + kLocalHeaderBytes + Number(bytes_, member.at + 26, 2) +
                            Number(bytes_, member.at + 28, 2);
  if (begin > bytes_.size() || bytes_.size() - begin < member.packed_bytes) return damaged();
  return bytes_.substr(begin, member.packed_bytes);
}

absl::StatusOr<std::string> NpzArchive::Read(absl::string_view name) const {
  const auto found = members_.find(std::string(name));
  if (found == members_.end()) {
    std::vector<std::string> names = Names();
    const bool more = names.size() > kMostNames;
    names.resize(std::min(names.size(), kMostNames));
    for (std::string& one : names) one = base::Quoted(one);
    return Error(absl::StrCat("expected an array ", name, ", got ", absl::StrJoin(names, ", "),
                              more ? ", ..." : ""));
  }
  const Member& member = found->second;
  const absl::StatusOr<absl::string_view> packed = Packed(found->first, member);
  if (!packed.ok()) return packed.status();
  if (member.method != kStored && member.method != kDeflated) {
    return Error(
        absl::StrCat(name, ": expected a stored or deflated array, got method ", member.method));
  }
  if (member.bytes > motion::kMaxMotionFileBytes) {
    return Error(absl::StrCat(name, ": expected at most ", motion::kMaxMotionFileBytes >> 20,
                              " MiB, got ", member.bytes, " bytes"));
  }
  std::string content;
  bool whole = false;
  if (member.method == kStored) {
    content = std::string(*packed);
    whole = member.bytes == content.size();
  } else if (member.bytes <= kLargestRatio * packed->size()) {
    content.resize(member.bytes);
    whole = Inflate(*packed, &content);
  }
  const auto crc =
      crc32_z(crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(content.data()), content.size());
  if (!whole || crc != member.crc) {
    return Error(absl::StrCat(name, ": expected an array in the archive, got damaged data"));
  }
  return content;
}

}  // namespace duet::formats::research
