#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "server/config/container_limits.h"
#include "tests/support/temporary_folder.h"

namespace duet::server::config {
namespace {

using test::TemporaryFolder;
using test::WriteTestFile;

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

// A machine's /sys and /proc as far as they matter: 4 GiB of memory.
class FakeSystem {
 public:
  FakeSystem() { Write("proc/meminfo", "MemTotal:        4194304 kB\nMemFree:         1000 kB\n"); }
  void SetMeminfo(const std::string& text) { Write("proc/meminfo", text); }
  void SetCgroup(const std::string& text) { Write("proc/self/cgroup", text); }
  void SetLimit(const std::string& file, const std::string& text) {
    Write("sys/fs/cgroup/" + file, text);
  }
  std::uint64_t Memory() const { return AvailableMemory(folder_.path()); }

 private:
  void Write(const std::string& path, const std::string& text) {
    std::filesystem::create_directories((folder_ / path).parent_path());
    WriteTestFile(folder_ / path, text);
  }
  TemporaryFolder folder_;
};

TEST(AvailableMemoryTest, IsTheMachinesWithoutCgroups) {
  EXPECT_EQ(FakeSystem().Memory(), 4096 * kMebibyte);
}

TEST(AvailableMemoryTest, IsUnlimitedIfNothingIsKnown) {
  FakeSystem system;
  for (const char* text : {"", "MemFree: 1 kB\n", "MemTotal: much\n"}) {
    system.SetMeminfo(text);
    EXPECT_EQ(system.Memory(), kUnlimitedMemory) << text;
  }
}

TEST(AvailableMemoryTest, FindsTheTotalOnAnyLine) {
  FakeSystem system;
  system.SetMeminfo("MemFree: 1 kB\nMemTotal: 2048 kB\n");
  EXPECT_EQ(system.Memory(), 2 * kMebibyte);
}

TEST(AvailableMemoryTest, ReadsTheLimitOfVersionTwo) {
  FakeSystem system;
  system.SetCgroup("0::/box\n");
  system.SetLimit("box/memory.max", "419430400\n");
  EXPECT_EQ(system.Memory(), 400 * kMebibyte);
}

TEST(AvailableMemoryTest, SoftMemoryLimitCounts) {
  FakeSystem system;
  system.SetCgroup("0::/box\n");
  system.SetLimit("box/memory.max", "419430400\n");
  system.SetLimit("box/memory.high", "209715200\n");
  EXPECT_EQ(system.Memory(), 200 * kMebibyte);
}

TEST(AvailableMemoryTest, TheTightestAncestorCounts) {
  FakeSystem system;
  system.SetCgroup("0::/kubepods/pod1/box\n");
  system.SetLimit("kubepods/memory.max", "max\n");
  system.SetLimit("kubepods/pod1/memory.max", "104857600\n");
  system.SetLimit("kubepods/pod1/box/memory.max", "419430400\n");
  EXPECT_EQ(system.Memory(), 100 * kMebibyte);
}

TEST(AvailableMemoryTest, ReadsTheLimitOfVersionOneBesideAnEmptyVersionTwo) {
  FakeSystem system;
  system.SetCgroup("5:memory:/docker/box\n4:cpu:/elsewhere\n0::/\n");
  system.SetLimit("memory/docker/box/memory.limit_in_bytes", "419430400\n");
  EXPECT_EQ(system.Memory(), 400 * kMebibyte);
}

TEST(AvailableMemoryTest, ReadsVersionOneAtTheTopInsideAContainer) {
  FakeSystem system;
  system.SetCgroup("5:memory:/a/path/outside\n");
  system.SetLimit("memory/memory.limit_in_bytes", "419430400\n");
  EXPECT_EQ(system.Memory(), 400 * kMebibyte);
}

TEST(AvailableMemoryTest, NoLimitIsTheMachines) {
  FakeSystem system;
  system.SetCgroup("5:memory:/box\n0::/box\n");
  system.SetLimit("memory/box/memory.limit_in_bytes", "9223372036854771712\n");
  for (const char* text : {"max\n", "", "0\n", "nonsense\n"}) {
    system.SetLimit("box/memory.max", text);
    EXPECT_EQ(system.Memory(), 4096 * kMebibyte) << text;
  }
}

}  // namespace
}  // namespace duet::server::config
