#include "bench/slab_scene.hpp"

#include <cmath>

namespace polder::bench {
namespace {

constexpr double kCell = 0.1;      // [m]
constexpr double kDensity = 1800;  // of the dry soil [kg/m3]
constexpr double kPorosity = 0.4;
constexpr double kGravity = 9.81;

coupling::Material soil(const Slab& slab, double height) {
  coupling::Material m;
  m.name = "soil";
  m.density_solid = kDensity / (1 - kPorosity);
  m.porosity = kPorosity;
  m.young = 2e7;
  m.poisson = 0.3;
  m.hydraulic_conductivity = 1e-4;
  if (!slab.plastic) return m;
  m.model = mpm::MaterialModel::mohr_coulomb;
  m.friction.value = {std::asin(0.5)};
  m.dilation.value = {std::asin(0.1)};
  // a hundredth of what the slab's own weight needs
  const double cohesion = 0.01 * kDensity * kGravity * height;
  m.cohesion.value = {cohesion};
  if (slab.softening) {
    m.cohesion.kind = mpm::Mobilised::Kind::exponential;
    m.cohesion.peak = cohesion, m.cohesion.residual = 0.1 * cohesion, m.cohesion.rate = 30;
  }
  return m;
}

}  // namespace

coupling::Scene make_scene(const Slab& slab) {
  const bool space = slab.dimension == 3;
  const double per_cell = space ? 8 : 4, cells = slab.points / per_cell;
  // twice (in space in both level directions) as long as high
  const double height = std::ceil(space ? std::cbrt(cells / 4) : std::sqrt(cells / 2));
  const double length = std::ceil(space ? std::sqrt(cells / height) : cells / height);
  const double top = height * kCell, side = length * kCell;
  const int up = space ? 2 : 1;

  coupling::Scene s;
  s.title = name_of(slab);
  s.formulation = slab.formulation;
  s.gravity = {};
  s.gravity[0] = kGravity * std::sin(0.384), s.gravity[up] = -kGravity * std::cos(0.384);
  s.grid.space = space ? Space::three_d : Space::plane_strain;
  s.grid.cell = kCell;
  s.grid.shape = slab.shape;
  s.grid.size = {side, space ? side : top + 4 * kCell, top + 4 * kCell};
  s.numerics.order = slab.order;
  s.numerics.transfer = slab.transfer;
  s.numerics.locking = slab.cell_average ? coupling::LockingCure::cell_average : coupling::LockingCure::none;
  s.materials = {soil(slab, top)};

  coupling::Body body;
  body.name = "slab";
  body.box = {coupling::Vector3{}, coupling::Vector3{side, space ? side : top, top}};
  body.jitter = 0.2;
  body.stress.kind = coupling::InitialStress::Kind::k0;
  body.stress.k0 = {0.3};  // below the active state
  s.bodies = {body};

  for (int i = 0; i < 2 * slab.dimension; ++i) {
    coupling::Boundary b;
    b.name = "side " + std::to_string(i);
    b.kind = i == 2 * up ? coupling::Boundary::Kind::fixed : coupling::Boundary::Kind::roller;
    b.side = i;
    s.boundaries.push_back(b);
  }
  coupling::Stage stage;
  stage.name = "slide";
  stage.duration = 1e3;  // longer than any benchmark runs
  s.stages = {stage};
  return s;
}

std::string name_of(const Slab& slab) {
  const char* transfer = slab.transfer == coupling::Transfer::apic   ? "apic"
                         : slab.transfer == coupling::Transfer::tpic ? "tpic"
                         : slab.order == coupling::StressOrder::musl ? "musl"
                                                                     : "flip";
  const char* shape = slab.shape == mpm::ShapeKind::gimp                ? "gimp"
                      : slab.shape == mpm::ShapeKind::quadratic_bspline ? "bspline"
                                                                        : "linear";
  const char* law = !slab.plastic ? "elastic" : slab.softening ? "softening" : "Mohr-Coulomb";
  return std::to_string(slab.dimension) + "D " + law + ", " + transfer + ", " + shape +
         (slab.cell_average ? ", cell average" : "") +
         (slab.formulation == "dry" ? "" : ", " + slab.formulation);
}

}  // namespace polder::bench
