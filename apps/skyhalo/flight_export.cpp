#include "flight_export.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "exact_map.hpp"
#include "for_each_frame.hpp"
#include "simulation.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/dataset/euroc_writer.hpp"
#include "skyhalo/dataset/flight_recording_writer.hpp"
#include "skyhalo/dataset/kitti_tracking_writer.hpp"
#include "skyhalo/io/skymap_file.hpp"
#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/map/to_sparse.hpp"

namespace skyhalo::app {
namespace {

/// Looks along the body's x axis.
Pose looking_ahead(const Eigen::Vector3d& place_m) {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return make_pose(R_body_camera, place_m);
}

/// KITTI's colour pair.
PairDescription kitti_pair() {
  constexpr double kBaselineM = 0.5327;
  return {.name = "colour",
          .images = RectifiedPairDescription{{1242, 375},
                                             PinholePair{.focal_px = 721.5377,
                                                         .principal_u_px = 609.5593,
                                                         .principal_v_px = 172.854,
                                                         .baseline_m = kBaselineM}},
          .T_body_camera = looking_ahead({0.3, -0.5 * kBaselineM, 0.0})};
}

/// Cameras as the EuRoC flights have, with their lenses.
PairDescription euroc_pair() {
  constexpr double kBaselineM = 0.11;
  const RawCamera camera{
      {752, 480},
      RadialTangentialLens({458.654, 457.296, 367.215, 248.375},
                           {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05})};
  return {.name = "front",
          .images =
              RawPairDescription{
                  {camera, camera, make_pose(Eigen::Matrix3d::Identity(), {-kBaselineM, 0.0, 0.0})},
                  {}},
          .T_body_camera = looking_ahead({0.1, -0.5 * kBaselineM, 0.0})};
}

bool fits(ExportFormat format, const StereoPair& pair) {
  return format == ExportFormat::kEuroc || std::holds_alternative<PinholePair>(pair.model);
}

/// The same pair, as if its images came rectified.
PairDescription rectified(const PairDescription& pair, const StereoPair& resolved) {
  PairDescription other = pair;
  other.images = RectifiedPairDescription{resolved.image_size_px, resolved.model};
  other.T_body_camera = resolved.T_body_camera;
  other.line_time_s = 0.0;
  return other;
}

std::string names_of(const std::vector<PairDescription>& pairs) {
  std::string names;
  for (const PairDescription& pair : pairs) {
    names += (names.empty() ? "" : ", ") + pair.name;
  }
  return names;
}

RigDescription with_one_pair(RigDescription rig, const std::string& name) {
  const auto found = std::ranges::find(rig.pairs, name, &PairDescription::name);
  if (found == rig.pairs.end()) {
    throw UsageError("--pair " + name + ": the rig has " + names_of(rig.pairs));
  }
  rig.pairs = {*found};
  return rig;
}

/// The pairs of a rig that fit the format, and have the name, if there is one.
std::vector<PairDescription> fitting(ExportFormat format,
                                     const RigDescription& rig,
                                     const std::string& name) {
  const StereoRig resolved = resolve(rig);
  std::vector<PairDescription> pairs;
  for (std::size_t i = 0; i < resolved.pairs.size(); ++i) {
    if (fits(format, resolved.pairs[i]) && (name.empty() || resolved.pairs[i].name == name)) {
      pairs.push_back(format == ExportFormat::kEuroc ? rig.pairs[i]
                                                     : rectified(rig.pairs[i], resolved.pairs[i]));
    }
  }
  return pairs;
}

Eigen::Vector3d left_eye_m(const StereoPair& pair) {
  return pair.T_body_camera * Eigen::Vector3d(-baseline_m(pair.model), 0.0, 0.0);
}

LaserReturns returns_of(const std::vector<LaserReturn>& scan) {
  LaserReturns returns;
  for (const LaserReturn& one : scan) {
    returns.points_m.push_back(one.point_m);
    returns.reflectances.push_back(one.reflectance);
  }
  return returns;
}

/// What a pair should find, as it is written.
PairTruth truth_of(const SimulatedFlight& flight, int frame, std::size_t pair, int downscale) {
  DepthTruth truth = flight.truth(frame, pair, downscale);
  std::replace(truth.range_m.begin(),
               truth.range_m.end(),
               std::numeric_limits<float>::infinity(),
               std::numeric_limits<float>::quiet_NaN());
  return {truth.disparity_px, truth.range_m};
}

FlightFrame flight_frame(const SimulatedFlight& flight, const ExportSettings& settings, int frame) {
  FlightFrame written{.images = flight.read(frame),
                      .T_map_body = flight.T_map_body(frame),
                      .true_pose = flight.T_scene_body(frame),
                      .scan = {},
                      .sonar_m = flight.sonar_m(frame)};
  const auto& pairs = flight.rig().pairs;
  written.objects = flight.objects(frame, left_eye_m(pairs.front()));
  if (settings.with_laser) {
    written.scan = returns_of(flight.laser_returns(frame));
  }
  for (std::size_t i = 0; settings.with_truth && i < pairs.size(); ++i) {
    written.truth.push_back(
        truth_of(flight, frame, i, pairs[i].downscale.value_or(settings.downscale)));
  }
  return written;
}

/// All exact cells, and those that a camera saw, as maps.
void write_exact_maps(const ExactMap& exact, const FlightRecordingWriter& writer) {
  constexpr LogOdds kSure = 5000;
  DenseMap all(exact.grid());
  DenseMap seen(exact.grid());
  for (std::int64_t i = 0; i < exact.grid().cell_count(); ++i) {
    const LogOdds cell =
        exact.occupied()[static_cast<std::size_t>(i)] != 0 ? kSure : static_cast<LogOdds>(-kSure);
    all.at(i) = cell;
    if (exact.seen()[static_cast<std::size_t>(i)] != 0) {
      seen.at(i) = cell;
    }
  }
  write_skymap(writer.file("truth/exact.skymap"), to_sparse(all), {.limit_units = kSure});
  write_skymap(writer.file("truth/seen.skymap"), to_sparse(seen), {.limit_units = kSure});
}

template <class Make, class Write>
void write_frames(const SimulatedFlight& flight, bool quiet, const Make& make, const Write& write) {
  ProgressBar bar("simulating", flight.frame_count(), quiet);
  for_each_frame({0, flight.frame_count() - 1}, bar, make, write);
}

void export_own(const SimulatedFlight& flight,
                const RigDescription& rig,
                const ExportSettings& settings,
                bool quiet) {
  FlightRecordingWriter writer(
      settings.folder,
      {.name = flight.name(),
       .source = settings.source,
       .rig = rig,
       .T_body_laser =
           settings.with_laser ? std::optional(flight.config().T_body_laser) : std::nullopt,
       .has_sonar = true,
       .has_objects = true});
  ExactMap exact(flight, settings.voxel_m);
  write_frames(
      flight,
      quiet,
      [&](int frame) { return flight_frame(flight, settings, frame); },
      [&](int frame, const FlightFrame& written) {
        writer.add(written);
        if (settings.with_truth) {
          exact.look_from(frame, settings.downscale);
        }
      });
  if (settings.with_truth) {
    write_exact_maps(exact, writer);
  }
  writer.finish();
}

/// Labels say where objects are seen: from the true pose, however wrong the measured one is.
KittiTrackingFrame kitti_frame(const SimulatedFlight& flight, int frame) {
  KittiTrackingFrame written{
      .images = flight.read_pair(frame, 0),
      .T_map_body = flight.T_map_body(frame),
      .scan = returns_of(flight.laser_returns(frame)),
      .objects = flight.objects(frame, left_eye_m(flight.rig().pairs.front()))};
  const Pose T_map_scene = written.T_map_body * flight.T_scene_body(frame).inverse();
  for (SceneObject& object : written.objects) {
    object.T_map_object = T_map_scene * object.T_map_object;
  }
  return written;
}

void export_kitti(const SimulatedFlight& flight, const ExportSettings& settings, bool quiet) {
  const StereoPair& pair = flight.rig().pairs.front();
  KittiTrackingWriter writer(
      settings.folder, settings.sequence, {pair, flight.config().T_body_laser});
  write_frames(
      flight,
      quiet,
      [&](int frame) { return kitti_frame(flight, frame); },
      [&](int, const KittiTrackingFrame& written) { writer.add(written); });
  writer.finish();
}

void export_euroc(const SimulatedFlight& flight,
                  const RigDescription& rig,
                  const ExportSettings& settings,
                  bool quiet) {
  EurocWriter writer(settings.folder, rig.pairs.front());
  write_frames(
      flight,
      quiet,
      [&](int frame) { return flight.read_pair(frame, 0); },
      [&](int frame, const StereoImages& images) {
        writer.add({flight.stamp(frame), flight.T_scene_body(frame)}, images);
      });
  writer.finish();
}

}  // namespace

RigDescription rig_for(ExportFormat format,
                       const std::optional<RigDescription>& rig,
                       const std::string& pair) {
  if (format == ExportFormat::kSkyhalo) {
    RigDescription whole = rig ? *rig : reference_rig();
    return pair.empty() ? whole : with_one_pair(std::move(whole), pair);
  }
  if (!rig) {
    return {.name = "simulated",
            .T_body_imu = Pose::Identity(),
            .pairs = {format == ExportFormat::kEuroc ? euroc_pair() : kitti_pair()}};
  }
  std::vector<PairDescription> chosen = fitting(format, *rig, pair);
  if (chosen.empty()) {
    throw UsageError(pair.empty() ? "--rig: no pair fits this format; KITTI's needs a pinhole one"
                                  : "--pair " + pair +
                                        ": the rig has no pair of that name that fits this format");
  }
  if (chosen.size() > 1) {
    throw UsageError("this format has one pair; choose it with --pair out of " + names_of(chosen));
  }
  return {.name = rig->name, .T_body_imu = Pose::Identity(), .pairs = {chosen.front()}};
}

void export_flight(const SimulatedFlight& flight,
                   const RigDescription& rig,
                   const ExportSettings& settings,
                   bool quiet) {
  switch (settings.format) {
    case ExportFormat::kSkyhalo:
      export_own(flight, rig, settings, quiet);
      return;
    case ExportFormat::kKittiTracking:
      export_kitti(flight, settings, quiet);
      return;
    case ExportFormat::kEuroc:
      export_euroc(flight, rig, settings, quiet);
      return;
  }
}

}  // namespace skyhalo::app
