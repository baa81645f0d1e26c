#include "skyhalo/sim/setting_range.hpp"

#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/sim/sampled_motion.hpp"

namespace skyhalo {

void check_setting(double value, const SettingRange& range) {
  if (!(value >= range.least && value <= range.most)) {
    throw Error(ErrorKind::kInput,
                std::string(range.name) + " is " + number_text("%g", value) + ", expected " +
                    number_text("%g", range.least) + " to " + number_text("%g", range.most));
  }
}

void check_duration(double duration_s) {
  if (!(duration_s <= kLongestMotionSeconds)) {
    throw Error(ErrorKind::kInput,
                "the flight takes " + number_text("%.0f", duration_s) + " s, expected at most " +
                    number_text("%.0f", kLongestMotionSeconds));
  }
}

}  // namespace skyhalo
