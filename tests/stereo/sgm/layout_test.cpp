#include "skyhalo/stereo/sgm/layout.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <utility>

namespace skyhalo {
namespace {

using sgm::SkewLayout;

/// The step at which a pixel stands in its lane.
int step_of(const SkewLayout& layout, int u, int v) {
  return v / layout.lanes * layout.period + u + 2 * (v % layout.lanes);
}

TEST(LayoutTest, CountsStripsAndSteps) {
  const SkewLayout layout(100, 33, 64, 16);
  EXPECT_EQ(layout.period, 101);
  EXPECT_EQ(layout.strips, 3);
  EXPECT_EQ(layout.steps, 336);  // 3 * 101 + 2 * 16, up to a multiple of 16
  EXPECT_EQ(SkewLayout(100, 32, 64, 16).strips, 2);
  EXPECT_EQ(SkewLayout(20, 1, 16, 64).period, 132);
}

TEST(LayoutTest, TheRowsOfALaneFollowEachOther) {
  const SkewLayout layout(100, 33, 64, 16);
  EXPECT_EQ(layout.row_offset(0), layout.lead());
  EXPECT_EQ(layout.row_offset(3), 3 * layout.lane_stride() + layout.lead());
  EXPECT_EQ(layout.row_offset(16) - layout.row_offset(0), 101);
  EXPECT_EQ(layout.row_offset(32) - layout.row_offset(16), 101);
}

TEST(LayoutProperty, PredecessorsOfAllPathsBelongToEarlierSteps) {
  constexpr std::array<std::pair<int, int>, 4> kBackwards{{{-1, 0}, {0, -1}, {-1, -1}, {1, -1}}};
  for (const int lanes : {1, 16, 64}) {
    for (const int width : {17, 100, 131, 132, 133}) {
      const SkewLayout layout(width, 3 * lanes + 1, 16, lanes);
      for (int v = 0; v < layout.height_px; ++v) {
        for (int u = 0; u < width; ++u) {
          for (const auto& [du, dv] : kBackwards) {
            if (u + du >= 0 && u + du < width && v + dv >= 0) {
              ASSERT_LT(step_of(layout, u + du, v + dv), step_of(layout, u, v)) << u << ", " << v;
            }
          }
        }
      }
    }
  }
}

TEST(LayoutProperty, EachPixelHasAPlaceOfItsOwn) {
  for (const int lanes : {1, 16, 64}) {
    const SkewLayout layout(50, 130, 16, lanes);
    std::set<std::pair<int, int>> places;
    for (int v = 0; v < 130; ++v) {
      for (int u = 0; u < 50; ++u) {
        ASSERT_TRUE(places.emplace(step_of(layout, u, v), v % lanes).second) << u << ", " << v;
        ASSERT_LT(step_of(layout, u, v), layout.steps);
      }
    }
    EXPECT_EQ(layout.steps % 16, 0);
  }
}

}  // namespace
}  // namespace skyhalo
