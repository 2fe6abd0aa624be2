// Arrays aligned to a cache line, so that packs load and store without crossing one.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace polder {

inline constexpr std::size_t kAlignment = 64;

// Arrays of many huge pages start on one and ask for them: kernels walk dozens of arrays at a time, and the
// translation of addresses is then what costs, above all on virtual machines.
inline constexpr std::size_t kHugePage = std::size_t{1} << 21;

inline std::size_t alignment_of(std::size_t bytes) {
  return bytes < 2 * kHugePage ? kAlignment : kHugePage;
}
void ask_for_huge_pages(void* start, std::size_t bytes);  // advice: nothing happens where there are none

template <class T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}
  T* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(T);
    void* p = ::operator new (bytes, std::align_val_t{alignment_of(bytes)});
    if (alignment_of(bytes) == kHugePage) ask_for_huge_pages(p, bytes);
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t n) {
    ::operator delete (p, std::align_val_t{alignment_of(n * sizeof(T))});
  }
  template <class U>
  bool operator==(const AlignedAllocator<U>&) const {
    return true;
  }
};

using Reals = std::vector<double, AlignedAllocator<double>>;

}  // namespace polder
