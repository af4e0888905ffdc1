#include "client/batch/contact_sheet.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/batch/pose_strip.h"
#include "client/batch/stored_pair.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "model/base/sha256.h"
#include "model/formats/flat/sbu_text.h"
#include "model/formats/motion_file.h"
#include "tests/support/matchers.h"
#include "tests/support/sample_motion.h"
#include "tests/support/temporary_folder.h"

namespace duet::client::batch {
namespace {

// People who sway, the follower `apart` from the leader.
motion::ClipPair Pair(motion::Vec3 apart, int frames = 9) {
  motion::ClipPair pair;
  pair.leader.joint_names = motion::SbuSkeleton().joint_names;
  pair.leader.frame_rate_hz = 15;
  pair.leader.poses = test::SwayingMotion(frames, 15);
  pair.follower = pair.leader;
  for (motion::Vec3& point : pair.follower.poses.all()) point += apart;
  return pair;
}

// Where the lines of a person's path begin, x and y in turn.
std::vector<int> Points(const std::string& svg, const std::string& person) {
  const size_t begin = svg.find("class=\"" + person + "\"");
  const std::string d = svg.substr(begin, svg.find("/>", begin) - begin);
  std::vector<int> points;
  const std::regex point("[ML](-?[0-9]+) (-?[0-9]+)");
  for (std::sregex_iterator it(d.begin(), d.end(), point), end; it != end; ++it) {
    points.push_back(std::stoi((*it)[1]));
    points.push_back(std::stoi((*it)[2]));
  }
  return points;
}

TEST(PoseStrip, LeaderIsAlwaysOnTheLeft) {
  for (const motion::Vec3 apart : {motion::Vec3{1, 0, 0}, {-1, 0, 0}, {0, 0, 2}, {1, 0.5f, -1}}) {
    const std::string svg = PoseStrip(Pair(apart), motion::SbuSkeleton());
    const std::vector<int> leader = Points(svg, "leader"), follower = Points(svg, "follower");
    ASSERT_EQ(leader.size(), follower.size());
    // Six moments of 14 bones and a head.
    EXPECT_EQ(leader.size(), 2u * 6 * (2 * 14 + 1));
    for (size_t i = 0; i < leader.size(); i += 2) EXPECT_LT(leader[i], follower[i]);
  }
}

TEST(PoseStrip, HigherPersonIsDrawnHigher) {
  const std::string svg = PoseStrip(Pair({1, 4, 0}), motion::SbuSkeleton());
  const std::vector<int> leader = Points(svg, "leader"), follower = Points(svg, "follower");
  for (size_t i = 0; i < leader.size(); i += 2) {
    EXPECT_NEAR(leader[i + 1] - follower[i + 1], 4 * (follower[i] - leader[i]), 5);
  }
}

TEST(PoseStrip, EveryMomentStaysInItsPlace) {
  for (const float apart : {0.f, 0.3f, 30.f}) {
    const std::string svg = PoseStrip(Pair({apart, 0, 0}), motion::SbuSkeleton());
    for (const char* person : {"leader", "follower"}) {
      const std::vector<int> points = Points(svg, person);
      for (size_t i = 0; i < points.size(); i += 2) {
        const int place = static_cast<int>(i / (points.size() / 6)) * 1000;
        EXPECT_GE(points[i], place);
        EXPECT_LE(points[i], place + 1000);
        EXPECT_GE(points[i + 1], 0);
        EXPECT_LE(points[i + 1], 950);
      }
    }
  }
}

TEST(PoseStrip, AShortClipHasFewerMoments) {
  const std::string svg = PoseStrip(Pair({1, 0, 0}, 2), motion::SbuSkeleton());
  EXPECT_EQ(Points(svg, "leader").size(), 2u * 2 * (2 * 14 + 1));
  EXPECT_EQ(Points(PoseStrip(Pair({1, 0, 0}, 1), motion::SbuSkeleton()), "leader").size(),
            2u * (2 * 14 + 1));
}

class ContactSheetTest : public ::testing::Test {
 protected:
  ContactSheetTest() {
    ModelChoice model;
    model.name = "sbu";
    model.version = 2;
    identity_.models = {model};
    identity_.skeletons = {motion::SbuSkeleton()};
  }

