#include "skyhalo/calibration/rig_file.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>

#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/imported_cameras.hpp"
#include "skyhalo/calibration/lens_words.hpp"
#include "skyhalo/calibration/rig_pose.hpp"
#include "skyhalo/calibration/yaml_value.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

constexpr int kLargestImage = 16384;

constexpr double kFarthestM = 1000.0;

/// Of pairs of both kinds.
constexpr std::array<std::string_view, 6> kOptionalKeys{
    "downscale", "rcrop_px", "masks_px", "min_range_m", "max_range_m", "line_time_s"};

const Eigen::Matrix3d kUnturned = Eigen::Matrix3d::Identity();

double positive(const YamlValue& value) {
  const double number = value.number();
  if (!(number > 0.0)) {
    throw value.error("expected a number above 0");
  }
  return number;
}

int whole_number_in(const YamlValue& value, int least, int largest) {
  const int number = value.whole_number();
  if (number < least || number > largest) {
    throw value.error("expected a whole number in " + std::to_string(least) + "..." +
                      std::to_string(largest));
  }
  return number;
}

std::vector<int> whole_numbers(const YamlValue& value, std::size_t count) {
  std::vector<int> numbers;
  for (const YamlValue& item : value.items()) {
    numbers.push_back(item.whole_number());
  }
  if (numbers.size() != count) {
    throw value.error("expected " + std::to_string(count) + " whole numbers, found " +
                      std::to_string(numbers.size()));
  }
  return numbers;
}

cv::Size read_size(const YamlValue& value) {
  const std::vector<int> size = whole_numbers(value, 2);
  if (std::min(size[0], size[1]) < 1 || std::max(size[0], size[1]) > kLargestImage) {
    throw value.error("expected [width, height], each in 1..." + std::to_string(kLargestImage));
  }
  return {size[0], size[1]};
}

std::vector<cv::Rect> read_masks(const YamlValue& value) {
  std::vector<cv::Rect> masks;
  for (const YamlValue& item : value.items()) {
    const std::vector<int> r = whole_numbers(item, 4);
    const bool sane = std::ranges::all_of(r, [](int n) { return std::abs(n) <= kLargestImage; });
    if (r[2] <= 0 || r[3] <= 0 || !sane) {
      throw item.error("expected [u, v, width, height] with sizes above 0 and all within " +
                       std::to_string(kLargestImage));
    }
    masks.emplace_back(r[0], r[1], r[2], r[3]);
  }
  return masks;
}

PairModelKind read_model(const YamlValue& value) {
  const std::string word = value.text();
  if (word != "pinhole" && word != "spherical") {
    throw value.error("expected pinhole or spherical, found '" + word + "'");
  }
  return word == "pinhole" ? PairModelKind::kPinhole : PairModelKind::kSpherical;
}

RawCamera read_camera(const YamlValue& value) {
  value.refuse_other_keys({"size_px", "lens", "intrinsics_px", "distortion"});
  const std::vector<double> f = value.at("intrinsics_px").numbers(4);
  const std::optional<YamlValue> distortion = value.find("distortion");
  const std::string word = value.at("lens").text();
  if (!distortion && word != "pinhole") {
    (void)value.at("distortion");
  }
  const std::vector<double> numbers = distortion ? distortion->numbers() : std::vector<double>{};
  try {
    return {read_size(value.at("size_px")), make_lens(word, {f[0], f[1], f[2], f[3]}, numbers)};
  } catch (const Error& error) {
    const std::string_view message = error.what();
    for (const std::string_view key : {"lens", "intrinsics_px", "distortion"}) {
      if (message.starts_with(std::string(key) + ": ")) {
        throw value.error(key, message.substr(key.size() + 2));
      }
    }
    throw;
  }
}

std::optional<double> read_angle(const YamlValue& section, std::string_view key) {
  const std::optional<YamlValue> value = section.find(key);
  return value ? std::optional(rad_from_deg(positive(*value))) : std::nullopt;
}

VirtualPairWish read_wish(const YamlValue& value) {
  value.refuse_other_keys({"model", "hfov_deg", "vfov_deg", "size_px"});
  VirtualPairWish wish;
  wish.model = read_model(value.at("model"));
  wish.hfov_rad = read_angle(value, "hfov_deg");
  wish.vfov_rad = read_angle(value, "vfov_deg");
  if (const std::optional<YamlValue> size = value.find("size_px")) {
    wish.size_px = read_size(*size);
  }
  return wish;
}

double read_baseline(const YamlValue& section) {
  const YamlValue value = section.at("baseline_m");
  const double baseline_m = positive(value);
  if (baseline_m > kFarthestM) {
    throw value.error("expected a length below 1000 m");
  }
  return baseline_m;
}

PairModel read_pinhole(const YamlValue& value) {
  value.refuse_other_keys(
      {"model", "size_px", "focal_px", "principal_point_px", "baseline_m", "disparity_offset_px"});
  const std::vector<double> principal = value.at("principal_point_px").numbers(2);
  const std::optional<YamlValue> offset = value.find("disparity_offset_px");
  return PinholePair{.focal_px = positive(value.at("focal_px")),
                     .principal_u_px = principal[0],
                     .principal_v_px = principal[1],
                     .baseline_m = read_baseline(value),
                     .disparity_offset_px = offset ? offset->number() : 0.0};
}

