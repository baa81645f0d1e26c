#pragma once

namespace skyhalo::testing {

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SKYHALO_TESTS_ARE_SANITISED
#endif
#endif

/// So many rounds of a random test, or a quarter of them, one at least, where a sanitiser makes
/// each many times slower.
constexpr int rounds(int count) {
#ifdef SKYHALO_TESTS_ARE_SANITISED
  return (count + 3) / 4;
#else
  return count;
#endif
}

}  // namespace skyhalo::testing
