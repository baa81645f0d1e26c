#pragma once

#include <string>

#include "skyhalo/config/config.hpp"
#include "source.hpp"

namespace skyhalo::app {

/// The boxes whose laser points are no ground truth.
struct Annotations {
  BoxesOf boxes_of;
  bool known = false;  ///< else there are none because nobody annotated the recording
  std::string file;    ///< KITTI labels that they come from; else empty
};

/// The boxes of the label file that is given, else of the sequence's own one, else the recording's
/// own. Throws `Error` (input) for a label file that is not the recording's, and `UsageError` for
/// one beside a recording that has other boxes.
///
/// A label file that is given must be as long as the drive, unless
/// `evaluation.labels_may_end_early`; a sequence's own one may end early and be empty, as where
/// nothing moves.
Annotations find_annotations(const Recording& recording,
                             const std::string& label_file,
                             const EvaluationConfig& config);

}  // namespace skyhalo::app
