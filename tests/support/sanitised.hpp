#pragma once

namespace skyhalo::testing {

/// Whether a sanitiser takes memory and time of its own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitised = true;
#elif !defined(__has_feature)
inline constexpr bool kSanitised = false;
#elif __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kSanitised = true;
#else
inline constexpr bool kSanitised = false;
#endif

/// So many rounds of a random test, or a quarter of them, one at least, where a sanitiser makes
/// each many times slower.
constexpr int rounds(int count) {
  return kSanitised ? (count + 3) / 4 : count;
}

}  // namespace skyhalo::testing
