#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace skyhalo {

/// A row of numbers and the line (from 1) that it was read from.
struct NumberRow {
  std::vector<double> values;
  int line = 0;
};

/// The numbers of a text file: with a header the columns have names and commas between them,
/// without one there are spaces.
struct NumberTable {
  std::vector<std::string> columns;  ///< empty without a header
  std::vector<NumberRow> rows;
  int header_line = 0;
};

/// What a file may hold.
struct TableLayout {
  std::vector<std::string_view> names;  ///< of columns that a header may have, each once
  std::size_t columns = 0;              ///< the number of values in a row without a header
};

/// Reads a table. A first line that does not begin with a number is the header; empty lines and
/// those that begin with `#` are left out; numbers are finite. Throws `Error` (input) with file
/// and line.
[[nodiscard]] NumberTable read_number_table(const std::filesystem::path& file,
                                            const TableLayout& layout);

}  // namespace skyhalo
