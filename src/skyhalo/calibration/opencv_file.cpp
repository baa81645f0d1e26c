#include "skyhalo/calibration/opencv_file.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "skyhalo/calibration/image_size.hpp"
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

/// The lens model that an entry names; none for pinhole, which both may be called.
std::optional<LensKind> lens_kind_of(const OpencvEntry& model) {
  constexpr std::array<std::string_view, 4> kRadialTangential = {
      "plumb_bob", "radtan", "radial-tangential", "rational_polynomial"};
  const std::string name = model.text();
  if (name == "pinhole") {
    return std::nullopt;
  }
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

/// The lens model that the files name; none when they do not.
std::optional<LensKind> find_lens_kind(const OpencvStorage& storage) {
  if (const auto xi = storage.find(kOmnidirectional)) {
    throw xi->error(
        "the omnidirectional model is not supported; supported are the radial-tangential and the "
        "fisheye model");
  }
  const auto flag = storage.find("fisheye_model");
  if (flag && flag->text() == "1") {
    return LensKind::kKannalaBrandt;
  }
  const auto model = storage.find(kModel);
  const std::optional<LensKind> named = model ? lens_kind_of(*model) : std::nullopt;
  return named || !flag ? named : LensKind::kRadialTangential;
}

/// The lens model that the files name or `fisheye` asks for, which must not contradict each other.
std::optional<LensKind> wanted_lens_kind(const OpencvStorage& storage, bool fisheye) {
  const std::optional<LensKind> named = find_lens_kind(storage);
  if (fisheye && named && *named != LensKind::kKannalaBrandt) {
    throw storage.error("the lens model that they name is not the fisheye model that is asked for");
  }
  return fisheye ? LensKind::kKannalaBrandt : named;
}

void warn_of_unnamed_model(const OpencvEntry& distortion,
                           std::size_t count,
                           std::vector<std::string>& warnings) {
  if (count == 4) {
    warnings.emplace_back(distortion
                              .error("4 numbers and no word of the model: taken for "
                                     "radial-tangential; cv::fisheye writes 4 too")
                              .what());
  }
}

/// What one camera's matrix and coefficients may be called.
struct CameraKeys {
  Keys matrix;
  Keys distortion;
};

Lens read_lens(const OpencvStorage& storage,
               const CameraKeys& keys,
               const std::optional<LensKind>& kind,
               std::vector<std::string>& warnings) {
  const OpencvEntry matrix = storage.at(keys.matrix);
  const OpencvEntry distortion = storage.at(keys.distortion);
  LensInput input;
  input.kind = kind.value_or(LensKind::kRadialTangential);
  input.intrinsics = intrinsics_from(matrix.numbers(9), error_at(matrix));
  input.distortion = distortion.numbers();
  input.intrinsics_at = error_at(matrix);
  input.distortion_at = error_at(distortion);
  if (!kind) {
    warn_of_unnamed_model(distortion, input.distortion.size(), warnings);
  }
  return lens_from(input);
}

cv::Size read_size_px(const OpencvStorage& storage, const std::optional<cv::Size>& given_px) {
  if (const auto size = storage.find(kSize)) {
    const std::vector<double> numbers = size->numbers(2);
    return {image_side_px(numbers[0], error_at(*size)), image_side_px(numbers[1], error_at(*size))};
  }
  const auto width = storage.find("image_width");
  const auto height = storage.find("image_height");
  if (width && height) {
    return {image_side_px(width->numbers(1)[0], error_at(*width)),
            image_side_px(height->numbers(1)[0], error_at(*height))};
  }
  if (!given_px) {
    throw storage.error(
        "image_size: this key is missing (nor imageSize, image_width and image_height); the "
        "size of the images must be given");
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
                                   std::optional<cv::Size> size_px,
                                   bool fisheye) {
  const OpencvStorage storage(files);
  const std::optional<LensKind> kind = wanted_lens_kind(storage, fisheye);
  ImportedCameras imported;
  const Lens left = read_lens(storage, {kLeftMatrix, kLeftDistortion}, kind, imported.warnings);
  const Lens right = read_lens(storage, {kRightMatrix, kRightDistortion}, kind, imported.warnings);
  const cv::Size used_px = read_size_px(storage, size_px);
  const Pose T_right_left = read_pose(storage, imported.warnings);
  imported.cameras = {{"left", {used_px, left}},
                      {"right", {used_px, right}, T_right_left.inverse()}};
  return imported;
}

std::span<const std::string_view> opencv_camera_matrix_keys(int camera) noexcept {
  return camera == 0 ? Keys(kLeftMatrix) : Keys(kRightMatrix);
}

}  // namespace skyhalo
