// A growing array of plain values whose new elements are not initialised: growing a large block lets the
// system move its pages, and no page is touched before it is used.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <type_traits>
#include <utility>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace dm {

// Asks for the cache line of an address.
inline void prefetch([[maybe_unused]] const void* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#endif
}

template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Array() = default;
  Array(const Array& other) {
    resize(other.size_);
    std::copy_n(other.data_, size_, data_);
  }
  Array(Array&& other) noexcept { swap(other); }
  Array& operator=(Array other) noexcept {
    swap(other);
    return *this;
  }
  ~Array() { std::free(data_); }
  void swap(Array& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }

  std::size_t size() const { return size_; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T& operator[](std::ptrdiff_t i) { return data_[i]; }
  const T& operator[](std::ptrdiff_t i) const { return data_[i]; }

  void resize(std::size_t size) {
    if (size == 0) {
      std::free(data_);
      data_ = nullptr;
    } else {
      void* moved = std::realloc(static_cast<void*>(data_), size * sizeof(T));
      if (!moved) throw std::bad_alloc();
      data_ = static_cast<T*>(moved);
      prefer_large_pages(size * sizeof(T));
    }
    size_ = size;
  }

 private:
  void prefer_large_pages([[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr std::size_t large = std::size_t{1} << 21, page = 4096;
    if (bytes < 8 * large) return;
    const auto begin = (reinterpret_cast<std::size_t>(data_) + page - 1) / page * page;
    const auto end = (reinterpret_cast<std::size_t>(data_) + bytes) / page * page;
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // only a hint
#endif
  }
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace dm
