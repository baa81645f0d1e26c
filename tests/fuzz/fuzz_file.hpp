#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo::fuzz {

/// Hands the bytes to `read(file)` as a file. An `Error` is what bad input should give; anything
/// else ends the fuzzer.
template <class Read>
int as_file(const std::uint8_t* bytes, std::size_t size, const Read& read) {
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("skyhalo-fuzz-" + std::to_string(::getpid()));
  {
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  }
  try {
    read(file);
  } catch (const Error&) {
    return 0;
  }
  return 0;
}

}  // namespace skyhalo::fuzz
