#pragma once

#include <string_view>

namespace skyhalo {

/// The values that a setting may have, both ends too.
struct SettingRange {
  std::string_view name;
  double least = 0.0;
  double most = 0.0;
};

/// Throws `Error` (input) that names setting, value and range when the value is not within it.
void check_setting(double value, const SettingRange& range);

/// Throws `Error` (input) when a motion takes longer than can be generated (an hour).
void check_duration(double duration_s);

}  // namespace skyhalo
