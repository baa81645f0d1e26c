#include "annotations.hpp"

#include <memory>
#include <system_error>

#include "skyhalo/base/error.hpp"
#include "skyhalo/dataset/kitti_labels.hpp"

namespace skyhalo::app {
namespace {

/// Throws when the labels cannot be those of a drive of so many frames.
void check_length(const TrackLabels& labels,
                  const std::string& file,
                  int frame_count,
                  bool may_end_early) {
  const int last = labels.last_frame();
  const std::string has = "the labels end with frame " + std::to_string(last) +
                          ", the drive with frame " + std::to_string(frame_count - 1);
  if (last >= frame_count) {
    throw input_error(file, labels.last_frame_line(), has);
  }
  if (last < frame_count - 1 && !may_end_early) {
    throw input_error(file,
                      labels.last_frame_line(),
                      has +
                          "; if there really is nothing after it, use --set "
                          "evaluation.labels_may_end_early=true");
  }
}

bool is_own_file(const std::string& file, const Recording& recording) {
  std::error_code ignored;
  return !recording.label_file.empty() &&
         std::filesystem::equivalent(file, recording.label_file, ignored);
}

}  // namespace

Annotations find_annotations(const Recording& recording,
                             const std::string& label_file,
                             const EvaluationConfig& config) {
  if (!label_file.empty() && !recording.takes_labels) {
    throw UsageError("--labels " + label_file +
                     ": a recording of skyhalo's own has its boxes in objects.csv");
  }
  if (recording.own_boxes) {
    return {recording.own_boxes, true, ""};
  }
  const std::string file = label_file.empty() ? recording.label_file.string() : label_file;
  if (file.empty()) {
    return {[](int) { return std::vector<OrientedBox>(); }, false, ""};
  }
  const auto labels = std::make_shared<const TrackLabels>(file);
  const bool own = is_own_file(file, recording);
  if (!own && labels->last_frame() < 0) {
    throw input_error(file, "holds no label");
  }
  check_length(*labels, file, recording.frames->frame_count(), own || config.labels_may_end_early);
  const auto boxes_of = [labels](int frame) {
    std::vector<OrientedBox> boxes;
    for (const TrackedObject& object : labels->objects(frame)) {
      boxes.push_back(object.box);
    }
    return boxes;
  };
  return {boxes_of, true, file};
}

}  // namespace skyhalo::app
