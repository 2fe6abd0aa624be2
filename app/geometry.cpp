#include "app/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace polder::app {
namespace {

using coupling::Body;
using coupling::Vector3;

constexpr int kDiskCorners = 128;

double cross(const Vector3& o, const Vector3& a, const Vector3& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

double length(const Vector3& a, const Vector3& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}

double distance_to_edge(const Vector3& a, const Vector3& b, double x, double y) {
  const double dx = b[0] - a[0], dy = b[1] - a[1];
  const double square = dx * dx + dy * dy;
  const double t = square > 0 ? std::clamp(((x - a[0]) * dx + (y - a[1]) * dy) / square, 0.0, 1.0) : 0;
  return std::hypot(x - a[0] - t * dx, y - a[1] - t * dy);
}

// Whether two segments have a point in common, touching included.
bool meet(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  // Lines closer than this, relative to the segments' lengths, count as touching: coordinates are decimal
  // numbers.
  const double tolerance = 1e-12 * (length(a, b) + length(c, d)) * std::max(length(a, b), length(c, d));
  const auto side = [tolerance](double value) { return value > tolerance ? 1 : value < -tolerance ? -1 : 0; };
  const int c1 = side(cross(a, b, c)), d1 = side(cross(a, b, d));
  const int a2 = side(cross(c, d, a)), b2 = side(cross(c, d, b));
  if (c1 * d1 > 0 || a2 * b2 > 0) return false;
  if (c1 != 0 || d1 != 0 || a2 != 0 || b2 != 0) return true;
  // On one line: do their extents meet along both axes?
  for (std::size_t i = 0; i < 2; ++i)
    if (std::max(a[i], b[i]) < std::min(c[i], d[i]) || std::max(c[i], d[i]) < std::min(a[i], b[i]))
      return false;
  return true;
}

// Where the horizontal line at y crosses the polygon, sorted: inside between the first and second, third and
// fourth ...
std::vector<double> crossings(const Polygon& p, double y) {
  std::vector<double> x;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vector3 &a = p[i], &b = p[(i + 1) % p.size()];
    if ((a[1] <= y) == (b[1] <= y)) continue;
    x.push_back(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
  }
  std::sort(x.begin(), x.end());
  return x;
}

// Length that two sets of intervals share.
double shared_length(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < a.size(); i += 2)
    for (std::size_t j = 0; j + 1 < b.size(); j += 2)
      sum += std::max(0.0, std::min(a[i + 1], b[j + 1]) - std::max(a[i], b[j]));
  return sum;
}

bool is_inside(const Polygon& p, double x, double y) {
  const std::vector<double> c = crossings(p, y);
  for (std::size_t i = 0; i + 1 < c.size(); i += 2)
    if (x >= c[i] && x <= c[i + 1]) return true;
  return false;
}

// Where a prism begins and ends along y.
std::array<double, 2> depth_of(const Body& body) {
  return body.extrude.value_or(std::array<double, 2>{});
}

// Whether a position of a lattice start + (i + 1/2) spacing lies in [from, to].
bool lattice_hits(double start, double spacing, double from, double to) {
  const double first = std::ceil((from - start) / spacing - 0.5);
  return start + (first + 0.5) * spacing <= to;
}

}  // namespace

double signed_area(const Polygon& p) {
  double twice = 0;
  for (std::size_t i = 0; i < p.size(); ++i) twice += cross(p.front(), p[i], p[(i + 1) % p.size()]);
  return twice / 2;
}

std::optional<std::pair<std::size_t, std::size_t>> crossing_edges(const Polygon& p) {
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3 &a = p[i], &b = p[(i + 1) % n], &after = p[(i + 2) % n];
    const double fold = cross(a, b, after);
    const double along = (b[0] - a[0]) * (after[0] - b[0]) + (b[1] - a[1]) * (after[1] - b[1]);
    if (std::abs(fold) <= 1e-12 * length(a, b) * length(b, after) && along < 0) return {{i, (i + 1) % n}};
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (meet(a, b, p[j], p[(j + 1) % n])) return {{i, j}};
    }
  }
  return std::nullopt;
}

