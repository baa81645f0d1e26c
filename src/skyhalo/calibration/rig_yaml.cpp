#include <array>
#include <charconv>
#include <sstream>

#include "skyhalo/calibration/lens_words.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

/// The shortest text that reads back as the same number.
std::string text_of(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

/// An angle whose text, in degrees, reads back as the same number of radians.
std::string degrees_text(double angle_rad) {
  double angle_deg = deg_from_rad(angle_rad);
  const double rounded = std::round(angle_deg * 1e9) / 1e9;
  if (rad_from_deg(rounded) == angle_rad) {
    return text_of(rounded);
  }
  for (const double candidate : {std::nextafter(angle_deg, -1e9), std::nextafter(angle_deg, 1e9)}) {
    angle_deg = rad_from_deg(angle_deg) == angle_rad ? angle_deg : candidate;
  }
  return text_of(angle_deg);
}

template <class Numbers>
std::string list_of(const Numbers& numbers) {
  std::string text;
  for (const double number : numbers) {
    text += (text.empty() ? "" : ", ") + text_of(number);
  }
  return "[" + text + "]";
}

std::string list_of(const cv::Size& size) {
  return "[" + std::to_string(size.width) + ", " + std::to_string(size.height) + "]";
}

std::string list_of(const cv::Rect& r) {
  return "[" + std::to_string(r.x) + ", " + std::to_string(r.y) + ", " + std::to_string(r.width) +
         ", " + std::to_string(r.height) + "]";
}

/// Text in double quotes, as YAML and JSON read it.
std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
    }
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

class Writer {
 public:
  void comment(std::string_view head) {
    std::istringstream lines{std::string(head)};
    for (std::string line; std::getline(lines, line);) {
      out_ << (line.empty() ? "#" : "# ") << line << "\n";
    }
  }

  void pose(const char* indent, const char* key, const Pose& T) {
    out_ << indent << key << ":\n";
    for (int row = 0; row < 4; ++row) {
      const Eigen::Vector4d r = T.matrix().row(row);
      out_ << indent << "  - " << list_of(std::array{r[0], r[1], r[2], r[3]}) << "\n";
    }
  }

  void camera(const char* key, const RawCamera& camera) {
    const Intrinsics& f = intrinsics(camera.lens);
    out_ << "    " << key << ":\n"
         << "      size_px: " << list_of(camera.size_px) << "\n"
         << "      lens: " << lens_word(camera.lens) << "\n"
         << "      intrinsics_px: " << list_of(std::array{f.fx_px, f.fy_px, f.cx_px, f.cy_px})
         << "  # fx, fy, cx, cy\n"
         << "      distortion: " << list_of(distortion_numbers(camera.lens)) << "\n";
  }

  void operator()(const RawPairDescription& raw) {
    camera("left", raw.cameras.left);
    camera("right", raw.cameras.right);
    pose("    ", "T_right_left", raw.cameras.T_right_left);
    const VirtualPairWish& wish = raw.rectify_to;
    out_ << "    rectify_to:\n      model: "
         << (wish.model == PairModelKind::kPinhole ? "pinhole" : "spherical") << "\n";
    if (wish.hfov_rad) {
      out_ << "      hfov_deg: " << degrees_text(*wish.hfov_rad) << "\n";
    }
    if (wish.vfov_rad) {
      out_ << "      vfov_deg: " << degrees_text(*wish.vfov_rad) << "\n";
    }
    if (wish.size_px) {
      out_ << "      size_px: " << list_of(*wish.size_px) << "\n";
    }
  }

  void operator()(const RectifiedPairDescription& rectified) {
    const auto* pinhole = std::get_if<PinholePair>(&rectified.model);
    out_ << "    rectified:\n      model: " << (pinhole != nullptr ? "pinhole" : "spherical")
         << "\n      size_px: " << list_of(rectified.size_px) << "\n";
    std::visit([this](const auto& model) { numbers(model); }, rectified.model);
  }

  void numbers(const PinholePair& pair) {
    out_ << "      focal_px: " << text_of(pair.focal_px) << "\n";
    principal_and_baseline(pair);
    if (pair.disparity_offset_px != 0.0) {
      out_ << "      disparity_offset_px: " << text_of(pair.disparity_offset_px) << "\n";
    }
  }

  void numbers(const SphericalPair& pair) {
    out_ << "      delta_theta_rad: "
         << list_of(std::array{pair.delta_theta_u_rad, pair.delta_theta_v_rad}) << "\n";
    principal_and_baseline(pair);
  }

  void pair(const PairDescription& pair) {
    out_ << "\n  - name: " << in_quotes(pair.name) << "\n";
    std::visit(*this, pair.images);
    pose("    ", "T_body_camera", pair.T_body_camera);
    optional("downscale", pair.downscale);
    optional("rcrop_px", pair.rcrop_px);
    if (!pair.masks_px.empty()) {
      out_ << "    masks_px:\n";
      for (const cv::Rect& mask : pair.masks_px) {
        out_ << "      - " << list_of(mask) << "\n";
      }
    }
    optional("min_range_m", pair.min_range_m);
    optional("max_range_m", pair.max_range_m);
    if (pair.line_time_s > 0.0) {
      out_ << "    line_time_s: " << text_of(pair.line_time_s) << "\n";
    }
  }

  void rig(const RigDescription& rig) {
    out_ << "rig: " << in_quotes(rig.name) << "\n";
    if (rig.T_body_imu) {
      pose("", "T_body_imu", *rig.T_body_imu);
    }
    out_ << "pairs:";
    for (const PairDescription& each : rig.pairs) {
      pair(each);
    }
  }

  [[nodiscard]] std::string text() const { return out_.str(); }

 private:
  template <class Model>
  void principal_and_baseline(const Model& pair) {
    out_ << "      principal_point_px: "
         << list_of(std::array{pair.principal_u_px, pair.principal_v_px}) << "\n"
         << "      baseline_m: " << text_of(pair.baseline_m) << "\n";
  }

  void optional(const char* key, const std::optional<int>& value) {
    if (value) {
      out_ << "    " << key << ": " << *value << "\n";
    }
  }

  void optional(const char* key, const std::optional<double>& value) {
    if (value) {
      out_ << "    " << key << ": " << text_of(*value) << "\n";
    }
  }

  std::ostringstream out_;
};

}  // namespace

std::string to_yaml(const RigDescription& rig, std::string_view head) {
  Writer writer;
  writer.comment(head);
  writer.rig(rig);
  return writer.text();
}

}  // namespace skyhalo
