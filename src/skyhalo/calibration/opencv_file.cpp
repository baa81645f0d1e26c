#include "skyhalo/calibration/opencv_file.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "skyhalo/calibration/lens_input.hpp"
#include "skyhalo/calibration/opencv_storage.hpp"

namespace skyhalo {
namespace {

using Keys = std::span<const std::string_view>;

constexpr std::array<std::string_view, 10> kLeftMatrix = {"M1",
                                                          "K1",
                                                          "cameraMatrix1",
                                                          "camera_matrix_1",
                                                          "cameraMatrixL",
                                                          "cameraMatrixLeft",
                                                          "camera_matrix_left",
                                                          "left_camera_matrix",
                                                          "K_left",
                                                          "KL"};
constexpr std::array<std::string_view, 10> kRightMatrix = {"M2",
                                                           "K2",
                                                           "cameraMatrix2",
                                                           "camera_matrix_2",
                                                           "cameraMatrixR",
                                                           "cameraMatrixRight",
                                                           "camera_matrix_right",
                                                           "right_camera_matrix",
                                                           "K_right",
                                                           "KR"};
constexpr std::array<std::string_view, 10> kLeftDistortion = {"D1",
                                                              "distCoeffs1",
                                                              "dist_coeffs_1",
                                                              "distCoeffsL",
                                                              "distCoeffsLeft",
                                                              "dist_coeffs_left",
                                                              "distortion_left",
                                                              "left_distortion",
                                                              "D_left",
                                                              "DL"};
constexpr std::array<std::string_view, 10> kRightDistortion = {"D2",
                                                               "distCoeffs2",
                                                               "dist_coeffs_2",
                                                               "distCoeffsR",
                                                               "distCoeffsRight",
                                                               "dist_coeffs_right",
                                                               "distortion_right",
                                                               "right_distortion",
                                                               "D_right",
                                                               "DR"};
constexpr std::array<std::string_view, 1> kRotation = {"R"};
constexpr std::array<std::string_view, 1> kTranslation = {"T"};
constexpr std::array<std::string_view, 2> kSize = {"imageSize", "image_size"};
constexpr std::array<std::string_view, 2> kModel = {"distortion_model", "camera_model"};
constexpr std::array<std::string_view, 3> kOmnidirectional = {"xi", "xi1", "xi2"};

ErrorAt error_at(const OpencvEntry& entry) {
  return [entry](std::string_view message) { return entry.error(message); };
}

/// The lens model that an entry names.
LensKind lens_kind_of(const OpencvEntry& model) {
  constexpr std::array<std::string_view, 5> kRadialTangential = {
      "plumb_bob", "radtan", "radial-tangential", "rational_polynomial", "pinhole"};
  const std::string name = model.text();
  if (name == "equidistant" || name == "fisheye") {
    return LensKind::kKannalaBrandt;
  }
  if (std::find(kRadialTangential.begin(), kRadialTangential.end(), name) !=
      kRadialTangential.end()) {
    return LensKind::kRadialTangential;
  }
  throw model.error("'" + name +
                    "' is not supported; supported are equidistant, fisheye, plumb_bob, radtan, "
                    "radial-tangential, rational_polynomial and pinhole");
}

LensKind read_lens_kind(const OpencvStorage& storage) {
  if (const auto xi = storage.find(kOmnidirectional)) {
    throw xi->error(
        "the omnidirectional model is not supported; supported are the radial-tangential and the "
        "fisheye model");
  }
  if (const auto flag = storage.find("fisheye_model"); flag && flag->text() == "1") {
    return LensKind::kKannalaBrandt;
  }
  const auto model = storage.find(kModel);
  return model ? lens_kind_of(*model) : LensKind::kRadialTangential;
}

Intrinsics read_matrix(const OpencvEntry& entry) {
  const std::vector<double> k = entry.numbers(9);
  if (k[1] != 0.0 || k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0) {
    throw entry.error("expected fx 0 cx, 0 fy cy, 0 0 1");
  }
  return {k[0], k[4], k[2], k[5]};
}

Lens read_lens(const OpencvStorage& storage, Keys matrix_keys, Keys distortion_keys) {
  const OpencvEntry matrix = storage.at(matrix_keys);
  const OpencvEntry distortion = storage.at(distortion_keys);
  LensInput input;
  input.kind = read_lens_kind(storage);
  input.intrinsics = read_matrix(matrix);
  input.distortion = distortion.numbers();
  input.intrinsics_at = error_at(matrix);
  input.distortion_at = error_at(distortion);
  return lens_from(input);
}

int read_length_px(const OpencvEntry& entry, double value) {
  constexpr double kLargest = 1e6;
  if (!(value >= 1.0 && value <= kLargest) || value != static_cast<int>(value)) {
    throw entry.error("expected whole numbers of pixels above 0");
  }
  return static_cast<int>(value);
}

cv::Size read_size_px(const OpencvStorage& storage, const std::optional<cv::Size>& given_px) {
  if (const auto size = storage.find(kSize)) {
    const std::vector<double> numbers = size->numbers(2);
    return {read_length_px(*size, numbers[0]), read_length_px(*size, numbers[1])};
  }
  const auto width = storage.find("image_width");
  const auto height = storage.find("image_height");
  if (width && height) {
    return {read_length_px(*width, width->numbers(1)[0]),
            read_length_px(*height, height->numbers(1)[0])};
  }
  if (!given_px) {
    throw storage.error(
        "image_size: this key is missing (nor imageSize, image_width and image_height); give the "
        "size of the images with --size WxH");
  }
  return *given_px;
}

Pose read_pose(const OpencvStorage& storage, std::vector<std::string>& warnings) {
  const OpencvEntry rotation = storage.at(kRotation);
  const std::vector<double> t = storage.at(kTranslation).numbers(3);
  return make_pose(rotation_from(rotation.numbers(9), error_at(rotation), warnings),
                   {t[0], t[1], t[2]});
}

}  // namespace

ImportedCameras read_opencv_stereo(const std::vector<std::filesystem::path>& files,
                                   std::optional<cv::Size> size_px) {
  const OpencvStorage storage(files);
  const Lens left = read_lens(storage, kLeftMatrix, kLeftDistortion);
  const Lens right = read_lens(storage, kRightMatrix, kRightDistortion);
  const cv::Size used_px = read_size_px(storage, size_px);
  ImportedCameras imported;
  const Pose T_right_left = read_pose(storage, imported.warnings);
  imported.cameras = {{"left", {used_px, left}},
                      {"right", {used_px, right}, T_right_left.inverse()}};
  return imported;
}

std::span<const std::string_view> opencv_camera_matrix_keys(int camera) noexcept {
  return camera == 0 ? Keys(kLeftMatrix) : Keys(kRightMatrix);
}

}  // namespace skyhalo
