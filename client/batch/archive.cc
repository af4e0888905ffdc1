#include "client/batch/archive.h"

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/strip.h"

namespace duet::client::batch {
namespace {

constexpr size_t kBlock = 512;
constexpr size_t kUstarName = 100;

// A ustar header: fields at fixed places, numbers in octal.
class TarHeader {
 public:
  TarHeader(absl::string_view name, uint64_t size, char type) {
    bytes_.fill('\0');
    Put(0, name.substr(0, kUstarName));
    Put(100, "0000644");
    Put(108, "0000000");
    Put(116, "0000000");
    Put(124, absl::StrFormat("%011o", size));
    Put(136, "00000000000");
    Put(148, "        ");
    bytes_[156] = type;
    Put(257, "ustar");
    Put(263, "00");
    unsigned sum = 0;
    for (const char c : bytes_) sum += static_cast<unsigned char>(c);
    Put(148, absl::StrFormat("%06o", sum));
    bytes_[154] = '\0';
  }
  absl::string_view bytes() const { return {bytes_.data(), bytes_.size()}; }

 private:
  void Put(size_t at, absl::string_view text) {
    std::memcpy(bytes_.data() + at, text.data(), text.size());
  }
  std::array<char, kBlock> bytes_;
};

// "<length of all of this> path=<name>\n"
std::string PaxPath(const std::string& name) {
  const std::string rest = absl::StrCat(" path=", name, "\n");
  size_t length = rest.size() + 1;
  while (absl::StrCat(length).size() + rest.size() != length) ++length;
  return absl::StrCat(length, rest);
}

uint64_t WholeBlocks(uint64_t bytes) { return (bytes + kBlock - 1) / kBlock * kBlock; }

class TarArchive final : public Archive {
 public:
  explicit TarArchive(DurableFile* file) : file_(file) {}

  absl::Status Add(const std::string& path, absl::string_view content) override {
    return AddMember(NameInTar(path), content);
  }
  absl::Status AddRecord(const std::string& name, absl::string_view record) override {
    return AddMember(RecordNameInTar(name), record);
  }
  absl::Status Finish() override { return file_->Append(std::string(2 * kBlock, '\0')); }

 private:
  absl::Status AddMember(const std::string& name, absl::string_view content) {
    absl::Status status;
    if (name.size() > kUstarName) status = AddBlocks("pax", 'x', PaxPath(name));
    if (status.ok()) status = AddBlocks(name, '0', content);
    return status;
  }

  absl::Status AddBlocks(absl::string_view name, char type, absl::string_view content) {
    absl::Status status = file_->Append(TarHeader(name, content.size(), type).bytes());
    if (status.ok()) status = file_->Append(content);
    const size_t beyond = content.size() % kBlock;
    if (!status.ok() || beyond == 0) return status;
    return file_->Append(std::string(kBlock - beyond, '\0'));
  }

  DurableFile* file_;
};

void AppendLittle(std::string* out, uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out->push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

uint64_t FromLittle(absl::string_view bytes, size_t at, size_t count) {
  uint64_t value = 0;
  for (size_t i = count; i > 0; --i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i - 1]);
  return value;
}

constexpr uint64_t kZipMember = 0x04034b50;
constexpr uint64_t kZipHeaderBytes = 30;  // before the name

class ZipArchive final : public Archive {
 public:
  explicit ZipArchive(DurableFile* file) : file_(file) {}

  absl::Status Add(const std::string& path, absl::string_view content) override {
    Member member{path, content.size(), Crc(content), offset_};
    std::string header;
    AppendLittle(&header, kZipMember, 4);
    AppendFields(member, &header);
    header += path;
    offset_ += header.size() + content.size();
    members_.push_back(std::move(member));
    absl::Status status = file_->Append(header);
    return status.ok() ? file_->Append(content) : status;
  }
  absl::Status AddRecord(const std::string&, absl::string_view record) override {
    absl::StrAppend(&records_, record);
    return absl::OkStatus();
  }
  absl::Status Finish() override {
    absl::Status status = Add("records.jsonl", records_);
    std::string directory;
    for (const Member& member : members_) {
      AppendLittle(&directory, 0x02014b50, 4);
      AppendLittle(&directory, kVersion, 2);
      AppendFields(member, &directory);
      directory.append(2 + 2 + 2 + 4, '\0');  // comment, disk, attributes of both kinds
      AppendLittle(&directory, member.offset, 4);
      directory += member.path;
    }
    const size_t size = directory.size();
    AppendLittle(&directory, 0x06054b50, 4);
    AppendLittle(&directory, 0, 2 + 2);  // disks
    AppendLittle(&directory, members_.size(), 2);
    AppendLittle(&directory, members_.size(), 2);
    AppendLittle(&directory, size, 4);
    AppendLittle(&directory, offset_, 4);
    AppendLittle(&directory, 0, 2);  // comment
    return status.ok() ? file_->Append(directory) : status;
  }

 private:
  static constexpr uint64_t kVersion = 20;
  static constexpr uint64_t kFirstDay = 0x21;  // 1980-01-01, the first date in zip

  struct Member {
    std::string path;
    uint64_t size = 0;
    uint64_t crc = 0;
    uint64_t offset = 0;
  };

  static uint64_t Crc(absl::string_view content) {
    return crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size());
  }