PairModel read_spherical(const YamlValue& value) {
  value.refuse_other_keys(
      {"model", "size_px", "delta_theta_rad", "principal_point_px", "baseline_m"});
  const std::vector<double> principal = value.at("principal_point_px").numbers(2);
  const YamlValue delta = value.at("delta_theta_rad");
  const std::vector<double> theta = delta.numbers(2);
  if (!(theta[0] > 0.0) || !(theta[1] > 0.0)) {
    throw delta.error("expected [width, height] of a pixel, both above 0 rad");
  }
  return SphericalPair{.delta_theta_u_rad = theta[0],
                       .delta_theta_v_rad = theta[1],
                       .principal_u_px = principal[0],
                       .principal_v_px = principal[1],
                       .baseline_m = read_baseline(value)};
}

RectifiedPairDescription read_rectified(const YamlValue& value) {
  const PairModelKind kind = read_model(value.at("model"));
  return {read_size(value.at("size_px")),
          kind == PairModelKind::kPinhole ? read_pinhole(value) : read_spherical(value)};
}

/// Reads the parts of a pair and collects what looks odd.
class PairReader {
 public:
  PairReader(const YamlValue& value, std::vector<std::string>& warnings)
      : value_(value), warnings_(warnings) {}

  PairDescription read() {
    PairDescription pair{
        .name = value_.at("name").text(),
        .images = read_images(),
        .T_body_camera =
            read_placement(value_.at("T_body_camera"), R_body_camera(Facing::kForward), warnings_),
        .downscale = read_whole("downscale", 1, 16),
        .rcrop_px = read_whole("rcrop_px", 0, kLargestImage),
        .masks_px = {},
        .min_range_m = read_positive("min_range_m"),
        .max_range_m = read_positive("max_range_m"),
        .line_time_s = read_positive("line_time_s").value_or(0.0)};
    if (const std::optional<YamlValue> masks = value_.find("masks_px")) {
      pair.masks_px = read_masks(*masks);
    }
    if (pair.min_range_m && pair.max_range_m && *pair.min_range_m >= *pair.max_range_m) {
      throw value_.error("min_range_m", "expected a range below max_range_m");
    }
    return pair;
  }

 private:
  std::variant<RawPairDescription, RectifiedPairDescription> read_images() {
    if (const std::optional<YamlValue> rectified = value_.find("rectified")) {
      value_.refuse_other_keys({"name", "rectified", "T_body_camera"}, kOptionalKeys);
      return read_rectified(*rectified);
    }
    value_.refuse_other_keys(
        {"name", "left", "right", "T_right_left", "rectify_to", "T_body_camera"}, kOptionalKeys);
    if (!value_.find("left") && !value_.find("right")) {
      throw value_.error("left", "this key is missing; expected left and right, or rectified");
    }
    return RawPairDescription{{read_camera(value_.at("left")),
                               read_camera(value_.at("right")),
                               read_placement(value_.at("T_right_left"), kUnturned, warnings_)},
                              read_wish(value_.at("rectify_to"))};
  }

  std::optional<int> read_whole(std::string_view key, int least, int largest) {
    const std::optional<YamlValue> value = value_.find(key);
    return value ? std::optional(whole_number_in(*value, least, largest)) : std::nullopt;
  }

  std::optional<double> read_positive(std::string_view key) {
    const std::optional<YamlValue> value = value_.find(key);
    return value ? std::optional(positive(*value)) : std::nullopt;
  }

  const YamlValue& value_;
  std::vector<std::string>& warnings_;
};

RigFile read_rig(const YamlValue& document) {
  document.refuse_other_keys({"rig", "T_body_imu", "pairs"});
  RigFile rig;
  rig.description.name = document.at("rig").text();
  if (const std::optional<YamlValue> imu = document.find("T_body_imu")) {
    rig.description.T_body_imu = read_placement(*imu, kUnturned, rig.warnings);
  }
  const YamlValue pairs = document.at("pairs");
  std::set<std::string> names;
  for (const YamlValue& pair : pairs.items()) {
    rig.description.pairs.push_back(PairReader(pair, rig.warnings).read());
    const std::string& name = rig.description.pairs.back().name;
    const bool printable = std::ranges::none_of(
        name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '/' || c == '\\'; });
    if (name.empty() || name.front() == '.' || !printable) {
      throw pair.error("name", "expected a name that can be part of a file's name");
    }
    if (!names.insert(name).second) {
      throw pair.error("name", "'" + name + "' is the name of another pair");
    }
  }
  if (rig.description.pairs.empty()) {
    throw pairs.error("expected at least one stereo pair");
  }
  return rig;
}

}  // namespace

RigFile read_rig_file(const std::filesystem::path& file) {
  return read_rig(YamlValue::load(file));
}

RigFile parse_rig(std::string_view text, const std::filesystem::path& name) {
  return read_rig(YamlValue::parse(text, name));
}

StereoRig load_rig(const std::filesystem::path& file) {
  const YamlValue document = YamlValue::load(file);
  const RigFile rig = read_rig(document);
  try {
    return resolve(rig.description);
  } catch (const Error& error) {  // says where in the description, not on which line
    throw document.error_below(error.what());
  }
}

}  // namespace skyhalo
