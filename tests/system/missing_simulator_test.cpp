// The program built without the simulator: what it says of the commands that need one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "support/program.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::ProgramResult;

TEST(MissingSimulatorSystem, CommandsThatNeedItSaySoAndAreNotListed) {
  const testing::TempFolder root;
  for (const std::string command : {"demo", "simulate"}) {
    for (const testing::Arguments& arguments :
         {testing::Arguments{command},
          testing::Arguments{command, "--scene", "forest", "--help"}}) {
      const ProgramResult result = testing::run_program(SKYHALO_PROGRAM, arguments, root.path());
      EXPECT_EQ(result.exit_code, 2);
      EXPECT_THAT(result.out, IsEmpty());
      EXPECT_THAT(result.err, AllOf(HasSubstr(command), HasSubstr("-DSKYHALO_BUILD_SIM=ON")));
    }
  }
  EXPECT_THAT(testing::run_program(SKYHALO_PROGRAM, {"--help"}, root.path()).out,
              AllOf(HasSubstr("evaluate"), Not(HasSubstr("simulate")), Not(HasSubstr("demo"))));
}

}  // namespace
}  // namespace skyhalo
