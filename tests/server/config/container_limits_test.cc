#include "server/config/container_limits.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/support/temporary_folder.h"

namespace duet::server::config {
namespace {

using test::TemporaryFolder;
using test::WriteTestFile;

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

// The processors that a thread may run on; gives them back at the end of the scope.
class Affinity {
 public:
  Affinity() { sched_getaffinity(0, sizeof(original_), &original_); }
  ~Affinity() { sched_setaffinity(0, sizeof(original_), &original_); }
  int count() const { return CPU_COUNT(&original_); }

  // Keeps the thread on the first of them.
  void Narrow() {
    int first = 0;
    while (CPU_ISSET(first, &original_) == 0) ++first;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
  }

 private:
  cpu_set_t original_ = {};
};

int Machine() { return Affinity().count(); }

// A machine's /sys and /proc as far as they matter: 4 GiB of memory.
class FakeSystem {
 public:
  FakeSystem() { Write("proc/meminfo", "MemTotal:        4194304 kB\nMemFree:         1000 kB\n"); }
  void SetCgroup(const std::string& path) {
    Write("proc/self/cgroup", "5:memory:/elsewhere\n0::" + path + "\n");
  }
  void SetLimit(const std::string& file, const std::string& text) {
    Write("sys/fs/cgroup/" + file, text);
  }
  void Write(const std::string& path, const std::string& text) {
    std::filesystem::create_directories((folder_ / path).parent_path());
    WriteTestFile(folder_ / path, text);
  }
  int Cores() const { return AvailableCores(folder_.path()); }
  std::uint64_t Memory() const { return AvailableMemory(folder_.path()); }

 private:
  TemporaryFolder folder_;
};

TEST(ContainerLimitsTest, AreTheMachinesWithoutCgroups) {
  FakeSystem system;
  EXPECT_EQ(system.Cores(), Machine());
  EXPECT_EQ(system.Memory(), 4096 * kMebibyte);
  for (const char* text : {"", "MemFree: 1 kB\n", "MemTotal: much\n"}) {
    system.Write("proc/meminfo", text);
    EXPECT_EQ(system.Memory(), kUnlimitedMemory) << text;
  }
}

TEST(ContainerLimitsTest, CoresAreAtLeastOneAndAtMostTheMachine) {
  FakeSystem system;
  system.SetCgroup("/");
  system.SetLimit("cpu.max", "20000 100000\n");
  EXPECT_EQ(system.Cores(), 1);
  for (const char* no_limit :
       {"99900000 100000\n", "max 100000\n", "", "100000", "nonsense", "-1 100000", "100000 0"}) {
    system.SetLimit("cpu.max", no_limit);
    EXPECT_EQ(system.Cores(), Machine()) << no_limit;
  }
}

TEST(ContainerLimitsTest, TheTightestAncestorCounts) {
  FakeSystem system;
  system.SetCgroup("/kubepods/pod1/box");
  system.SetLimit("kubepods/cpu.max", "max 100000\n");
  system.SetLimit("kubepods/pod1/cpu.max", "100000 100000\n");
  system.SetLimit("kubepods/pod1/box/cpu.max", "9900000 100000\n");
  EXPECT_EQ(system.Cores(), 1);
  system.SetLimit("kubepods/memory.max", "max\n");
  system.SetLimit("kubepods/pod1/memory.max", "104857600\n");
  system.SetLimit("kubepods/pod1/box/memory.max", "419430400\n");
  EXPECT_EQ(system.Memory(), 100 * kMebibyte);
}

TEST(ContainerLimitsTest, SoftMemoryLimitCounts) {
  FakeSystem system;
  system.SetCgroup("/box");
  system.SetLimit("box/memory.max", "419430400\n");
  EXPECT_EQ(system.Memory(), 400 * kMebibyte);
  system.SetLimit("box/memory.high", "209715200\n");
  EXPECT_EQ(system.Memory(), 200 * kMebibyte);
  system.SetLimit("box/memory.high", "max\n");
  for (const char* text : {"max\n", "", "0\n", "nonsense\n"}) {
    system.SetLimit("box/memory.max", text);
    EXPECT_EQ(system.Memory(), 4096 * kMebibyte) << text;
  }
}

TEST(ContainerLimitsTest, TopCountsInsideAContainer) {
  FakeSystem system;
  system.SetCgroup("/a/path/outside");
  system.SetLimit("memory.max", "419430400\n");
  EXPECT_EQ(system.Memory(), 400 * kMebibyte);
  system.SetLimit("cpu.max", "100000 100000\n");
  EXPECT_EQ(system.Cores(), 1);
}

TEST(ContainerLimitsTest, CountsTheProcessorsThatTheThreadMayRunOn) {
  Affinity affinity;
  affinity.Narrow();
  EXPECT_EQ(FakeSystem().Cores(), 1);
}

}  // namespace
}  // namespace duet::server::config
