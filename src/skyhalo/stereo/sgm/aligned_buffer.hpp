#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>

namespace skyhalo::sgm {

/// Zeroed memory of a fixed number of plain values, aligned for the widest vectors.
template <class T>
class AlignedBuffer {
 public:
  static constexpr std::size_t kAlignment = 256;

  AlignedBuffer() = default;

  explicit AlignedBuffer(std::size_t size)
      : data_(static_cast<T*>(::operator new (size * sizeof(T), std::align_val_t{kAlignment}))),
        size_(size) {
    clear();
  }

  void clear() noexcept { std::memset(data_.get(), 0, size_ * sizeof(T)); }

  [[nodiscard]] T* data() noexcept { return data_.get(); }

  [[nodiscard]] const T* data() const noexcept { return data_.get(); }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }

 private:
  struct Free {
    void operator()(T* data) const noexcept {
      ::operator delete (data, std::align_val_t{kAlignment});
    }
  };

  std::unique_ptr<T[], Free> data_;  // NOLINT(*-avoid-c-arrays): a block of plain values
  std::size_t size_ = 0;
};

}  // namespace skyhalo::sgm
