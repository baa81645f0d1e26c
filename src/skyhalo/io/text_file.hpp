#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace skyhalo {

/// A file's bytes. Throws `Error` (input) naming the file when it cannot be read.
[[nodiscard]] std::string read_bytes(const std::filesystem::path& file);

/// A text file's lines without their ends (Unix or Windows). Throws as `read_bytes` does.
[[nodiscard]] std::vector<std::string> read_lines(const std::filesystem::path& file);

/// The words of a line, separated by blanks or tabs; views into the line.
[[nodiscard]] std::vector<std::string_view> split_words(std::string_view line);

/// A finite number that fills the whole word; none for anything else, NaN and infinity included.
[[nodiscard]] std::optional<double> parse_number(std::string_view word) noexcept;

/// A whole number that fills the whole word and fits an int.
[[nodiscard]] std::optional<int> parse_whole_number(std::string_view word) noexcept;

}  // namespace skyhalo
