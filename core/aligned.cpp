#include "core/aligned.hpp"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace polder {

void ask_for_huge_pages([[maybe_unused]] void* start, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  madvise(start, bytes, MADV_HUGEPAGE);
#endif
}

}  // namespace polder