double overlap_area(const Polygon& a, const Polygon& b) {
  std::vector<double> heights;
  for (const Polygon* p : {&a, &b})
    for (const Vector3& v : *p) heights.push_back(v[1]);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) {
      const Vector3 &a0 = a[i], &a1 = a[(i + 1) % a.size()], &b0 = b[j], &b1 = b[(j + 1) % b.size()];
      const double c0 = cross(b0, b1, a0), c1 = cross(b0, b1, a1);
      if (c0 * c1 < 0) heights.push_back(a0[1] + c0 / (c0 - c1) * (a1[1] - a0[1]));
    }
  std::sort(heights.begin(), heights.end());
  double area = 0;
  for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
    const double height = heights[i + 1] - heights[i];
    if (height <= 0) continue;
    // Inside a slab all edges are straight and none cross, so the shared length is linear in height.
    const double middle = heights[i] + height / 2;
    area += height * shared_length(crossings(a, middle), crossings(b, middle));
  }
  return area;
}

double distance(const Polygon& p, double x, double y) {
  if (is_inside(p, x, y)) return 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < p.size(); ++i)
    nearest = std::min(nearest, distance_to_edge(p[i], p[(i + 1) % p.size()], x, y));
  return nearest;
}

Polygon outline(const Body& body, int dimension) {
  if (body.box) {
    const auto& [l, u] = *body.box;
    const auto up = static_cast<std::size_t>(dimension) - 1;
    return {{l[0], l[up], 0}, {u[0], l[up], 0}, {u[0], u[up], 0}, {l[0], u[up], 0}};
  }
  if (!body.centre) return body.polygon;
  Polygon p;
  for (int i = 0; i < kDiskCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDiskCorners;
    p.push_back({(*body.centre)[0] + body.radius * std::cos(angle),
                 (*body.centre)[1] + body.radius * std::sin(angle), 0});
  }
  return p;
}

Extent extent_of(const Polygon& polygon) {
  Extent e{polygon.front(), polygon.front()};
  for (const Vector3& v : polygon)
    for (std::size_t i = 0; i < 2; ++i) {
      e.lower[i] = std::min(e.lower[i], v[i]);
      e.upper[i] = std::max(e.upper[i], v[i]);
    }
  return e;
}

Extent extent(const Body& body, int dimension) {
  if (body.box) return {(*body.box)[0], (*body.box)[1]};
  Extent e;
  const auto axes = static_cast<std::size_t>(dimension);
  if (body.centre) {
    for (std::size_t i = 0; i < axes; ++i) {
      e.lower[i] = (*body.centre)[i] - body.radius;
      e.upper[i] = (*body.centre)[i] + body.radius;
    }
    return e;
  }
  e = extent_of(body.polygon);
  if (dimension == 2) return e;
  const auto [begin, end] = depth_of(body);
  return {{e.lower[0], begin, e.lower[1]}, {e.upper[0], end, e.upper[1]}};
}

double measure(const Body& body, int dimension) {
  if (body.box) {
    double m = 1;
    for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i)
      m *= (*body.box)[1][i] - (*body.box)[0][i];
    return m;
  }
  if (body.centre)
    return dimension == 3 ? 4.0 / 3.0 * std::numbers::pi * std::pow(body.radius, 3)
                          : std::numbers::pi * body.radius * body.radius;
  const auto [begin, end] = depth_of(body);
  return std::abs(signed_area(body.polygon)) * (dimension == 3 ? end - begin : 1);
}

