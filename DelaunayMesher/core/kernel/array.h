// A growing array of plain values whose new elements are not initialised: a large block grows by the system
// moving its pages, is given back to it as soon as it is freed, and no page is touched before it is used.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
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

// realloc() for a block of known size, nullptr for 0 bytes.  The C library's would copy blocks of up to 32 MB
// from place to place in its heap, holding both for a while.
inline void* resize_block(void* block, std::size_t before, std::size_t after) {
  if (after == before) return block;
  void* moved = nullptr;
#ifdef __linux__
  constexpr std::size_t large = std::size_t{1} << 20;
  if (before >= large || after >= large) {
    if (before >= large && after >= large)
      moved = mremap(block, before, after, MREMAP_MAYMOVE);
    else if (after >= large)
      moved = mmap(nullptr, after, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    else if (after > 0)
      moved = std::malloc(after);
    if (moved == MAP_FAILED || (after > 0 && !moved)) throw std::bad_alloc();
    if ((before >= large) == (after >= large)) return moved;
    if (before > 0 && after > 0) std::memcpy(moved, block, std::min(before, after));
    if (before >= large)
      munmap(block, before);
    else
      std::free(block);
    return moved;
  }
#endif
  if (after == 0) return std::free(block), nullptr;
  moved = std::realloc(block, after);
  if (!moved) throw std::bad_alloc();
  return moved;
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
  ~Array() { resize(0); }
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
    data_ = static_cast<T*>(resize_block(data_, size_ * sizeof(T), size * sizeof(T)));
    size_ = size;
    prefer_large_pages(size * sizeof(T));
  }

 private:
  void prefer_large_pages([[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr std::size_t large = std::size_t{1} << 21, page = 4096;
    if (bytes < 8 * large) return;
    // The whole mapping (a block of this size begins with a page), as mremap() moves no part of one.
    madvise(static_cast<void*>(data_), (bytes + page - 1) / page * page, MADV_HUGEPAGE);  // only a hint
#endif
  }
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace dm