  // The fields that the header of a file and its entry in the directory share.
  static void AppendFields(const Member& member, std::string* out) {
    AppendLittle(out, kVersion, 2);
    AppendLittle(out, uint64_t{1} << 11, 2);  // names in UTF-8
    AppendLittle(out, 0, 2);                  // stored
    AppendLittle(out, 0, 2);                  // midnight
    AppendLittle(out, kFirstDay, 2);
    AppendLittle(out, member.crc, 4);
    AppendLittle(out, member.size, 4);
    AppendLittle(out, member.size, 4);
    AppendLittle(out, member.path.size(), 2);
    AppendLittle(out, 0, 2);  // extra fields
  }

  DurableFile* file_;
  uint64_t offset_ = 0;
  std::vector<Member> members_;
  std::string records_;
};

}  // namespace

ArchiveReader::ArchiveReader(const std::filesystem::path& path)
    : path_(path), file_(path, std::ios::binary) {}

absl::Status ArchiveReader::Damaged() const {
  return absl::DataLossError(absl::StrCat(path_.string(), ": is damaged"));
}

bool ArchiveReader::Read(size_t bytes, std::string* out) {
  // A member cannot be larger than its archive.
  std::error_code error;
  if (bytes > std::filesystem::file_size(path_, error) || error) return false;
  out->resize(bytes);
  return static_cast<bool>(file_.read(out->data(), static_cast<std::streamsize>(bytes)));
}

bool ArchiveReader::Skip(size_t bytes) {
  std::error_code error;
  if (bytes > std::filesystem::file_size(path_, error) || error) return false;
  return static_cast<bool>(file_.seekg(static_cast<std::streamoff>(bytes), std::ios::cur));
}

bool ArchiveReader::IsTar() const { return path_.extension() == ".tar"; }

absl::StatusOr<std::optional<ArchiveMember>> ArchiveReader::NextOf(const std::string& wanted) {
  return IsTar() ? NextOfTar(wanted) : NextOfZip(wanted);
}

absl::StatusOr<std::optional<ArchiveMember>> ArchiveReader::Next() { return NextOf(""); }

absl::StatusOr<std::optional<ArchiveMember>> ArchiveReader::Find(const std::string& path) {
  const std::string wanted = IsTar() ? NameInTar(path) : path;
  while (true) {
    absl::StatusOr<std::optional<ArchiveMember>> member = NextOf(wanted);
    if (!member.ok() || !member->has_value() || (*member)->path == wanted) return member;
  }
}

absl::StatusOr<std::optional<ArchiveMember>> ArchiveReader::NextOfTar(const std::string& wanted) {
  ArchiveMember member;
  for (std::string header, padding; Read(kBlock, &header);) {
    if (header[0] == '\0') return std::optional<ArchiveMember>();
    uint64_t size = 0;
    for (const char digit : header.substr(124, 11)) {
      size = size * 8 + static_cast<uint64_t>(digit - '0');
    }
    const size_t beyond = (kBlock - size % kBlock) % kBlock;
    const bool is_pax = header[156] == 'x';
    if (!is_pax && member.path.empty()) {
      member.path = std::string(header.substr(0, kUstarName).c_str());
    }
    if (!is_pax && !wanted.empty() && member.path != wanted) {
      if (!Skip(size + beyond)) return Damaged();
      return std::optional<ArchiveMember>(std::move(member));
    }
    if (!Read(size, &member.content) || !Read(beyond, &padding)) return Damaged();
    if (is_pax) {
      const size_t name = member.content.find('=') + 1;
      member.path = member.content.substr(name, member.content.size() - name - 1);
      continue;
    }
    return std::optional<ArchiveMember>(std::move(member));
  }
  return Damaged();
}

absl::StatusOr<std::optional<ArchiveMember>> ArchiveReader::NextOfZip(const std::string& wanted) {
  std::string header;
  if (!Read(4, &header)) return Damaged();
  if (FromLittle(header, 0, 4) != kZipMember) return std::optional<ArchiveMember>();
  if (!Read(26, &header)) return Damaged();
  ArchiveMember member;
  const uint64_t bytes = FromLittle(header, 14, 4);
  if (!Read(FromLittle(header, 22, 2), &member.path)) return Damaged();
  const bool skipped = !wanted.empty() && member.path != wanted;
  if (skipped ? !Skip(bytes) : !Read(bytes, &member.content)) return Damaged();
  return std::optional<ArchiveMember>(std::move(member));
}

std::string NameInTar(const std::string& path) {
  absl::string_view stem = path;
  return absl::ConsumeSuffix(&stem, ".json") ? absl::StrCat(stem, ".motion.json") : path;
}

std::string RecordNameInTar(const std::string& name) { return name + ".json"; }

uint64_t MemberHeaderBytes(Packing packing, const std::string& name) {
  if (packing != Packing::kTar) return kZipHeaderBytes + name.size();
  if (name.size() <= kUstarName) return kBlock;
  return 2 * kBlock + WholeBlocks(PaxPath(name).size());
}

uint64_t MemberContentBytes(Packing packing, uint64_t bytes) {
  return packing == Packing::kTar ? WholeBlocks(bytes) : bytes;
}

std::unique_ptr<Archive> MakeArchive(Packing packing, DurableFile* file) {
  if (packing == Packing::kTar) return std::make_unique<TarArchive>(file);
  return std::make_unique<ZipArchive>(file);
}

}  // namespace duet::client::batch