double overlap(const Body& a, const Body& b, int dimension) {
  const Extent ea = extent(a, dimension), eb = extent(b, dimension);
  double common = 1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i) {
    const double shared = std::min(ea.upper[i], eb.upper[i]) - std::max(ea.lower[i], eb.lower[i]);
    if (shared <= 0) return 0;
    common *= shared;
  }
  if (dimension == 2) {
    if (a.centre && b.centre && length(*a.centre, *b.centre) >= a.radius + b.radius) return 0;
    return overlap_area(outline(a, 2), outline(b, 2));
  }
  if (a.box && b.box) return common;
  if (!a.centre && !b.centre) {
    const double shared = std::min(ea.upper[1], eb.upper[1]) - std::max(ea.lower[1], eb.lower[1]);
    return shared * overlap_area(outline(a, 3), outline(b, 3));
  }
  const Body& ball = a.centre ? a : b;
  const Body& other = a.centre ? b : a;
  return distance(other, *ball.centre, dimension) < ball.radius ? 1 : 0;
}

double distance(const Body& body, const Vector3& point, int dimension) {
  const auto axes = static_cast<std::size_t>(dimension);
  if (body.centre || body.box) {
    double square = 0;
    for (std::size_t i = 0; i < axes; ++i) {
      double d = 0;
      if (body.centre)
        d = point[i] - (*body.centre)[i];
      else
        d = std::max({0.0, (*body.box)[0][i] - point[i], point[i] - (*body.box)[1][i]});
      square += d * d;
    }
    return body.centre ? std::max(0.0, std::sqrt(square) - body.radius) : std::sqrt(square);
  }
  if (dimension == 2) return distance(body.polygon, point[0], point[1]);
  const auto [begin, end] = depth_of(body);
  return std::hypot(distance(body.polygon, point[0], point[2]),
                    std::max({0.0, begin - point[1], point[1] - end}));
}

bool holds_a_particle(const Body& body, const coupling::GridSpec& grid, int dimension) {
  const double spacing = grid.cell / body.particles_per_axis;
  const Extent e = extent(body, dimension);
  if (body.box) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i)
      if (!lattice_hits(grid.origin[i], spacing, e.lower[i], e.upper[i])) return false;
    return true;
  }
  // With so many rows of particles the body holds one, or its size is refused elsewhere.
  constexpr double kManyRows = 1e6;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i)
    if (!body.box && (e.upper[i] - e.lower[i]) / spacing > kManyRows) return true;
  const auto rows = [&](std::size_t axis, const auto& visit) {
    const double first = std::ceil((e.lower[axis] - grid.origin[axis]) / spacing - 0.5);
    for (double i = first;; ++i) {
      const double at = grid.origin[axis] + (i + 0.5) * spacing;
      if (at > e.upper[axis]) return false;
      if (visit(at)) return true;
    }
  };
  // Half of the chord of a circle at a distance from its centre; negative outside.
  const auto chord = [](double radius, double away) {
    return radius > std::abs(away) ? std::sqrt(radius * radius - away * away) : -1.0;
  };
  if (body.centre && dimension == 3)
    return rows(2, [&](double z) {
      const double circle = chord(body.radius, z - (*body.centre)[2]);
      return rows(1, [&](double y) {
        const double half = chord(circle, y - (*body.centre)[1]);
        return half > 0 &&
               lattice_hits(grid.origin[0], spacing, (*body.centre)[0] - half, (*body.centre)[0] + half);
      });
    });
  if (body.centre)
    return rows(1, [&](double y) {
      const double half = chord(body.radius, y - (*body.centre)[1]);
      return half > 0 &&
             lattice_hits(grid.origin[0], spacing, (*body.centre)[0] - half, (*body.centre)[0] + half);
    });
  // A prism is filled along its length from end to end: one particle at least.
  return rows(static_cast<std::size_t>(dimension) - 1, [&](double y) {
    const std::vector<double> c = crossings(body.polygon, y);
    for (std::size_t i = 0; i + 1 < c.size(); i += 2)
      if (lattice_hits(grid.origin[0], spacing, c[i], c[i + 1])) return true;
    return false;
  });
}

}  // namespace polder::app
