// What a step takes apart from arithmetic, counted: memory that is allocated, sorts, iterations of the
// pressure solver. Ranges hold on any machine.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "core/threads.hpp"
#include "tests/counters/small_scenes.hpp"

namespace {

long allocations = 0;  // of this program so far; one thread

void* counted(std::size_t bytes, std::size_t alignment) {
  ++allocations;
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  void* p = std::aligned_alloc(alignment, whole > 0 ? whole : alignment);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}

// Allocations of each of the steps behind the first few, which fill work space.
std::vector<long> allocations_of(const std::string& name, long steps) {
  constexpr long kWarm = 20;
  std::vector<long> at;
  at.reserve(kWarm + steps + 1);
  polder::set_threads(1);
  polder::counters::make_steps(*polder::counters::find_small_scene(name), kWarm + steps,
                               [&](long) { at.push_back(allocations); });
  std::vector<long> each;
  for (std::size_t i = kWarm; i + 1 < at.size(); ++i) each.push_back(at[i + 1] - at[i]);
  return each;
}

}  // namespace

void* operator new(std::size_t n) {
  return counted(n, 16);
}
void* operator new(std::size_t n, std::align_val_t a) {
  return counted(n, static_cast<std::size_t>(a));
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

TEST_CASE("a dry step allocates nothing, but when it sorts") {
  for (const std::string name : {"dry-2d", "dry-3d", "flip-2d", "tpic-3d"}) {
    CAPTURE(name);
    long with = 0;
    for (long n : allocations_of(name, 200)) with += n > 0;
    CHECK(with <= 2);  // sorts: the slab has moved by less than two skins
  }
}

TEST_CASE("most steps with water allocate nothing either") {
  for (const std::string name : {"one-layer-2d", "two-layer-2d"}) {
    CAPTURE(name);
    std::vector<long> each = allocations_of(name, 100);
    std::sort(each.begin(), each.end());
    CHECK(each[each.size() * 3 / 4] == 0);
    CHECK(each.back() <= 8);  // those that look for newly wet soil or take back drift
  }
}
