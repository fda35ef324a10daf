// Gives memory that is not needed any more back to the system, where it takes some.  Only hints.
#pragma once

#include <cstddef>
#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace dm {

// What stages have freed: the C library keeps it otherwise.
inline void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

// The first `bytes` of a large block, whose content is lost; rounded down to whole large pages.
inline void return_front([[maybe_unused]] void* block, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  constexpr std::uintptr_t large = std::uintptr_t{1} << 21;
  const auto begin = (reinterpret_cast<std::uintptr_t>(block) + large - 1) / large * large;
  const auto end = (reinterpret_cast<std::uintptr_t>(block) + bytes) / large * large;
  if (end > begin) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
#endif
}

}  // namespace dm
