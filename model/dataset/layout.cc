#include "model/dataset/layout.h"

#include "model/motion/sbu.h"

namespace duet::dataset {
namespace {

constexpr double kK3hiFrameRateHz = 30;

struct ClassRow {
  const char* name;
  const char* folder;
  bool symmetric;
  bool handed;
  bool touches;
};

// Both data sets share skeleton and units.
DatasetLayout KinectLayout(const std::string& name, double frame_rate_hz,
                           const std::vector<ClassRow>& rows) {
  DatasetLayout layout;
  layout.name = name;
  layout.frame_rate_hz = frame_rate_hz;
  layout.coordinates = {motion::LengthUnit::kSbuNormalised, motion::UpAxis::kYDown};
  layout.skeleton = motion::SbuSkeleton();
  layout.parts = motion::SbuParts();
  layout.people_axis = motion::Vec3{1, 0, 0};  // the image's x axis
  layout.level = true;
  const std::vector<int> feet = {layout.skeleton.feet->left, layout.skeleton.feet->right};
  const std::vector<int> hands = {layout.skeleton.Find("left_hand"),
                                  layout.skeleton.Find("right_hand")};
  for (const ClassRow& row : rows) {
    const bool kick = std::string_view(row.name) == "kick";
    layout.classes.push_back(
        {row.name, row.folder, row.symmetric, row.handed, row.touches, kick ? feet : hands});
  }
  return layout;
}

}  // namespace

DatasetLayout SbuLayout() {
  return KinectLayout("sbu", motion::kSbuFrameRateHz,
                      {{"kick", "03", false, false, false},
                       {"push", "04", false, false, false},
                       {"shake_hands", "05", true, true, false},
                       {"hug", "06", true, false, true},
                       {"exchange_object", "07", true, true, false},
                       {"punch", "08", false, false, false}});
}

bool IsSbuSet(std::string_view name) {
  const auto digit = [&](size_t i) { return name[i] >= '0' && name[i] <= '9'; };
  return name.size() == 6 && name[0] == 's' && name[3] == 's' && digit(1) && digit(2) && digit(4) &&
         digit(5);
}

DatasetLayout K3hiLayout() {
  return KinectLayout("k3hi", kK3hiFrameRateHz,
                      {{"approach", "approaching", false, false, false},
                       {"depart", "departing", false, false, false},
                       {"exchange_object", "exchanging", true, true, false},
                       {"kick", "kicking", false, false, false},
                       {"point", "pointing", false, true, false},
                       {"punch", "punching", false, false, false},
                       {"push", "pushing", false, false, false},
                       {"shake_hands", "shaking", true, true, false}});
}

}  // namespace duet::dataset