  nlohmann::ordered_json Record(int item, const nlohmann::ordered_json& labels) {
    const std::string path = absl::StrCat("pair", item, ".csv");
    return {{"id", absl::StrFormat("%032x", (item * 7919) % 1000)},
            {"state", "done"},
            {"name", absl::StrCat("pair", item)},
            {"side", "left"},
            {"labels", labels},
            {"model", "sbu@2"},
            {"frames", 9},
            {"frame_rate_hz", 15},
            {"quality", {{"distance_metres", 1.25}, {"lean_degrees", 7.6}}},
            {"files", {{{"path", path}, {"bytes", 1}, {"sha256", ""}}}}};
  }

  // Files as they are.
  void Sign(nlohmann::ordered_json* record) {
    for (nlohmann::ordered_json& file : (*record)["files"]) {
      const std::string content = test::ReadTestFile(folder_ / file["path"].get<std::string>());
      file["bytes"] = content.size();
      file["sha256"] = base::Sha256Hex(content);
    }
  }

  void Add(nlohmann::ordered_json record) {
    EXPECT_THAT(formats::WritePair(folder_ / record["files"][0]["path"].get<std::string>(),
                                   Pair({1, 0, 0}), motion::SbuSkeleton()),
                IsOk());
    Sign(&record);
    records_.push_back(record.dump());
  }

  absl::Status Write() {
    JournalWriter writer;
    EXPECT_THAT(writer.Open(folder_ / "journal", 0), IsOk());
    for (size_t i = 0; i < records_.size(); ++i) writer.Add(static_cast<int>(i), records_[i]);
    EXPECT_THAT(writer.Commit(), IsOk());
    const absl::StatusOr<JournalReader> journal = JournalReader::Open(folder_ / "journal");
    return WriteContactSheet(*journal, identity_, ItemReader(folder_.path(), ""), folder_.path());
  }

  std::string Sheet() {
    EXPECT_THAT(Write(), IsOk());
    return test::ReadTestFile(folder_ / "contact_sheet.html");
  }

  static int Count(const std::string& text, const std::string& part) {
    int count = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
      ++count;
    }
    return count;
  }

