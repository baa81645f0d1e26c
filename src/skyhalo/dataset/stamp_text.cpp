#include "skyhalo/dataset/stamp_text.hpp"

#include <charconv>
#include <cstdint>
#include <system_error>

namespace skyhalo {

std::string stamp_text(Timestamp stamp) {
  return std::to_string(stamp.time_since_epoch().count());
}

std::optional<Timestamp> parse_stamp(std::string_view text) noexcept {
  std::int64_t stamp_ns = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), stamp_ns);
  if (status != std::errc() || end != text.data() + text.size() || stamp_ns < 0) {
    return std::nullopt;
  }
  return Timestamp(std::chrono::nanoseconds(stamp_ns));
}

}  // namespace skyhalo
