#pragma once

#include <hwy/targets.h>

#include <cstdint>
#include <string>
#include <vector>

namespace skyhalo::testing {

/// Kernels run with one of this processor's instruction sets for as long as this object lives, and
/// with the best one afterwards. Not while another thread calls one.
class InstructionSet {
 public:
  explicit InstructionSet(std::int64_t target) { use(target); }

  InstructionSet(const InstructionSet&) = delete;
  InstructionSet(InstructionSet&&) = delete;
  InstructionSet& operator=(const InstructionSet&) = delete;
  InstructionSet& operator=(InstructionSet&&) = delete;

  ~InstructionSet() { use(0); }

  /// All that this processor has and kernels were built for, best first.
  static std::vector<std::int64_t> all() {
    std::vector<std::int64_t> targets;
    const std::int64_t available = hwy::SupportedTargets() & HWY_TARGETS;
    for (int bit = 0; bit < 63; ++bit) {
      const std::int64_t target = std::int64_t{1} << bit;
      if ((available & target) != 0) {
        targets.push_back(target);
      }
    }
    return targets;
  }

  static std::string name(std::int64_t target) { return hwy::TargetName(target); }

 private:
  static void use(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

}  // namespace skyhalo::testing
