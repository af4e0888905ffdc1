#include <gtest/gtest.h>
#include <sched.h>

#include <filesystem>
#include <string>

#include "server/config/container_limits.h"
#include "tests/support/temporary_folder.h"

namespace duet::server::config {
namespace {

using test::TemporaryFolder;
using test::WriteTestFile;

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

// A machine's /sys and /proc as far as they matter.
class FakeSystem {
 public:
  void SetCgroup(const std::string& path) { Write("proc/self/cgroup", "0::" + path + "\n"); }
  // Version 1: the cgroup of the controllers, "cpu,cpuacct" for example.
  void SetOldCgroup(const std::string& controllers, const std::string& path) {
    Write("proc/self/cgroup",
          "12:cpuset:/elsewhere\n4:" + controllers + ":" + path + "\n0::/init.scope\n");
  }
  void SetQuota(const std::string& cgroup, const std::string& quota, const std::string& period) {
    Write("sys/fs/cgroup/cpu" + cgroup + "/cpu.cfs_quota_us", quota);
    Write("sys/fs/cgroup/cpu" + cgroup + "/cpu.cfs_period_us", period);
  }
  void SetCpuMax(const std::string& cgroup, const std::string& text) {
    Write("sys/fs/cgroup" + cgroup + "/cpu.max", text);
  }
  int Cores() const { return AvailableCores(folder_.path()); }

 private:
  void Write(const std::string& path, const std::string& text) {
    std::filesystem::create_directories((folder_ / path).parent_path());
    WriteTestFile(folder_ / path, text);
  }
  TemporaryFolder folder_;
};

TEST(ParseCpuMaxTest, ReadsQuotaAndPeriod) {
  EXPECT_EQ(ParseCpuMax("400000 100000\n"), 4.0);
  EXPECT_EQ(ParseCpuMax("50000 100000"), 0.5);
}

TEST(ParseCpuMaxTest, KnowsNoLimit) {
  for (const char* text : {"max 100000", "", "100000", "nonsense", "-1 100000", "100000 0"}) {
    EXPECT_EQ(ParseCpuMax(text), std::nullopt) << text;
  }
}

TEST(AvailableCoresTest, IsTheMachineWithoutCgroups) { EXPECT_EQ(FakeSystem().Cores(), Machine()); }

TEST(AvailableCoresTest, IsAtLeastOne) {
  FakeSystem system;
  system.SetCgroup("/");
  system.SetCpuMax("", "20000 100000\n");
  EXPECT_EQ(system.Cores(), 1);
}

TEST(AvailableCoresTest, IsAtMostTheMachine) {
  FakeSystem system;
  system.SetCgroup("/");
  system.SetCpuMax("", "99900000 100000\n");
  EXPECT_EQ(system.Cores(), Machine());
}

TEST(AvailableCoresTest, TheTightestAncestorCounts) {
  FakeSystem system;
  system.SetCgroup("/kubepods/pod1/box");
  system.SetCpuMax("/kubepods", "max 100000\n");
  system.SetCpuMax("/kubepods/pod1", "100000 100000\n");
  system.SetCpuMax("/kubepods/pod1/box", "9900000 100000\n");
  EXPECT_EQ(system.Cores(), 1);
}

TEST(AvailableCoresTest, ReadsTheQuotaOfVersionOne) {
  for (const char* controllers : {"cpu", "cpu,cpuacct", "cpuacct,cpu"}) {
    FakeSystem system;
    system.SetOldCgroup(controllers, "/docker/box");
    system.SetQuota("/docker/box", "150000\n", "100000\n");
    EXPECT_EQ(system.Cores(), 1) << controllers;
  }
}

TEST(AvailableCoresTest, TheTightestAncestorCountsInVersionOne) {
  FakeSystem system;
  system.SetOldCgroup("cpu,cpuacct", "/docker/box");
  system.SetQuota("/docker", "100000\n", "100000\n");
  system.SetQuota("/docker/box", "9900000\n", "100000\n");
  EXPECT_EQ(system.Cores(), 1);
}

TEST(AvailableCoresTest, ReadsVersionOneAtTheTopInsideAContainer) {
  FakeSystem system;
  system.SetOldCgroup("cpu", "/a/path/outside");
  system.SetQuota("", "100000\n", "100000\n");
  EXPECT_EQ(system.Cores(), 1);
}

TEST(AvailableCoresTest, QuotaOfMinusOneMeansNoQuota) {
  FakeSystem system;
  system.SetOldCgroup("cpu", "/box");
  system.SetQuota("/box", "-1\n", "100000\n");
  EXPECT_EQ(system.Cores(), Machine());
}

TEST(AvailableCoresTest, CpuControllerIsMatchedByItsWholeName) {
  FakeSystem system;
  system.SetOldCgroup("cpuacct", "/box");
  system.SetQuota("/box", "100000\n", "100000\n");
  EXPECT_EQ(system.Cores(), Machine());
}

TEST(AvailableCoresTest, CountsTheProcessorsThatTheThreadMayRunOn) {
  Affinity affinity;
  affinity.Narrow();
  EXPECT_EQ(FakeSystem().Cores(), 1);
}

}  // namespace
}  // namespace duet::server::config
