#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "skyhalo/calibration/rig_description.hpp"

namespace skyhalo {

/// A rig file and what looks odd in it but can be used.
struct RigFile {
  RigDescription description;
  std::vector<std::string> warnings;
};

/// Reads a rig file (YAML; see docs/rigs.md and `kRigSchema`). Throws `Error` (input) with file,
/// line and key for what is missing, unknown, malformed or outside its domain.
[[nodiscard]] RigFile read_rig_file(const std::filesystem::path& file);

/// The same for the text of a rig file; complaints call it `name`.
[[nodiscard]] RigFile parse_rig(std::string_view text, const std::filesystem::path& name);

/// The rig of a file, ready for use. Throws as `read_rig_file` and `resolve` do, with file, line
/// and key.
[[nodiscard]] StereoRig load_rig(const std::filesystem::path& file);

/// A rig as a YAML file; `read_rig_file` reads it back to the last bit. `head` is put in front as a
/// comment, line by line.
[[nodiscard]] std::string to_yaml(const RigDescription& rig, std::string_view head);

/// The JSON Schema of rig files, for editors.
extern const std::string_view kRigSchema;

}  // namespace skyhalo
