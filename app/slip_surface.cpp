#include "app/slip_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace polder::app {
namespace {

using Point = std::array<double, 2>;

constexpr double kMoves =
    0.2;  // share of the largest displacement (but for a hundredth of the points) that moves

double quantile(std::vector<double> values, double share) {
  const auto n = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + n, values.end());
  return values[static_cast<std::size_t>(n)];
}

// Means over cells; a value sits at the cell's centre.
class CellField {
 public:
  CellField(std::span<const double> positions, std::span<const double> values, double cell) : cell_(cell) {
    const std::size_t n = values.size();
    Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()},
        high{-low[0], -low[1]};
    for (std::size_t p = 0; p < n; ++p)
      for (int d = 0; d < 2; ++d) {
        low[d] = std::min(low[d], positions[3 * p + d]);
        high[d] = std::max(high[d], positions[3 * p + d]);
      }
    for (int d = 0; d < 2; ++d) {
      first_[d] = static_cast<long>(std::floor(low[d] / cell));
      count_[d] = static_cast<long>(std::floor(high[d] / cell)) - first_[d] + 1;
    }
    sum_.assign(static_cast<std::size_t>(count_[0] * count_[1]), 0.0);
    number_.assign(sum_.size(), 0);
    for (std::size_t p = 0; p < n; ++p) {
      const std::size_t at = index(static_cast<long>(std::floor(positions[3 * p] / cell)) - first_[0],
                                   static_cast<long>(std::floor(positions[3 * p + 1] / cell)) - first_[1]);
      sum_[at] += values[p], ++number_[at];
    }
  }

  long count(int axis) const { return count_[axis]; }
  bool filled(long i, long j) const {
    return i >= 0 && j >= 0 && i < count_[0] && j < count_[1] && number_[index(i, j)] > 0;
  }
  bool filled(const Point& x) const {
    return filled(static_cast<long>(std::floor(x[0] / cell_)) - first_[0],
                  static_cast<long>(std::floor(x[1] / cell_)) - first_[1]);
  }
  double value(long i, long j) const { return sum_[index(i, j)] / number_[index(i, j)]; }
  Point centre(long i, long j) const {
    return {cell_ * (static_cast<double>(i + first_[0]) + 0.5),
            cell_ * (static_cast<double>(j + first_[1]) + 0.5)};
  }

 private:
  std::size_t index(long i, long j) const { return static_cast<std::size_t>(j * count_[0] + i); }
  double cell_;
  std::array<long, 2> first_{}, count_{};
  std::vector<double> sum_;
  std::vector<int> number_;
};

// Edges of the lattice of cell centres: from (i, j) along an axis.
using Edge = std::array<long, 3>;

// Lines of a level by marching squares, with their corners on edges; the longest one.
std::vector<Point> longest_contour(const CellField& field, double level) {
  std::map<Edge, Point> corner;
  std::map<Edge, std::vector<Edge>> next;
  const auto crossing = [&](long i, long j, int axis) -> std::optional<Edge> {
    const long k = i + (axis == 0), l = j + (axis == 1);
    const double a = field.value(i, j) - level, b = field.value(k, l) - level;
    if ((a > 0) == (b > 0)) return std::nullopt;
    const Point from = field.centre(i, j), to = field.centre(k, l);
    const double t = a / (a - b);
    const Edge edge{i, j, axis};
    corner[edge] = {from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])};
    return edge;
  };
  for (long j = 0; j + 1 < field.count(1); ++j)
    for (long i = 0; i + 1 < field.count(0); ++i) {
      if (!field.filled(i, j) || !field.filled(i + 1, j) || !field.filled(i, j + 1) ||
          !field.filled(i + 1, j + 1))
        continue;
      std::vector<Edge> found;
      for (const auto& e :
           {crossing(i, j, 0), crossing(i + 1, j, 1), crossing(i, j + 1, 0), crossing(i, j, 1)})
        if (e) found.push_back(*e);
      for (std::size_t k = 0; k + 1 < found.size(); k += 2)
        next[found[k]].push_back(found[k + 1]), next[found[k + 1]].push_back(found[k]);
    }

  std::vector<Point> longest;
  double most = 0;
  std::map<Edge, bool> seen;
  // Open lines from their ends first, then closed ones.
  for (const bool open : {true, false})
    for (const auto& [start, links] : next) {
      if (seen[start] || (open && links.size() != 1)) continue;
      std::vector<Point> line;
      double length = 0;
      for (std::optional<Edge> at = start; at;) {
        seen[*at] = true;
        const Point x = corner[*at];
        if (!line.empty()) length += std::hypot(x[0] - line.back()[0], x[1] - line.back()[1]);
        line.push_back(x);
        std::optional<Edge> following;
        for (const Edge& e : next[*at])
          if (!seen[e]) following = e;
        at = following;
      }
      if (length > most) most = length, longest = std::move(line);
    }
  return longest;
}

// From the end of a line straight on until no soil is there.
Point prolonged(const std::vector<Point>& line, bool at_front, const CellField& field, double cell) {
  const std::size_t n = line.size(), reach = std::min<std::size_t>(n - 1, 4);
  const Point end = at_front ? line.front() : line.back(),
              inner = at_front ? line[reach] : line[n - 1 - reach];
  const double length = std::hypot(end[0] - inner[0], end[1] - inner[1]);
  if (!(length > 0)) return end;
  const Point step{0.1 * cell * (end[0] - inner[0]) / length, 0.1 * cell * (end[1] - inner[1]) / length};
  Point x = end;
  for (int i = 0; i < 30 && field.filled(x); ++i) x = {x[0] + step[0], x[1] + step[1]};
  return x;
}

}  // namespace

SlipSurface find_slip_surface(std::span<const double> positions, std::span<const double> displacement,
                              std::span<const double> area, double cell) {
  SlipSurface result;
  if (displacement.empty()) return result;
  const double most = quantile({displacement.begin(), displacement.end()}, 0.99);
  std::vector<double> moving;
  for (const double d : displacement)
    if (d > kMoves * most) moving.push_back(d);
  if (!(most > 0) || moving.empty()) return result;
  result.displacement = quantile(moving, 0.5);
  const double level = 0.5 * result.displacement;
  for (std::size_t p = 0; p < displacement.size(); ++p)
    if (displacement[p] > level) result.area += area[p];
  const CellField field(positions, displacement, cell);
  result.line = longest_contour(field, level);
  if (result.line.size() < 2) return result;
  const Point front = prolonged(result.line, true, field, cell),
              back = prolonged(result.line, false, field, cell);
  result.line.insert(result.line.begin(), front);
  result.line.push_back(back);
  if (result.line.front()[1] < result.line.back()[1]) std::reverse(result.line.begin(), result.line.end());
  return result;
}

}  // namespace polder::app
