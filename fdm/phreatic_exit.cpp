#include "fdm/phreatic_exit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "fdm/boundary_flow.hpp"
#include "fdm/flow_results.hpp"

namespace polder::fdm {
namespace {

constexpr double kSteepest = 89.8 * std::numbers::pi / 180;  // the law of a vertical face is its limit

// Direction of the free surface against the face where f has the modulus m there, dn/ds.
double bend(double slope, double m) {
  const double theta = 0.5 * std::numbers::pi - slope, c = std::cos(theta), s = std::sin(theta);
  const double square = 1 - 2 * m * c + m * m;  // |1 - f|^2
  const double across = std::cos(slope) * m * (c - m);
  const double along = std::sin(slope) * square - std::cos(slope) * m * s;
  return across / along;
}

// Gauss-Laguerre, eight points.
constexpr std::array<double, 8> kPoint{0.17027963230510100, 0.90370177679937991, 2.2510866298661307,
                                       4.2667001702876588,  7.0459054023934657,  10.758516010180995,
                                       15.740678641278005,  22.863131736889264};
constexpr std::array<double, 8> kWeight{0.36918858934163753,   0.41878678081434296,   0.17579498663717181,
                                        0.033343492261215652,  0.0027945362352256725, 9.0765087733582131e-5,
                                        8.4857467162725315e-7, 1.0480011748715104e-9};

// Distance of the surface from the face over R, at the distance s = R exp(-y) from the end:
// n/R = integral of dn/ds over s/R = e^-y integral of dn/ds(y + t) e^-t dt.
double surface_distance(double slope, double y) {
  const double exponent = 0.5 - slope / std::numbers::pi;
  double sum = 0;
  for (std::size_t i = 0; i < kPoint.size(); ++i)
    sum += kWeight[i] * bend(slope, std::exp(-exponent * (y + kPoint[i])));
  return std::exp(-y) * sum;
}

struct Line {
  Point<2> point{}, up{}, inward{};
  double slope = 0;
};

// Through the ends of the rows (or columns) of soil near the row of the given face.
std::optional<Line> fit_face(const WaterCells<2>& cells, const BoundaryFace<2>& at) {
  constexpr int kRows = 3;  // on either side
  const double h = cells.grid().spacing();
  const Index<2> centre = cells.cells()[at.cell].index;
  std::vector<Point<2>> ends, tops;
  Point<2> here{};
  for (const BoundaryFace<2>& f : cells.boundary_faces()) {
    const Index<2> i = cells.cells()[f.cell].index;
    Point<2> x = cells.centre(i);
    x[f.axis] += f.outward * f.distance;
    if (&f == &at) here = x;
    if (f.axis == 0 && f.outward == at.outward && std::abs(i[1] - centre[1]) <= kRows) ends.push_back(x);
    if (f.axis == 1 && f.outward > 0) tops.push_back(x);
  }
  // x = a + b z through the ends of rows; several in one row: the one near.
  const auto fit = [](const std::vector<Point<2>>& points, int over) -> std::optional<std::array<double, 2>> {
    double n = 0, s = 0, t = 0, ss = 0, st = 0;
    for (const Point<2>& p : points) {
      n += 1, s += p[over], t += p[1 - over];
      ss += p[over] * p[over], st += p[over] * p[1 - over];
    }
    const double spread = n * ss - s * s;
    if (!(spread > 1e-9 * n * ss)) return {};
    const double b = (n * st - s * t) / spread;
    return std::array{(t - b * s) / n, b};
  };
  // A row is no further out than a flat slope would be.
  std::erase_if(ends, [&](const Point<2>& p) {
    return std::abs(p[0] - here[0]) > 8 * (std::abs(p[1] - here[1]) + 0.5 * h);
  });
  const auto across = fit(ends, 1);
  if (!across) return {};
  Line line;
  double run = (*across)[1];  // dx/dz
  line.point = {(*across)[0] + run * here[1], here[1]};
  if (std::abs(run) > 1) {  // flat: the tops of columns are where the surface is known
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Point<2>& p : ends) low = std::min(low, p[0]), high = std::max(high, p[0]);
    std::erase_if(tops, [&](const Point<2>& p) {
      return p[0] < low || p[0] > high ||
             std::abs(p[0] - line.point[0] - run * (p[1] - here[1])) > 2 * h * std::abs(run);
    });
    const auto upwards = fit(tops, 0);
    if (upwards && (*upwards)[1] * run > 0) {
      run = 1 / (*upwards)[1];
      line.point = {here[0], (*upwards)[0] + (*upwards)[1] * here[0]};
    }
  }
  if (run * at.outward > 1e-3) return {};  // overhanging
  line.slope = std::atan2(1.0, std::abs(run));
  line.up = {run * std::sin(line.slope), std::sin(line.slope)};
  line.inward = {-at.outward * line.up[1], at.outward * line.up[0]};
  return line;
}

// Standing water on a face: its level [m], or none.
double level_at(const BoundaryFace<2>& f, const WaterConditions<2>& conditions) {
  const WaterBoundary<2>* named = f.boundary < 0 ? nullptr : &conditions.boundaries[f.boundary];
  return named && named->kind == WaterBoundary<2>::Kind::head ? named->value : conditions.outside_level;
}

// Whether water may leave through the face above what stands there.
bool seeps(const BoundaryFace<2>& f, const WaterConditions<2>& conditions) {
  using Kind = WaterBoundary<2>::Kind;
  if (f.boundary < 0) return true;
  const WaterBoundary<2>& named = conditions.boundaries[f.boundary];
  return named.kind == Kind::surface || named.kind == Kind::atmosphere ||
         (named.kind == Kind::head && named.seepage_above);
}

double dot(const Point<2>& a, const Point<2>& b) {
  return a[0] * b[0] + a[1] * b[1];
}

}  // namespace

