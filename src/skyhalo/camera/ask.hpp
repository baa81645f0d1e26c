#pragma once

#include <cstddef>
#include <utility>
#include <variant>

namespace skyhalo {

/// `question(alternative)` of what a variant holds, which is all that `std::visit` does, but
/// without its throw for a variant that holds nothing: ours are copied only from whole ones.
template <std::size_t kIndex = 0, class Question, class... Alternatives>
[[nodiscard]] decltype(auto) ask(const std::variant<Alternatives...>& variant,
                                 Question&& question) noexcept {
  if constexpr (kIndex + 1 < sizeof...(Alternatives)) {
    if (const auto* alternative = std::get_if<kIndex>(&variant)) {
      return question(*alternative);
    }
    return ask<kIndex + 1>(variant, std::forward<Question>(question));
  } else {
    return question(*std::get_if<kIndex>(&variant));
  }
}

}  // namespace skyhalo
