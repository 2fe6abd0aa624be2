#include "fdm/water_cells.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/error.hpp"

namespace polder::fdm {
namespace {

constexpr double kFarthestSurface = 20;  // [cells]

// Whether two sets of conditions differ only in their values, not in where they apply.
template <int D>
bool same_geometry(const WaterConditions<D>& a, const WaterConditions<D>& b) {
  const auto same_points = [](const auto& x, const auto& y) { return x.points == y.points; };
  const auto same_sheets = [](const WaterSheet<D>& x, const WaterSheet<D>& y) {
    return x.points == y.points && x.bottom == y.bottom && x.top == y.top;
  };
  if (!std::equal(a.wells.begin(), a.wells.end(), b.wells.begin(), b.wells.end(), same_points) ||
      !std::equal(a.drains.begin(), a.drains.end(), b.drains.begin(), b.drains.end(), same_points) ||
      !std::equal(a.sheets.begin(), a.sheets.end(), b.sheets.begin(), b.sheets.end(), same_sheets))
    return false;
  return std::equal(a.boundaries.begin(), a.boundaries.end(), b.boundaries.begin(), b.boundaries.end(),
                    [](const WaterBoundary<D>& x, const WaterBoundary<D>& y) {
                      return x.side == y.side && x.kind == y.kind && x.from == y.from && x.to == y.to &&
                             x.seepage_above == y.seepage_above;
                    });
}

// The nodes of a face: those corners of the cell that lie on the given side.
template <int D>
FaceNodes<D> face_nodes(const ActiveCell<D>& cell, int axis, bool upper) {
  FaceNodes<D> nodes;
  int n = 0;
  for (int corner = 0; corner < ipow(2, D); ++corner)
    if (((corner >> axis) & 1) == static_cast<int>(upper)) nodes[n++] = cell.nodes[corner];
  return nodes;
}

// Distance from a cell's centre to the surface along an axis, in cells, from the fills of the cell, of the
// one beyond it and of the one behind it. Across a surface: by volume. Along one that is but slightly
// inclined: the surface stands at fill - 1/2 above the centres, and meets the line through them where that
// falls to zero; else a column just too low to be active would draw water from its neighbour as over an edge.
// Upwards the surface is always crossed: taken for one along it, a cell that has lost a little water to the
// one above would see the surface rise, and the pressure with it, and lose more.
double surface_distance(double behind, double own, double beyond) {
  const double across = own + beyond - 0.5, drop = behind - beyond;
  const double along = std::clamp(10 * (1 - own), 0.0, 1.0) * std::clamp((0.8 - drop) / 0.3, 0.0, 1.0);
  if (along == 0) return across;
  const double meets = std::min((own - 0.5) / std::max(own - beyond, 1e-9), kFarthestSurface);
  return across + along * (meets - across);
}

}  // namespace

template <int D>
WaterCells<D>::WaterCells(const Grid<D>& grid, Space space) : grid_(grid), space_(space) {
  if ((space == Space::three_d) != (D == 3))
    throw InputError("the dimension of the pressure grid does not fit the space");
  if (space == Space::axisymmetric && grid.origin()[0] < 0)
    throw InputError("axisymmetric grid: the radius x must not be negative");
}

template <int D>
Point<D> WaterCells<D>::centre(const Index<D>& cell) const {
  Point<D> x = grid_.position(cell);
  for (double& c : x) c += 0.5 * grid_.spacing();
  return x;
}

template <int D>
double WaterCells<D>::face_area(const Index<D>& cell, int axis, bool upper) const {
  const double h = grid_.spacing();
  double area = D == 3 ? h * h : h;
  if (space_ == Space::axisymmetric) {
    const double x = grid_.position(cell)[0];
    area *= axis == 0 ? (upper ? x + h : x) : x + 0.5 * h;  // radius of the face's centre
  }
  return area;
}

template <int D>
bool WaterCells<D>::update(std::span<const double> fill, const WaterConditions<D>& conditions) {
  const int slots = grid_.slots();
  if (static_cast<int>(fill.size()) < slots)
    throw std::logic_error("WaterCells: fill does not cover the grid");
  bool changed = revision_ == 0 || !same_geometry(conditions_, conditions);
  conditions_ = conditions;

  if (grid_revision_ != grid_.revision() || static_cast<int>(eligible_.size()) != slots) {
    eligible_.assign(slots, 0);
    for (int s = 0; s < slots; ++s) {
      const Index<D> index = grid_.index(s);
      if (!grid_.is_cell(index)) continue;
      bool stored = true;
      for (int corner = 1; corner < ipow(2, D) && stored; ++corner) {
        Index<D> node = index;
        for (int d = 0; d < D; ++d) node[d] += (corner >> d) & 1;
        stored = grid_.slot(node) >= 0;
      }
      eligible_[s] = stored;
    }
    mask_.assign(slots, 0);
    grid_revision_ = grid_.revision();
    changed = true;
  }

  unsigned char differs = 0;
  for (int s = 0; s < slots; ++s) {
    const unsigned char active = eligible_[s] & static_cast<unsigned char>(fill[s] >= kActiveFill);
    differs |= active ^ mask_[s];
    mask_[s] = active;
  }
  changed = changed || differs != 0;
  if (changed) rebuild();
  refresh_distances(fill);
  return changed;
}

template <int D>
int WaterCells<D>::boundary_at(const Index<D>& cell, int side) const {
  Point<D> x = centre(cell);
  int found = -1;
  for (int b = 0; b < static_cast<int>(conditions_.boundaries.size()); ++b) {
    const WaterBoundary<D>& w = conditions_.boundaries[b];
    if (w.side != side) continue;
    bool inside = true;
    for (int d = 0; d < D; ++d) inside = inside && (d == side / 2 || (x[d] >= w.from[d] && x[d] <= w.to[d]));
    if (!inside) continue;
    if (found >= 0)
      throw InputError("water boundaries '" + conditions_.boundaries[found].name + "' and '" + w.name +
                       "' overlap on the same side of the grid");
    found = b;
  }
  return found;
}

// The condition named for a face of the soil's free surface, -1 if there is none.
template <int D>
int WaterCells<D>::surface_boundary_at(const Index<D>& cell, int axis, bool upper) const {
  Point<D> x = centre(cell);
  x[axis] += (upper ? 0.5 : -0.5) * grid_.spacing();
  for (int b = 0; b < static_cast<int>(conditions_.boundaries.size()); ++b) {
    const WaterBoundary<D>& w = conditions_.boundaries[b];
    bool inside = w.side == kFreeSurface;
    for (int d = 0; d < D; ++d) inside = inside && x[d] >= w.from[d] && x[d] <= w.to[d];
    if (inside) return b;
  }
  return -1;
}

template <int D>
bool WaterCells<D>::is_open_surface(const Index<D>& cell, int side) const {
  const int b = boundary_at(cell, side);
  return b >= 0 && conditions_.boundaries[b].kind == WaterBoundary<D>::Kind::surface;
}

template <int D>
void WaterCells<D>::add_boundary_face(int cell, int axis, bool upper, int outside, int boundary,
                                      bool free_surface) {
  ActiveCell<D>& c = cells_[cell];
  const double area = c.areas[2 * axis + upper];
  if (area <= 0) return;  // the axis of symmetry
  c.faces[2 * axis + upper] = static_cast<int>(interior_.size() + boundary_.size());
  boundary_.push_back({.cell = cell,
                       .axis = axis,
                       .outward = upper ? 1 : -1,
                       .nodes = face_nodes<D>(c, axis, upper),
                       .area = area,
                       .outside = outside,
                       .boundary = boundary,
                       .free_surface = free_surface,
                       .distance = 0.5 * grid_.spacing(),
                       .pressure = 0,
                       .open = true});
}

template <int D>
void WaterCells<D>::rebuild() {
  ++revision_;
  cells_.clear();
  interior_.clear();
  boundary_.clear();
  number_.assign(grid_.slots(), -1);
  for (int s = 0; s < grid_.slots(); ++s) {
    if (!mask_[s]) continue;
    ActiveCell<D> c{.slot = s, .index = grid_.index(s), .nodes = {}, .faces = {}, .areas = {}, .volume = 0};
    c.faces.fill(-1);
    for (int side = 0; side < 2 * D; ++side) c.areas[side] = face_area(c.index, side / 2, side % 2);
    for (int corner = 0; corner < ipow(2, D); ++corner) {
      Index<D> node = c.index;
      for (int d = 0; d < D; ++d) node[d] += (corner >> d) & 1;
      c.nodes[corner] = grid_.slot(node);
    }
    // The faces across the last axis have the area of the cell's plan (in axisymmetry at the centre's
    // radius).
    c.volume = c.areas[2 * D - 1] * grid_.spacing();
    number_[s] = static_cast<int>(cells_.size());
    cells_.push_back(c);
  }

  for (int low = 0; low < count(); ++low)
    for (int axis = 0; axis < D; ++axis) {
      Index<D> beyond = cells_[low].index;
      if (++beyond[axis] >= grid_.cells()[axis]) continue;
      const int slot = grid_.slot(beyond);
      const int high = slot < 0 ? -1 : number_[slot];
      if (high < 0) continue;
      const int face = static_cast<int>(interior_.size());
      cells_[low].faces[2 * axis + 1] = face;
      cells_[high].faces[2 * axis] = face;
      interior_.push_back({.low = low,
                           .high = high,
                           .axis = axis,
                           .nodes = face_nodes<D>(cells_[low], axis, true),
                           .area = cells_[low].areas[2 * axis + 1]});
    }

  for (int cell = 0; cell < count(); ++cell)
    for (int side = 0; side < 2 * D; ++side) {
      const int axis = side / 2;
      const bool upper = side % 2;
      if (cells_[cell].faces[side] >= 0) continue;
      Index<D> beyond = cells_[cell].index;
      beyond[axis] += upper ? 1 : -1;
      if (grid_.is_cell(beyond)) {
        add_boundary_face(cell, axis, upper, grid_.slot(beyond),
                          surface_boundary_at(cells_[cell].index, axis, upper), true);
        continue;
      }
      const int boundary = boundary_at(cells_[cell].index, side);
      if (boundary >= 0 && conditions_.boundaries[boundary].kind != WaterBoundary<D>::Kind::impermeable)
        add_boundary_face(cell, axis, upper, -1, boundary, false);
    }
}

template <int D>
void WaterCells<D>::refresh_distances(std::span<const double> fill) {
  using Kind = typename WaterBoundary<D>::Kind;
  const double h = grid_.spacing();
  for (BoundaryFace<D>& f : boundary_) {
    const ActiveCell<D>& c = cells_[f.cell];
    double height = grid_.origin()[D - 1] + (c.index[D - 1] + 0.5) * h;  // where the pressure is prescribed
    const Kind kind = f.boundary < 0 ? Kind::surface : conditions_.boundaries[f.boundary].kind;
    const double value = f.boundary < 0 ? 0 : conditions_.boundaries[f.boundary].value;
    if (kind == Kind::surface || f.free_surface) {
      const double own = std::min(fill[c.slot], 1.0),
                   beyond = f.outside < 0 ? 0 : std::min(fill[f.outside], 1.0);
      f.distance = h * (own + beyond - 0.5);
      if (inclined_surfaces_ && f.axis != D - 1) {
        Index<D> behind = c.index;
        behind[f.axis] -= f.outward;
        const int slot = grid_.is_cell(behind) ? grid_.slot(behind) : -1;
        f.distance = h * surface_distance(slot < 0 ? own : std::min(fill[slot], 1.0), own, beyond);
      }
    }
    if (f.axis == D - 1) height += f.outward * f.distance;
    switch (kind) {
      case Kind::surface:
      case Kind::atmosphere:
        f.pressure = std::max(0.0, conditions_.unit_weight * (conditions_.outside_level - height));
        break;
      case Kind::head:
        f.open = value >= height;
        f.pressure = f.open ? conditions_.unit_weight * (value - height) : 0;
        break;
      case Kind::impermeable:
      case Kind::flux:
        f.open = false;
        break;
      case Kind::pressure:
        f.pressure = value;
    }
  }
}

template class WaterCells<2>;
template class WaterCells<3>;

}  // namespace polder::fdm
