#pragma once

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

namespace skyhalo::sgm {

/// Memory aligned for the widest vectors.
template <class T>
struct AlignedAllocator {
  using value_type = T;  // NOLINT(readability-identifier-naming): the standard's name

  static constexpr std::size_t kAlignment = 256;

  AlignedAllocator() = default;

  template <class Other>
  explicit AlignedAllocator(const AlignedAllocator<Other>& /*other*/) noexcept {}

  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{kAlignment}));
  }

  void deallocate(T* memory, std::size_t /*count*/) noexcept {
    ::operator delete (memory, std::align_val_t{kAlignment});
  }

  bool operator==(const AlignedAllocator& /*other*/) const noexcept { return true; }
};

/// A fixed number of plain values, zero at first, aligned for the widest vectors.
template <class T>
class AlignedBuffer {
 public:
  static constexpr std::size_t kAlignment = AlignedAllocator<T>::kAlignment;

  AlignedBuffer() = default;

  explicit AlignedBuffer(std::size_t size) : values_(size) {}

  void clear() noexcept { std::fill(values_.begin(), values_.end(), T{}); }

  [[nodiscard]] T* data() noexcept { return values_.data(); }

  [[nodiscard]] const T* data() const noexcept { return values_.data(); }

  [[nodiscard]] std::size_t size() const noexcept { return values_.size(); }

 private:
  std::vector<T, AlignedAllocator<T>> values_;
};

}  // namespace skyhalo::sgm
