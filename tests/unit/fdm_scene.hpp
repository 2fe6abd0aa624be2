// A grid with all blocks stored, its water cells and pressure, filled from functions of position, with the
// soil of unsaturated flow besides: for the tests of fdm.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "fdm/pressure_field.hpp"
#include "fdm/unsaturated_field.hpp"
#include "tests/unit/random.hpp"

namespace polder::fdm::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kGamma = 9810;  // of water [N/m3]

template <int D>
struct Scene {
  using At = std::function<double(const Point<D>&)>;

  Grid<D> grid;
  WaterCells<D> cells;
  WaterConditions<D> conditions;
  std::vector<double> fill, porosity, darcy_mobility, mobility, velocity;

  Scene(Point<D> origin, Index<D> size, double h, Space space = D == 3 ? Space::three_d : Space::plane_strain)
      : grid(origin, size, h), cells(grid, space) {
    std::vector<int> all(grid.block_numbers());
    for (int b = 0; b < grid.block_numbers(); ++b) all[b] = b;
    grid.activate(all);
    fill.assign(grid.slots(), 0);
    porosity.assign(grid.slots(), 0.4);
    darcy_mobility.assign(grid.slots(), 0);
    mobility.assign(grid.slots(), 0);
    velocity.assign(grid.slots() * 4, 0);
  }

  Point<D> centre(int slot) const { return cells.centre(grid.index(slot)); }

  // Soil up to the height `top` along the last axis.
  void fill_below(double top) {
    fill_cells([&](const Point<D>& x) {
      return std::min(1.0, std::max(0.0, (top - x[D - 1]) / grid.spacing() + 0.5));
    });
  }
  void fill_cells(const At& f) {
    for (int s = 0; s < grid.slots(); ++s) fill[s] = grid.is_cell(grid.index(s)) ? f(centre(s)) : 0;
  }
  void cells_to(std::vector<double>& field, const At& f) {
    for (int s = 0; s < grid.slots(); ++s) field[s] = f(centre(s));
  }
  void nodes_to(std::vector<double>& field, const At& f) {
    for (int s = 0; s < grid.slots(); ++s) field[s] = f(grid.position(grid.index(s)));
  }
  void velocity_to(const std::function<Point<D>(const Point<D>&)>& f) {
    for (int s = 0; s < grid.slots(); ++s) {
      const Point<D> v = f(grid.position(grid.index(s)));
      for (int d = 0; d < D; ++d) velocity[s * 4 + d] = v[d];
    }
  }
  PressureStep step(double dt, double chi = 0.05) const {
    return {dt, velocity, mobility, porosity, darcy_mobility, chi};
  }
};

// With what unsaturated flow asks for: soil 0 everywhere, and how much of it counts to a cell.
template <int D>
struct UnsaturatedScene : Scene<D> {
  std::vector<int> soil;
  std::vector<double> fraction, compressibility;

  UnsaturatedScene(Point<D> origin, Index<D> size, double h,
                   Space space = D == 3 ? Space::three_d : Space::plane_strain)
      : Scene<D>(origin, size, h, space), soil(this->grid.slots(), 0), fraction(this->grid.slots(), 1) {}

  // Conductivity [m/s] everywhere.
  void set_conductivity(double k) {
    this->cells_to(this->darcy_mobility, [&](const auto&) { return k / kGamma; });
  }
  // Takes up fill and conditions.
  void update() {
    this->cells.update(this->fill, this->conditions);
    soil_fraction<D>(this->cells, this->fill, fraction);
  }
  UnsaturatedStep unsaturated(double dt) const {
    return {.dt = dt,
            .porosity = this->porosity,
            .volume_fraction = fraction,
            .darcy_mobility = this->darcy_mobility,
            .soil = soil,
            .skeleton_compressibility = compressibility};
  }
};

template <int D>
Soil<D> van_genuchten(double alpha = 2, double n = 2, double residual = 0.1) {
  Soil<D> s;
  s.retention.model = Retention::Model::van_genuchten;
  s.retention.alpha = alpha, s.retention.n = n, s.retention.residual = residual;
  return s;
}

inline WaterProperties<2> water2(double bulk_modulus = kInfinity, double g = -9.81) {
  return {.density = 1000, .bulk_modulus = bulk_modulus, .gravity = {0, g}};
}
inline WaterProperties<3> water3(double bulk_modulus = kInfinity, double g = -9.81) {
  return {.density = 1000, .bulk_modulus = bulk_modulus, .gravity = {0, 0, g}};
}
template <int D>
WaterProperties<D> water(double bulk_modulus = kInfinity, double g = -9.81) {
  if constexpr (D == 2)
    return water2(bulk_modulus, g);
  else
    return water3(bulk_modulus, g);
}

template <int D>
WaterBoundary<D> boundary(typename WaterBoundary<D>::Kind kind, int side, double value) {
  WaterBoundary<D> b;
  b.name = "side " + std::to_string(side);
  b.kind = kind;
  b.side = side;
  b.value = value;
  return b;
}

// A trapezoidal levee on its foundation: 2 : 1 slopes, crest of a tenth of the width.
inline bool in_levee(double x, double y) {  // both in units of the width, 0.45 high
  if (y < 0.15) return true;
  return y < 0.45 && std::abs(x - 0.5) < 0.05 + 0.75 * (0.45 - y);
}

}  // namespace polder::fdm::test
