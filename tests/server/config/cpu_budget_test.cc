#include "server/config/cpu_budget.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <thread>

#include "tests/support/temporary_folder.h"

namespace duet::server::config {
namespace {

using test::TemporaryFolder;
using test::WriteTestFile;

int Machine() { return static_cast<int>(std::thread::hardware_concurrency()); }

// A machine's /sys and /proc as far as they matter.
class FakeSystem {
 public:
  void SetCgroup(const std::string& path) { Write("proc/self/cgroup", "0::" + path + "\n"); }
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

}  // namespace
}  // namespace duet::server::config
