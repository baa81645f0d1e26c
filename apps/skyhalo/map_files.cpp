#include "map_files.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <system_error>
#include <utility>

#include "common_options.hpp"
#include "interrupt.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/io/map_points.hpp"
#include "skyhalo/io/octomap_file.hpp"
#include "skyhalo/io/pcd.hpp"
#include "skyhalo/io/ply.hpp"
#include "skyhalo/io/skymap_file.hpp"
#include "skyhalo/io/text_file.hpp"
#include "skyhalo/io/tile_files.hpp"
#include "skyhalo/io/unfinished_file.hpp"

namespace skyhalo::app {
namespace {

struct Extension {
  std::string_view text;
  MapFormat format;
};

constexpr std::array kExtensions{Extension{".skymap", MapFormat::kSkymap},
                                 Extension{".ot", MapFormat::kOctomapFull},
                                 Extension{".bt", MapFormat::kOctomapBinary},
                                 Extension{".ply", MapFormat::kPly},
                                 Extension{".pcd", MapFormat::kPcd},
                                 Extension{".png", MapFormat::kSlice},
                                 Extension{".yaml", MapFormat::kSlice}};

HeightRange parse_slice(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::optional<double> low = parse_number(std::string_view(text).substr(0, colon));
  const std::optional<double> high = colon == std::string::npos
                                         ? std::nullopt
                                         : parse_number(std::string_view(text).substr(colon + 1));
  if (!low || !high || *low > *high) {
    throw UsageError("--slice " + text +
                     ": expected Z0:Z1, two heights in metres, for instance 0.5:1.5");
  }
  return {*low, *high};
}

/// Writes points to a file that appears when it is whole.
template <class Write, class Points>
void write_points(const std::filesystem::path& file, const Write& write, const Points& points) {
  UnfinishedFile unfinished(file);
  write(unfinished.path(), points);
  stop_if_interrupted();
  unfinished.commit();
}

}  // namespace

std::optional<MapFormat> format_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  const auto* const found =
      std::find_if(kExtensions.begin(), kExtensions.end(), [&](const Extension& candidate) {
        return candidate.text == extension;
      });
  return found == kExtensions.end() ? std::nullopt : std::optional(found->format);
}

std::string name_of(MapFormat format) {
  switch (format) {
    case MapFormat::kSkymap:
      return "skymap";
    case MapFormat::kOctomapFull:
      return "octomap with log odds";
    case MapFormat::kOctomapBinary:
      return "octomap without log odds";
    case MapFormat::kPly:
    case MapFormat::kPcd:
      return "points";
    case MapFormat::kTiles:
      return "tiles";
    case MapFormat::kSlice:
      break;
  }
  return "slice";
}

LoadedMap read_map(const std::filesystem::path& file,
                   std::uint64_t max_bytes,
                   const Progress& progress) {
  if (std::error_code ignored; std::filesystem::is_directory(file, ignored)) {
    Skymap read = read_tiles(file, max_bytes, progress);
    return {std::move(read.map), MapFormat::kTiles, read.info.limit_units};
  }
  const std::optional<MapFormat> format = format_of(file);
  if (!format) {
    throw input_error(file,
                      "has no extension of a map; expected .skymap, .ot, .bt or a folder of tiles");
  }
  if (*format == MapFormat::kSkymap) {
    Skymap read = read_skymap(file, max_bytes, progress);
    return {std::move(read.map), *format, read.info.limit_units};
  }
  if (*format == MapFormat::kOctomapFull || *format == MapFormat::kOctomapBinary) {
    const bool binary = *format == MapFormat::kOctomapBinary;
    return {read_octomap(file, binary ? OctreeForm::kBinary : OctreeForm::kFull, max_bytes),
            *format,
            std::nullopt};
  }
  throw input_error(file,
                    "is a picture of a map (" + name_of(*format) +
                        "), which cannot be read back; expected .skymap, .ot or .bt");
}

std::uint64_t file_bytes(const std::filesystem::path& map) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(map, ignored)) {
    return std::filesystem::file_size(map, ignored);
  }
  std::uint64_t bytes = 0;
  for (const Tile& tile : tiles_in(map)) {
    bytes += std::filesystem::file_size(map / tile_file_name(tile));
  }
  return bytes;
}

MapOutput parse_output(const std::string& file, const std::string& slice) {
  const std::optional<MapFormat> format = format_of(file);
  if (!format) {
    throw UsageError(file +
                     ": expected an extension of .skymap, .ot, .bt, .ply, .pcd, .png or .yaml");
  }
  const bool is_slice = *format == MapFormat::kSlice;
  if (is_slice && slice.empty()) {
    throw UsageError(file + ": is a slice of a map, expected --slice Z0:Z1");
  }
  if (!is_slice && !slice.empty()) {
    throw UsageError("--slice: " + file + " is no slice, expected .png or .yaml");
  }
  return {.file = file,
          .format = *format,
          .slice = is_slice ? std::optional(parse_slice(slice)) : std::nullopt,
          .rule = {}};
}

void write_map(const MapOutput& output,
               const SparseMap& map,
               int limit_units,
               const Progress& progress) {
  stop_if_interrupted();
  switch (output.format) {
    case MapFormat::kTiles:  // no output is one: a folder has no extension
      return;
    case MapFormat::kSkymap:
      write_skymap(output.file, map, {.limit_units = limit_units}, progress);
      return;
    case MapFormat::kOctomapFull:
      write_octomap(output.file, map, OctreeForm::kFull);
      return;
    case MapFormat::kOctomapBinary:
      write_octomap(output.file, map, OctreeForm::kBinary);
      return;
    case MapFormat::kPly:
      write_points(output.file, write_ply, coloured_by_height(occupied_points(map, output.rule)));
      return;
    case MapFormat::kPcd:
      write_points(output.file, write_pcd, occupied_points(map, output.rule));
      return;
    case MapFormat::kSlice:
      std::filesystem::path png = output.file;
      write_slice(png.replace_extension(".png"),
                  slice_of(map, output.slice.value_or(HeightRange{}), output.rule));
      return;
  }
}

}  // namespace skyhalo::app
