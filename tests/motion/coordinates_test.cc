#include "model/motion/coordinates.h"

#include <string>

#include "gtest/gtest.h"

namespace duet::motion {
namespace {

struct NamedCoordinates {
  const char* name;
  Coordinates coordinates;
};

class EveryKind : public ::testing::TestWithParam<NamedCoordinates> {};

INSTANTIATE_TEST_SUITE_P(
    Coordinates, EveryKind,
    ::testing::Values(
        NamedCoordinates{"metres_y_up", {LengthUnit::kMetres, UpAxis::kYUp}},
        NamedCoordinates{"metres_z_up", {LengthUnit::kMetres, UpAxis::kZUp}},
        NamedCoordinates{"metres_y_down", {LengthUnit::kMetres, UpAxis::kYDown}},
        NamedCoordinates{"millimetres_y_up", {LengthUnit::kMillimetres, UpAxis::kYUp}},
        NamedCoordinates{"millimetres_z_up", {LengthUnit::kMillimetres, UpAxis::kZUp}},
        NamedCoordinates{"millimetres_y_down", {LengthUnit::kMillimetres, UpAxis::kYDown}},
        NamedCoordinates{"sbu_normalised", {LengthUnit::kSbuNormalised, UpAxis::kYDown}}),
    [](const ::testing::TestParamInfo<NamedCoordinates>& coordinates) {
      return coordinates.param.name;
    });

TEST_P(EveryKind, RoundTrip) {
  for (const Vec3 world : {Vec3{0, 0, 0}, Vec3{0.3f, 1.2f, -2.5f}, Vec3{-4, 0.01f, 7}}) {
    EXPECT_LT(
        Distance(ToWorld(GetParam().coordinates, FromWorld(GetParam().coordinates, world)), world),
        2e-6f);
  }
}

TEST_P(EveryKind, KeepsHandedness) {
  const Coordinates& coordinates = GetParam().coordinates;
  const Vec3 origin = ToWorld(coordinates, {0, 0, 0});
  Vec3 x = ToWorld(coordinates, {1, 0, 0}) - origin;
  Vec3 y = ToWorld(coordinates, {0, 1, 0}) - origin;
  Vec3 z = ToWorld(coordinates, {0, 0, 1}) - origin;
  x = x / Norm(x);
  y = y / Norm(y);
  z = z / Norm(z);
  EXPECT_NEAR(Dot(Cross(x, y), z), 1, 1e-6) << "determinant";
}

// The data set's documentation, in millimetres: X = 1280 - 2560 x, Y = 960 - 1920 y,
// Z = 10000 z / 7.8125.
TEST(Coordinates, SbuFollowsItsDocumentation) {
  const Vec3 world = ToWorld({LengthUnit::kSbuNormalised, UpAxis::kYDown}, {0.25f, 0.75f, 2});
  EXPECT_NEAR(world.x, (1280 - 2560 * 0.25) / 1000, 1e-6);
  EXPECT_NEAR(world.y, (960 - 1920 * 0.75) / 1000, 1e-6);
  EXPECT_NEAR(world.z, 10000 * 2 / 7.8125 / 1000, 1e-6);
}

TEST(Coordinates, AreStatedByUnitOrAxis) {
  EXPECT_FALSE(StatedCoordinates({}, {}).has_value());
  const auto axis = StatedCoordinates({}, UpAxis::kZUp);
  EXPECT_EQ(axis->unit, LengthUnit::kMetres);
  EXPECT_EQ(axis->up_axis, UpAxis::kZUp);
  EXPECT_EQ(StatedCoordinates(LengthUnit::kMillimetres, {})->up_axis, UpAxis::kYUp);
  EXPECT_EQ(StatedCoordinates(LengthUnit::kSbuNormalised, {})->up_axis, UpAxis::kYDown);
  EXPECT_EQ(StatedCoordinates(LengthUnit::kSbuNormalised, UpAxis::kYUp)->up_axis, UpAxis::kYUp);
}

TEST(Coordinates, HaveOneSpellingThatReadsBack) {
  for (const LengthUnit unit :
       {LengthUnit::kMetres, LengthUnit::kMillimetres, LengthUnit::kSbuNormalised}) {
    EXPECT_EQ(ParseLengthUnit(LengthUnitName(unit)), unit) << LengthUnitName(unit);
  }
  for (const UpAxis axis : {UpAxis::kYUp, UpAxis::kZUp, UpAxis::kYDown}) {
    EXPECT_EQ(ParseUpAxis(UpAxisName(axis)), axis) << UpAxisName(axis);
  }
  EXPECT_EQ(LengthUnitName(LengthUnit::kMetres), "metres");
  EXPECT_EQ(LengthUnitName(LengthUnit::kMillimetres), "millimetres");
  EXPECT_EQ(LengthUnitName(LengthUnit::kSbuNormalised), "sbu-normalised");
  EXPECT_EQ(UpAxisName(UpAxis::kYUp), "y-up");
  EXPECT_EQ(UpAxisName(UpAxis::kZUp), "z-up");
  EXPECT_EQ(UpAxisName(UpAxis::kYDown), "y-down");
}

TEST(Coordinates, RejectUnknownNames) {
  for (const char* name : {"", "feet", "Metres", "metre", "m", "sbu_normalised", "y-up"}) {
    EXPECT_EQ(ParseLengthUnit(name), std::nullopt) << name;
  }
  for (const char* name : {"", "x", "Y-up", "y-u", "metres"}) {
    EXPECT_EQ(ParseUpAxis(name), std::nullopt) << name;
  }
}

}  // namespace
}  // namespace duet::motion
