#include "skyhalo/pipeline/stage_observer.hpp"

#include <gtest/gtest.h>

namespace skyhalo {
namespace {

TEST(StageObserverTest, NamesItsStages) {
  EXPECT_EQ(name_of(Stage::kRectify), "rectify");
  EXPECT_EQ(name_of(Stage::kMatch), "match");
  EXPECT_EQ(name_of(Stage::kSphere), "sphere");
  EXPECT_EQ(name_of(Stage::kStitch), "stitch");
  EXPECT_EQ(name_of(Stage::kMap), "map");
}

TEST(StageObserverTest, StagesAreInTheOrderTheDataTakes) {
  EXPECT_LT(Stage::kRectify, Stage::kMatch);
  EXPECT_LT(Stage::kMatch, Stage::kSphere);
  EXPECT_LT(Stage::kSphere, Stage::kStitch);
  EXPECT_LT(Stage::kStitch, Stage::kMap);
}

}  // namespace
}  // namespace skyhalo
