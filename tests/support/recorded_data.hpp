#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace skyhalo::testing {

/// The folder of recorded data: `SKYHALO_DATA`, or `../shared/data` from the project's root.
inline std::filesystem::path recorded_data() {
  const char* const chosen = std::getenv("SKYHALO_DATA");
  return chosen != nullptr ? std::filesystem::path(chosen)
                           : std::filesystem::path(SKYHALO_SOURCE_DIR) / "../shared/data";
}

/// The KITTI drive that the tests use (frames 0 to 71 of tracking sequence 0003).
inline std::filesystem::path recorded_drive() {
  return recorded_data() / "kitti_raw/2011_09_26/2011_09_26_drive_0013_sync";
}

inline std::filesystem::path recorded_labels() {
  return recorded_data() / "kitti_tracking_0003/label_02_0003.txt";
}

}  // namespace skyhalo::testing

/// Skips the test, and says so, when a recording is not there.
#define SKYHALO_SKIP_WITHOUT(path)                                                          \
  if (!std::filesystem::exists(path)) {                                                     \
    GTEST_SKIP() << "no recorded data at " << (path) << "; set SKYHALO_DATA to test on it"; \
  }                                                                                         \
  static_assert(true)
