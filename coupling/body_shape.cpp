#include "coupling/body_shape.hpp"

#include <algorithm>
#include <cmath>

namespace polder::coupling {

BodyShape::BodyShape(const Body& body, const GridSpec& grid)
    : body_(body), up_(grid.space == Space::three_d ? 2 : 1) {
  const int dimension = up_ + 1;
  if (body.box) {
    lower_ = (*body.box)[0], upper_ = (*body.box)[1];
  } else if (body.centre) {
    for (int d = 0; d < dimension; ++d)
      lower_[d] = (*body.centre)[d] - body.radius, upper_[d] = (*body.centre)[d] + body.radius;
  } else {
    Vector3 low = body.polygon.front(), high = low;
    for (const Vector3& x : body.polygon)
      for (int d = 0; d < 2; ++d) low[d] = std::min(low[d], x[d]), high[d] = std::max(high[d], x[d]);
    lower_[0] = low[0], upper_[0] = high[0];
    lower_[up_] = low[1], upper_[up_] = high[1];
    if (prism()) {
      lower_[1] = body.extrude ? (*body.extrude)[0] : grid.origin[1];
      upper_[1] = body.extrude ? (*body.extrude)[1] : grid.origin[1] + grid.size[1];
    }
  }
}

bool BodyShape::inside(const Vector3& x) const {
  if (body_.box) {
    for (int d = 0; d <= up_; ++d)
      if (x[d] < lower_[d] || x[d] > upper_[d]) return false;
    return true;
  }
  if (body_.centre) {
    double r = 0;
    for (int d = 0; d <= up_; ++d) r += (x[d] - (*body_.centre)[d]) * (x[d] - (*body_.centre)[d]);
    return r <= body_.radius * body_.radius;
  }
  if (prism() && (x[1] < lower_[1] || x[1] > upper_[1])) return false;
  bool in = false;  // crossings of a horizontal ray
  const auto& p = body_.polygon;
  const double z = x[up_];
  for (std::size_t i = 0, j = p.size() - 1; i < p.size(); j = i++)
    if ((p[i][1] > z) != (p[j][1] > z) &&
        x[0] < p[j][0] + (z - p[j][1]) * (p[i][0] - p[j][0]) / (p[i][1] - p[j][1]))
      in = !in;
  return in;
}

Vector3 BodyShape::centroid() const {
  if (body_.centre) return *body_.centre;
  if (body_.box) {
    Vector3 c{};
    for (int d = 0; d < 3; ++d) c[d] = 0.5 * (lower_[d] + upper_[d]);
    return c;
  }
  double area = 0, cx = 0, cy = 0;
  const auto& p = body_.polygon;
  for (std::size_t i = 0, j = p.size() - 1; i < p.size(); j = i++) {
    const double cross = p[j][0] * p[i][1] - p[i][0] * p[j][1];
    area += cross, cx += cross * (p[j][0] + p[i][0]), cy += cross * (p[j][1] + p[i][1]);
  }
  if (prism()) return {cx / (3 * area), 0.5 * (lower_[1] + upper_[1]), cy / (3 * area)};
  return {cx / (3 * area), cy / (3 * area), 0};
}

std::vector<std::pair<double, double>> BodyShape::vertical_intervals(const Vector3& x) const {
  if (body_.box) {
    for (int d = 0; d < up_; ++d)
      if (x[d] < lower_[d] || x[d] > upper_[d]) return {};
    return {{lower_[up_], upper_[up_]}};
  }
  if (body_.centre) {
    double r = body_.radius * body_.radius;
    for (int d = 0; d < up_; ++d) r -= (x[d] - (*body_.centre)[d]) * (x[d] - (*body_.centre)[d]);
    if (r <= 0) return {};
    const double c = (*body_.centre)[up_], half = std::sqrt(r);
    return {{c - half, c + half}};
  }
  if (prism() && (x[1] < lower_[1] || x[1] > upper_[1])) return {};
  std::vector<double> cuts;
  const auto& p = body_.polygon;
  for (std::size_t i = 0, j = p.size() - 1; i < p.size(); j = i++)
    if ((p[i][0] > x[0]) != (p[j][0] > x[0]))
      cuts.push_back(p[j][1] + (x[0] - p[j][0]) * (p[i][1] - p[j][1]) / (p[i][0] - p[j][0]));
  std::sort(cuts.begin(), cuts.end());
  std::vector<std::pair<double, double>> all;
  for (std::size_t i = 0; i + 1 < cuts.size(); i += 2) all.emplace_back(cuts[i], cuts[i + 1]);
  return all;
}

double height_at(const std::vector<Vector3>& line, double x) {
  if (x <= line.front()[0]) return line.front()[1];
  for (std::size_t i = 1; i < line.size(); ++i)
    if (x <= line[i][0]) {
      const double s = (x - line[i - 1][0]) / (line[i][0] - line[i - 1][0]);
      return line[i - 1][1] + s * (line[i][1] - line[i - 1][1]);
    }
  return line.back()[1];
}

}  // namespace polder::coupling
