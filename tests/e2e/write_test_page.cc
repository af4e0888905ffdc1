// Writes a viewer page of two made-up characters, for the browser tests.
//   write_test_page <file>
#include <fstream>
#include <iostream>

#include "client/viewer/page.h"
#include "model/motion/skeleton.h"
#include "tests/support/sample_motion.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_test_page <file>\n";
    return 2;
  }
  duet::client::viewer::PageContent content;
  content.pair.leader.joint_names = duet::motion::SbuSkeleton().joint_names;
  content.pair.leader.frame_rate_hz = 30;
  const duet::motion::Poses swaying = duet::test::SwayingMotion(90, 30);
  content.pair.leader.poses = swaying;
  content.pair.follower = content.pair.leader;
  for (duet::motion::Vec3& position : content.pair.follower.poses.all()) {
    position = {-position.x, position.y, 1.2f - position.z};
  }
  content.bones = duet::motion::SbuSkeleton().bones;
  content.title = "two \"people\" & a <test>";
  content.subtitle = "90 frames";
  content.glb = "glTF, in all";  // 12 bytes
  content.weights = {{0, {{"kick", 1}, {"hug", -1}}}, {60, {{"kick", -2}, {"hug", 0.5f}}}};
  content.grade = {0.0512, 0.4, 0.1, 0.004, {{12, 4}, {50, 1}, {85, 5}}};
  const absl::StatusOr<std::string> page = duet::client::viewer::RenderPage(content);
  if (!page.ok()) {
    std::cerr << page.status() << "\n";
    return 1;
  }
  std::ofstream file(argv[1], std::ios::binary);
  file << *page;
  return file.good() ? 0 : 1;
}
