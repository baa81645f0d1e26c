#pragma once

#include <filesystem>

namespace skyhalo {

/// Whether a file or folder is there. Throws `Error` (input) naming it where that cannot be told,
/// as in a folder that may not be read. Internal to this layer, as all of this header.
[[nodiscard]] bool is_there(const std::filesystem::path& path);

/// Whether it is there and a folder. Throws as `is_there` does.
[[nodiscard]] bool is_folder(const std::filesystem::path& path);

}  // namespace skyhalo
