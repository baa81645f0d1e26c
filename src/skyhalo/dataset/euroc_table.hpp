#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "skyhalo/base/timestamp.hpp"

namespace skyhalo {

/// A line of a EuRoC (ASL) `data.csv`.
struct EurocRow {
  int line = 0;  ///< in the file, from 1
  Timestamp stamp;
  std::vector<std::string> fields;  ///< what follows the stamp, without blanks around
};

/// Reads a EuRoC (ASL) `data.csv`: a time stamp in whole nanoseconds since 1970 and `fields` more
/// per line, separated by commas. Lines that are empty or start with `#` are passed over; lines may
/// end the Windows way. Throws `Error` (input) with file and line for another number of fields, for
/// stamps that do not grow from line to line, and for a file without data.
[[nodiscard]] std::vector<EurocRow> read_euroc_table(const std::filesystem::path& file,
                                                     std::size_t fields);

}  // namespace skyhalo