double detail::distance_along(double slope, double length_scale, double distance) {
  slope = std::min(slope, kSteepest);
  const double exponent = 0.5 - slope / std::numbers::pi, goal = distance / length_scale;
  // The law ends where |f| reaches cos theta: the water comes to rest.
  double low = -std::log(std::sin(slope)) / exponent, high = low + 1;
  if (surface_distance(slope, low) < goal) return -1;
  while (surface_distance(slope, high) > goal) high += high - low;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (surface_distance(slope, middle) > goal ? low : high) = middle;
  }
  return length_scale * std::exp(-0.5 * (low + high));
}

double detail::distance_to_end(double slope, double n1, double n2, double apart) {
  // The larger R, the further the feet are apart.
  const auto excess = [&](double log_scale) {
    const double s1 = distance_along(slope, std::exp(log_scale), n1);
    const double s2 = distance_along(slope, std::exp(log_scale), n2);
    return s2 < 0 ? -std::numeric_limits<double>::infinity() : s2 - s1 - apart;
  };
  double low = std::log(1e-3 * n1), high = std::log(n2) + 25;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0 ? low : high) = middle;
  }
  return distance_along(slope, std::exp(high), n1);
}

std::vector<PhreaticExit> phreatic_exits(const WaterCells<2>& cells, std::span<const double> pressure) {
  // From the face: nearer cells are smeared by its steps, further ones belong to the flow as a whole.
  constexpr double kNear = 1.25, kApart = 0.5, kFar = 8;
  const double h = cells.grid().spacing(), weight = cells.conditions().unit_weight;
  const std::vector<std::pair<double, double>> line = phreatic_line(cells, pressure);
  std::vector<PhreaticExit> exits;
  for (const int direction : {-1, 1}) {
    const BoundaryFace<2>* last = nullptr;  // the highest that lets water out above the level
    for (const BoundaryFace<2>& f : cells.boundary_faces()) {
      if (f.axis != 0 || f.outward != direction || !seeps(f, cells.conditions())) continue;
      const ActiveCell<2>& c = cells.cells()[f.cell];
      const double below = weight * (level_at(f, cells.conditions()) - cells.centre(c.index)[1]);
      if (pressure[c.slot] <= std::max(0.0, below)) continue;
      if (!last || c.index[1] > cells.cells()[last->cell].index[1]) last = &f;
    }
    if (!last) continue;
    const double level = level_at(*last, cells.conditions());
    PhreaticExit exit;
    exit.boundary = last->boundary;
    exit.direction = direction;
    exit.place = cells.centre(cells.cells()[last->cell].index);
    exit.place[0] += direction * last->distance;
    if (const std::optional<Line> face = fit_face(cells, *last)) {
      exit.slope = face->slope;
      struct Foot {
        double distance, along;
      };
      std::vector<Foot> feet;
      for (const auto& [x, z] : line) {
        const Point<2> from{x - face->point[0], z - face->point[1]};
        const Foot foot{dot(from, face->inward), dot(from, face->up)};
        if (foot.distance >= kNear * h && foot.distance <= kFar * h && std::abs(foot.along) < 4 * kFar * h)
          feet.push_back(foot);
      }
      std::sort(feet.begin(), feet.end(),
                [](const Foot& a, const Foot& b) { return a.distance < b.distance; });
      const auto second = std::find_if(feet.begin(), feet.end(), [&](const Foot& f) {
        return f.distance >= feet.front().distance + kApart * h;
      });
      if (second != feet.end()) {
        const Foot& first = feet.front();
        const double back = detail::distance_to_end(face->slope, first.distance, second->distance,
                                                    second->along - first.along);
        const double along = first.along - back;
        exit.place = {face->point[0] + along * face->up[0], face->point[1] + along * face->up[1]};
        exit.found = true;
      }
    }
    if (exit.place[1] < level) {  // the phreatic line ends at the water
      exit.place[0] += (level - exit.place[1]) / std::tan(std::max(exit.slope, 0.01)) * -direction;
      exit.place[1] = level;
    }
    exits.push_back(exit);
  }
  return exits;
}

}  // namespace polder::fdm
