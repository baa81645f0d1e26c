#include "fuzz_file.hpp"
#include "skyhalo/calibration/rig_check.hpp"
#include "skyhalo/calibration/rig_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return skyhalo::fuzz::as_file(bytes, size, [](const std::filesystem::path& file) {
    const skyhalo::RigFile rig = skyhalo::read_rig_file(file);
    (void)skyhalo::check_rig(rig.description, {});
    (void)skyhalo::to_yaml(rig.description, "");
    (void)skyhalo::resolve(rig.description);
    (void)skyhalo::load_rig(file);
  });
}