  test::TemporaryFolder folder_;
  JobIdentity identity_;
  std::vector<std::string> records_;
};

TEST_F(ContactSheetTest, ShowsSomeOfEachClass) {
  for (int i = 0; i < 30; ++i) Add(Record(i, {{"hug", 0.3}, {"kick", 0.5}}));
  Add(Record(30, {{"hug", 1}, {"kick", 0.9}}));
  const std::string sheet = Sheet();
  EXPECT_THAT(sheet, HasSubstr("<h2>kick <small>12 of 30</small></h2>"));
  EXPECT_THAT(sheet, HasSubstr("<h2>hug <small>1 of 1</small></h2>"));
  EXPECT_EQ(Count(sheet, "<svg"), 13);
  EXPECT_THAT(sheet, HasSubstr("31 followers by sbu@2"));
  EXPECT_THAT(sheet, HasSubstr("<a href=\"pair30.csv\">pair30</a>"));
  EXPECT_THAT(sheet, HasSubstr("hug 0.3, kick 0.5"));
  EXPECT_THAT(sheet, HasSubstr("0.6 s \u00b7 1.25 m apart \u00b7 leans 8\u00b0"));
}

TEST_F(ContactSheetTest, IsIndependentOfTheOrderOfItems) {
  for (int i = 0; i < 30; ++i) Add(Record(i, {{"kick", 1}}));
  const std::string sheet = Sheet();
  std::reverse(records_.begin(), records_.end());
  EXPECT_EQ(Sheet(), sheet);
}

TEST_F(ContactSheetTest, ShowsOnlyDoneItems) {
  nlohmann::ordered_json rejected = Record(0, {{"kick", 1}});
  rejected["state"] = "rejected";
  rejected["reasons"] = {"lean_degrees: expected at most 20, got 40"};
  rejected.erase("files");
  records_.push_back(rejected.dump());
  records_.push_back(R"({"state":"failed","name":"pair1"})");
  EXPECT_EQ(Count(Sheet(), "<figure>"), 0);
}

TEST_F(ContactSheetTest, ADamagedRecordIsNamed) {
  nlohmann::ordered_json record = Record(0, {{"kick", 1}});
  record["id"] = 7;
  records_.push_back(record.dump());
  EXPECT_THAT(Write(), StatusIs(absl::StatusCode::kDataLoss, HasSubstr("id: ")));
}

TEST_F(ContactSheetTest, UnreadableItemShowsItsError) {
  Add(Record(0, {{"kick", 1}}));
  Add(Record(1, {{"kick", 1}}));
  std::filesystem::remove(folder_ / "pair0.csv");
  const std::string sheet = Sheet();
  EXPECT_EQ(Count(sheet, "<svg"), 1);
  EXPECT_THAT(sheet, HasSubstr("pair0.csv: no such file"));
}

TEST_F(ContactSheetTest, NamesAreEscaped) {
  nlohmann::ordered_json record = Record(0, {{"<kick>", 1}});
  record["name"] = "a<b>&\"c";
  Add(record);
  const std::string sheet = Sheet();
  EXPECT_THAT(sheet, HasSubstr("&lt;kick&gt;"));
  EXPECT_THAT(sheet, HasSubstr("a&lt;b&gt;&amp;&quot;c"));
  EXPECT_THAT(sheet, Not(HasSubstr("<kick>")));
}

TEST_F(ContactSheetTest, PackedSetHasNoLinks) {
  identity_.packing = Packing::kTar;
  Add(Record(0, {{"kick", 1}}));
  EXPECT_THAT(Sheet(), Not(HasSubstr("<a ")));
}

TEST_F(ContactSheetTest, EveryFormatIsReadBack) {
  int item = 0;
  for (const char* ending : {".npy", ".json", ".csv", ".bvh"}) {
    nlohmann::ordered_json record = Record(item++, {{"kick", 1}});
    const std::string name = record["name"];
    record["files"][0]["path"] = name + ending;
    if (std::string(ending) == ".bvh") {
      record["files"] = {{{"path", name + ".leader.bvh"}}, {{"path", name + ".follower.bvh"}}};
    }
    EXPECT_THAT(
        formats::WritePair(folder_ / (name + ending), Pair({1, 0, 0}), motion::SbuSkeleton()),
        IsOk());
    Sign(&record);
    records_.push_back(record.dump());
  }
  const std::string sheet = Sheet();
  EXPECT_EQ(Count(sheet, "<svg"), 4) << sheet;
  // The three that hold positions show the same.
  const std::string svg = PoseStrip(Pair({1, 0, 0}), motion::SbuSkeleton());
  EXPECT_EQ(Count(sheet, svg), 3);
}

TEST_F(ContactSheetTest, ALeaderOnTheRightOfACaptureLeads) {
  const motion::ClipPair pair = Pair({1, 0, 0});
  const auto text = formats::flat::FormatSbu({pair.follower, pair.leader});
  ASSERT_THAT(text, IsOk());
  test::WriteTestFile(folder_ / "clip.txt", *text);
  nlohmann::ordered_json record = Record(0, {{"kick", 1}});
  record["files"][0]["path"] = "clip.txt";
  record["side"] = "right";
  Sign(&record);
  const ItemReader items(folder_.path(), "");
  const auto read = ReadStoredPair([&](size_t file) { return items.Read(record, {}, file); },
                                   record, motion::SbuSkeleton());
  ASSERT_THAT(read, IsOk());
  EXPECT_LT(Distance(read->leader.at(2, 3), pair.leader.at(2, 3)), 1e-4f);
  EXPECT_LT(Distance(read->follower.at(2, 3), pair.follower.at(2, 3)), 1e-4f);
}

}  // namespace
}  // namespace duet::client::batch
