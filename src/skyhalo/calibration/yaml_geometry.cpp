#include "skyhalo/calibration/yaml_geometry.hpp"

#include <string_view>

#include "skyhalo/calibration/image_size.hpp"

namespace skyhalo {
namespace {

std::size_t read_count(const YamlValue& value) {
  const int count = value.whole_number();
  if (count < 0) {
    throw value.error("expected a count, found " + std::to_string(count));
  }
  return static_cast<std::size_t>(count);
}

}  // namespace

ErrorAt error_at(const YamlValue& value) {
  return [value](std::string_view message) { return value.error(message); };
}

ErrorAt error_at(const YamlValue& map, const std::string& key) {
  return [map, key](std::string_view message) { return map.error(key, message); };
}

std::vector<double> matrix_numbers(const YamlValue& value) {
  if (!value.is_map()) {
    return value.numbers();
  }
  const YamlValue data = value.at("data");
  std::vector<double> numbers = data.numbers();
  const auto rows = value.find("rows");
  const auto cols = value.find("cols");
  if (rows && cols && read_count(*rows) * read_count(*cols) != numbers.size()) {
    throw data.error("expected " + rows->text() + " x " + cols->text() + " numbers, found " +
                     std::to_string(numbers.size()));
  }
  return numbers;
}

Pose read_pose(const YamlValue& value, std::vector<std::string>& warnings) {
  return pose_from(matrix_numbers(value), error_at(value), warnings);
}

cv::Size read_size_px(const YamlValue& value) {
  const std::vector<YamlValue> items = value.items();
  if (items.size() != 2) {
    throw value.error("expected width and height, found " + std::to_string(items.size()) +
                      " numbers");
  }
  return {read_side_px(items[0]), read_side_px(items[1])};
}

int read_side_px(const YamlValue& value) {
  return image_side_px(value.whole_number(), error_at(value));
}

Intrinsics read_intrinsics(const YamlValue& value) {
  const std::vector<double> numbers = value.numbers(4);
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

}  // namespace skyhalo
