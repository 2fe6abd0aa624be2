#include "bench/front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace polder::bench {

std::vector<std::size_t> front(const std::vector<Cost>& all) {
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t i) { return std::isnan(all[i].error); });
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return all[a].seconds != all[b].seconds ? all[a].seconds < all[b].seconds : all[a].error < all[b].error;
  });
  std::vector<std::size_t> kept;
  for (const std::size_t i : order)
    if (kept.empty() || all[i].error < all[kept.back()].error) kept.push_back(i);
  return kept;
}

double seconds_to_reach(const std::vector<Cost>& all, double error) {
  double least = std::numeric_limits<double>::infinity();
  for (const Cost& c : all)
    if (c.error <= error) least = std::min(least, c.seconds);
  return least;
}

double cost_over_best(const std::vector<Cost>& some, const std::vector<Cost>& all) {
  double sum = 0;
  const std::vector<std::size_t> own = front(some);
  for (const std::size_t i : own) sum += std::log(some[i].seconds / seconds_to_reach(all, some[i].error));
  return own.empty() ? std::nan("") : std::exp(sum / static_cast<double>(own.size()));
}

}  // namespace polder::bench
