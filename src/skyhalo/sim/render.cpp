#include "skyhalo/sim/render.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "skyhalo/base/for_each_index.hpp"
#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {
namespace {

/// Where in a pixel a sample looks, and at which share of the exposure.
struct Sample {
  float x;
  float y;
  double time;
};

std::vector<Sample> samples_of(int count) {
  if (count == 4) {  // a turned square: no two samples share a row or a column
    return {{0.375F, 0.125F, 0.125},
            {0.875F, 0.375F, 0.625},
            {0.125F, 0.625F, 0.375},
            {0.625F, 0.875F, 0.875}};
  }
  const int side = static_cast<int>(std::lround(std::sqrt(count)));
  std::vector<Sample> samples;
  samples.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const int row = i / side;
    samples.push_back({(static_cast<float>(i % side) + 0.5F) / static_cast<float>(side),
                       (static_cast<float>(row) + 0.5F) / static_cast<float>(side),
                       (i + 0.5) / count});
  }
  return samples;
}

/// The camera at one moment, for rays.
struct CameraAt {
  Eigen::Matrix3f R_scene_camera;
  Eigen::Vector3f position_m;
  float time = 0.0F;  // share of the scene's moment
};

double row_time_s(int row, int rows, const CameraShot& shot) noexcept {
  return shot.stamp_s + (row - 0.5 * (rows - 1)) * shot.line_time_s;
}

CameraAt camera_at(const CameraShot& shot, double t_s, const TimeSpan& span) {
  const Pose T_scene_camera = shot.T_scene_camera(t_s);
  const double length_s = span.end_s - span.begin_s;
  const double share = length_s > 0.0 ? (t_s - span.begin_s) / length_s : 0.0;
  return {T_scene_camera.linear().cast<float>(),
          T_scene_camera.translation().cast<float>(),
          static_cast<float>(std::clamp(share, 0.0, 1.0))};
}

/// The brightness of a row's pixels.
class RowRenderer {
 public:
  RowRenderer(const SceneMoment& moment, const SurfaceColour& colours, const CameraRays& rays)
      : moment_(moment), colours_(colours), camera_rays_(rays) {}

  void render(int row,
              std::span<const Sample> samples,
              std::span<const CameraAt> cameras,
              cv::Vec3f* pixels) {
    const int cols = camera_rays_.size_px().width;
    rays_.resize(static_cast<std::size_t>(cols) * samples.size());
    hits_.resize(rays_.size());
    std::size_t next = 0;
    for (int col = 0; col < cols; ++col) {
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const CameraAt& camera = cameras[i];
        rays_[next++] = {
            camera.position_m,
            camera.R_scene_camera * camera_rays_.at(row, col, samples[i].x, samples[i].y),
            camera.time};
      }
    }
    moment_.trace(rays_, hits_);
    next = 0;
    const float share = 1.0F / static_cast<float>(samples.size());
    for (int col = 0; col < cols; ++col) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (std::size_t i = 0; i < samples.size(); ++i, ++next) {
        if (rays_[next].direction.squaredNorm() > 0.5F) {
          sum += colours_.of(rays_[next], hits_[next], camera_rays_.pixel_rad());
        }
      }
      pixels[col] = {share * sum.x(), share * sum.y(), share * sum.z()};
    }
  }

 private:
  const SceneMoment& moment_;
  const SurfaceColour& colours_;
  const CameraRays& camera_rays_;
  std::vector<SceneRay> rays_;
  std::vector<SceneHit> hits_;
};

cv::Mat3f brightness(const SceneMoment& moment,
                     const SurfaceColour& colours,
                     const CameraRays& rays,
                     const CameraShot& shot,
                     const CameraLook& look) {
  constexpr int kBandRows = 8;
  const std::vector<Sample> samples = samples_of(look.samples);
  const int rows = rays.size_px().height;
  cv::Mat3f picture(rays.size_px());
  const int bands = (rows + kBandRows - 1) / kBandRows;
  for_each_index(static_cast<std::size_t>(bands), [&](std::size_t band) {
    RowRenderer renderer(moment, colours, rays);
    std::vector<CameraAt> cameras(samples.size());
    const int first = static_cast<int>(band) * kBandRows;
    for (int row = first; row < std::min(first + kBandRows, rows); ++row) {
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const double t_s = row_time_s(row, rows, shot) + (samples[i].time - 0.5) * look.exposure_s;
        cameras[i] = camera_at(shot, t_s, moment.span());
      }
      renderer.render(row, samples, cameras, picture[row]);
    }
  });
  return picture;
}

/// Share of light that is left so far (as a square, 1 in the corner) from the middle.
float left_by_vignetting(float r2, const CameraLook& look) noexcept {
  return 1.0F - static_cast<float>(look.vignetting) * r2;
}

std::uint8_t digitised(float white_share, std::uint64_t bits, const CameraLook& look) noexcept {
  float value = std::clamp(white_share, 0.0F, 4.0F);
  if (look.white_electrons > 0.0) {
    const auto full = static_cast<float>(look.white_electrons);
    const auto read = static_cast<float>(look.read_electrons);
    value += gaussian(bits) * std::sqrt(value * full + read * read) / full;
  }
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
}

}  // namespace

TimeSpan exposed_span(int rows, const CameraShot& shot, const CameraLook& look) noexcept {
  const double half_s = 0.5 * ((rows - 1) * shot.line_time_s + look.exposure_s);
  return {shot.stamp_s - half_s, shot.stamp_s + half_s};
}

cv::Mat3b render(const SceneMoment& moment,
                 const SurfaceColour& colours,
                 const CameraRays& rays,
                 const CameraShot& shot,
                 const CameraLook& look) {
  cv::Mat3f light = brightness(moment, colours, rays, shot, look);
  if (look.blur_px > 0.0) {
    cv::GaussianBlur(
        light, light, cv::Size(0, 0), look.blur_px, look.blur_px, cv::BORDER_REPLICATE);
  }
  const cv::Size& size = rays.size_px();
  const float cx = 0.5F * static_cast<float>(size.width - 1);
  const float cy = 0.5F * static_cast<float>(size.height - 1);
  const float corner2 = std::max(cx * cx + cy * cy, 1.0F);
  const auto gain = static_cast<float>(look.gain);
  cv::Mat3b picture(size);
  for_each_index(static_cast<std::size_t>(size.height), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    const float y = static_cast<float>(r) - cy;
    for (int col = 0; col < size.width; ++col) {
      const float x = static_cast<float>(col) - cx;
      const float scale = gain * left_by_vignetting((x * x + y * y) / corner2, look);
      const std::uint64_t pixel = random_bits(
          {shot.noise_key,
           row * static_cast<std::uint64_t>(size.width) + static_cast<std::uint64_t>(col)});
      const cv::Vec3f& value = light(r, col);
      for (int channel = 0; channel < 3; ++channel) {
        picture(r, col)[channel] =
            digitised(scale * value[channel], stirred(pixel, static_cast<unsigned>(channel)), look);
      }
    }
  });
  return picture;
}

}  // namespace skyhalo
