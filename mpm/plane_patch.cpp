#include "mpm/plane_patch.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace polder::mpm {
namespace {

constexpr double kSame = 1e-9;  // vertices this close together, as a share of a piece, are one

Point<3> minus(const Point<3>& a, const Point<3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Point<3>& a, const Point<3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point<3> cross(const Point<3>& a, const Point<3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point<3> unit(const Point<3>& a) {
  const double length = std::sqrt(dot(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

double plane_area(const std::vector<Point<2>>& p) {
  double twice = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point<2>&a = p[i], &b = p[(i + 1) % p.size()];
    twice += (a[0] - p[0][0]) * (b[1] - p[0][1]) - (a[1] - p[0][1]) * (b[0] - p[0][0]);
  }
  return twice / 2;
}

// The part of a polygon with sign * (coordinate along axis - at) <= 0 (Sutherland & Hodgman 1974).
std::vector<Point<2>> cut_at(const std::vector<Point<2>>& polygon, int axis, double at, double sign) {
  std::vector<Point<2>> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point<2>&a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a[axis] - at), db = sign * (b[axis] - at);
    if (da <= 0) kept.push_back(a);
    if (da * db < 0) {
      const double s = da / (da - db);
      Point<2> x{a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])};
      x[axis] = at;
      kept.push_back(x);
    }
  }
  return kept;
}

}  // namespace

PlanePatch::PlanePatch(const std::vector<Point<3>>& corners) : origin_(corners.front()) {
  normal_ = unit(vector_area(corners));
  Point<3> along = minus(corners[1], corners[0]);
  const double off = dot(along, normal_);
  for (int d = 0; d < 3; ++d) along[d] -= off * normal_[d];
  axes_[0] = unit(along);
  axes_[1] = cross(normal_, axes_[0]);
  for (const Point<3>& x : corners) corners_.push_back(project(x));
}

double PlanePatch::area() const {
  return plane_area(corners_);
}

Point<2> PlanePatch::project(const Point<3>& x) const {
  const Point<3> r = minus(x, origin_);
  return {dot(r, axes_[0]), dot(r, axes_[1])};
}

double PlanePatch::height(const Point<3>& x) const {
  return dot(minus(x, origin_), normal_);
}

Point<3> PlanePatch::position(const Point<2>& uv) const {
  Point<3> x = origin_;
  for (int d = 0; d < 3; ++d) x[d] += uv[0] * axes_[0][d] + uv[1] * axes_[1][d];
  return x;
}

bool PlanePatch::contains(const Point<2>& x, double tolerance) const {
  bool in = false;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Point<2>&a = corners_[i], &b = corners_[(i + 1) % corners_.size()];
    const double du = b[0] - a[0], dv = b[1] - a[1], square = du * du + dv * dv;
    const double t =
        square > 0 ? std::clamp(((x[0] - a[0]) * du + (x[1] - a[1]) * dv) / square, 0.0, 1.0) : 0.0;
    if (std::hypot(x[0] - a[0] - t * du, x[1] - a[1] - t * dv) <= tolerance) return true;
    // Crossings of the ray along u.
    if ((a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (x[1] - a[1]) / dv * du) in = !in;
  }
  return in;
}

Point<3> vector_area(const std::vector<Point<3>>& corners) {
  Point<3> sum{};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Point<3> c = cross(minus(corners[i], corners[0]), minus(corners[i + 1], corners[0]));
    for (int d = 0; d < 3; ++d) sum[d] += 0.5 * c[d];
  }
  return sum;
}

PatchPieces cut_patch(const std::vector<Point<2>>& polygon, double size) {
  Point<2> lower = polygon.front(), upper = polygon.front();
  for (const Point<2>& x : polygon)
    for (int d = 0; d < 2; ++d) lower[d] = std::min(lower[d], x[d]), upper[d] = std::max(upper[d], x[d]);
  int count[2];
  double step[2];
  for (int d = 0; d < 2; ++d) {
    count[d] = std::max(1, static_cast<int>(std::ceil((upper[d] - lower[d]) / size - 1e-9)));
    step[d] = (upper[d] - lower[d]) / count[d];
  }
  PatchPieces result;
  std::map<std::array<long long, 2>, int> known;
  const auto vertex = [&](const Point<2>& x) {
    std::array<long long, 2> key;
    for (int d = 0; d < 2; ++d) key[d] = std::llround((x[d] - lower[d]) / (kSame * step[d]));
    for (long long du = -1; du <= 1; ++du)  // rounding may fall on either side
      for (long long dv = -1; dv <= 1; ++dv)
        if (const auto found = known.find({key[0] + du, key[1] + dv}); found != known.end())
          return found->second;
    const int number = static_cast<int>(result.vertices.size());
    known.emplace(key, number);
    result.vertices.push_back(x);
    return number;
  };
  const auto line = [&](int d, int i) { return i == count[d] ? upper[d] : lower[d] + i * step[d]; };
  for (int j = 0; j < count[1]; ++j) {
    std::vector<Point<2>> row = cut_at(polygon, 1, line(1, j), -1);
    row = cut_at(row, 1, line(1, j + 1), 1);
    for (int i = 0; i < count[0] && !row.empty(); ++i) {
      std::vector<Point<2>> cell = cut_at(row, 0, line(0, i), -1);
      cell = cut_at(cell, 0, line(0, i + 1), 1);
      if (cell.size() < 3 || !(plane_area(cell) > kSame * step[0] * step[1])) continue;
      std::vector<int> piece;
      for (const Point<2>& x : cell) {
        const int v = vertex(x);
        if (piece.empty() || piece.back() != v) piece.push_back(v);
      }
      while (piece.size() > 1 && piece.front() == piece.back()) piece.pop_back();
      if (piece.size() >= 3) result.pieces.push_back(std::move(piece));
    }
  }
  return result;
}

}  // namespace polder::mpm
