#pragma once

#include <filesystem>
#include <string_view>

namespace skyhalo {

/// Throws `Error` (input) naming the file when a YAML, JSON or XML text may be nested deeper than
/// 100 levels, or holds more than 10000 lists, maps and tags. What calls itself for each
/// level, as OpenCV's parser does, would overflow the stack.
///
/// The depth is counted without regard to quotes and comments, in which closing brackets may hide;
/// what the parser then meets is bounded by the number of opening ones. Internal to this layer.
void refuse_deep_nesting(const std::filesystem::path& file, std::string_view text);

}  // namespace skyhalo
