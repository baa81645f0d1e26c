#include <iterator>

#include "fuzz_file.hpp"
#include "skyhalo/calibration/calibration_import.hpp"
#include "skyhalo/calibration/rig_check.hpp"

// The first byte chooses the format, the rest is the file. Formats of a file for each camera get it
// twice.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using skyhalo::CalibrationFormat;
  constexpr CalibrationFormat kFormats[] = {CalibrationFormat::kAuto,
                                            CalibrationFormat::kKalibr,
                                            CalibrationFormat::kEuroc,
                                            CalibrationFormat::kOpencv,
                                            CalibrationFormat::kRos,
                                            CalibrationFormat::kBasalt,
                                            CalibrationFormat::kKittiRaw,
                                            CalibrationFormat::kKittiTracking};
  if (size == 0) {
    return 0;
  }
  const CalibrationFormat format = kFormats[bytes[0] % std::size(kFormats)];
  return skyhalo::fuzz::as_file(bytes + 1, size - 1, [&](const std::filesystem::path& file) {
    const bool two = format == CalibrationFormat::kEuroc || format == CalibrationFormat::kRos;
    const skyhalo::ImportResult imported = skyhalo::import_calibration(
        two ? std::vector{file, file} : std::vector{file},
        {.format = format, .mounting = {}, .size_px = cv::Size(640, 480), .name = ""});
    (void)skyhalo::check_rig(imported.rig, {});
    (void)skyhalo::resolve(imported.rig);
  });
}
