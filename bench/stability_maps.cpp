#include "bench/stability_maps.hpp"

#include <limits>
#include <numbers>

namespace polder::bench {
namespace {

using coupling::PressureMethod;

Axis step_axis(std::vector<double> values) {
  return {"step over the chosen one", true, std::move(values), {}, {}};
}

const std::vector<double> kSteps{0.25, 0.5, 0.71, 1, 1.19, 1.41, 1.68, 2, 2.38, 2.83, 3.36, 4, 5.66, 8, 11.3};

Panel panel(const char* name, const char* formulation) {
  Panel p{name, {}};
  p.specimen.formulation = formulation;
  return p;
}

Panel compressible() {
  Panel p = panel("two-layer, compressible", "two-layer");
  p.specimen.pressure = PressureMethod::compressible;
  return p;
}

Panel explicit_drag() {
  Panel p = panel("v-w, explicit drag", "v-w");
  p.specimen.drag = coupling::DragStep::by_last_velocities;
  return p;
}

Panel with(Panel p, const char* suffix, const std::function<void(Specimen&)>& change) {
  p.name += suffix;
  change(p.specimen);
  return p;
}

std::vector<Panel> formulations() {
  return {panel("one-layer", "one-layer"),
          panel("two-layer", "two-layer"),
          panel("two-layer-darcy", "two-layer-darcy"),
          panel("higo", "higo"),
          compressible(),
          panel("u-p", "u-p"),
          panel("v-w", "v-w"),
          explicit_drag()};
}

std::vector<Panel> formulations_and_schemes() {
  std::vector<Panel> all = formulations();
  const auto bspline = [](Specimen& s) { s.shape = mpm::ShapeKind::quadratic_bspline; };
  const auto usl = [](Specimen& s) { s.musl = false; };
  all.push_back(with(panel("one-layer", "one-layer"), ", bspline", bspline));
  all.push_back(with(panel("one-layer", "one-layer"), ", usl", usl));
  all.push_back(with(panel("two-layer", "two-layer"), ", bspline", bspline));
  all.push_back(with(panel("two-layer", "two-layer"), ", usl", usl));
  return all;
}

Map conductivity() {
  Axis x{"conductivity [m/s]",
         true,
         {1e-12, 1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1},
         {},
         [](Specimen& s, double k) { s.conductivity = k; }};
  return {"conductivity", "Conductivity against step", x, step_axis(kSteps), formulations_and_schemes()};
}

Map bulk_modulus() {
  Axis x{"bulk modulus of water [Pa]",
         true,
         {1e5, 1e6, 1e7, 1e8, 1e9, 2.2e9, 1e10},
         {},
         [](Specimen& s, double stiffness) { s.bulk_modulus = stiffness; }};
  return {"bulk-modulus", "Bulk modulus of water against step", x, step_axis(kSteps), formulations()};
}

// Points in a cell, regular and random, by the number along an axis and 10 more for random ones.
Map points() {
  Axis x{"points in a cell (r: random)",
         false,
         {1, 2, 3, 4, 11, 12, 13, 14},
         {"1", "4", "9", "16", "1r", "4r", "9r", "16r"},
         [](Specimen& s, double n) { s.random = n > 10, s.per_axis = static_cast<int>(n) % 10; }};
  Axis y{"share of FLIP", false, {0, 0.5, 0.9, 0.95, 0.99, 1}, {}, [](Specimen& s, double f) { s.flip = f; }};
  std::vector<Panel> panels = formulations();
  panels.push_back(with(panel("one-layer", "one-layer"), ", bspline",
                        [](Specimen& s) { s.shape = mpm::ShapeKind::quadratic_bspline; }));
  return {"points", "Points in a cell against FLIP, chosen step", x, y, panels};
}

Map porosity() {
  Axis x{
      "porosity", false, {0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}, {}, [](Specimen& s, double n) {
        s.porosity = n;
      }};
  Axis y{
      "density of grains over water", true, {1.05, 1.2, 1.5, 2, 2.65, 4, 8}, {}, [](Specimen& s, double r) {
        s.density_ratio = r;
      }};
  return {"porosity", "Porosity against density ratio, chosen step", x, y, formulations()};
}

Map saturation() {
  Axis x{"degree of saturation",
         false,
         {0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1},
         {},
         [](Specimen& s, double degree) { s.saturation = degree; }};
  std::vector<Panel> panels{panel("one-layer", "one-layer"), panel("higo", "higo")};
  for (const double k : {1e-6, 1e-2})
    for (const char* name : {"one-layer", "higo"})
      panels.push_back(with(panel(name, name), k < 1e-4 ? ", k = 1e-6 m/s" : ", k = 1e-2 m/s",
                            [k](Specimen& s) { s.conductivity = k; }));
  return {"saturation", "Saturation against step", x, step_axis(kSteps), panels};
}

Map dilation() {
  constexpr double kDegree = std::numbers::pi / 180;
  Axis x{"dilation [degrees]", false, {-10, -5, -1, 0, 5, 10, 20, 30}, {}, [](Specimen& s, double angle) {
           s.friction = 30 * kDegree, s.dilation = angle * kDegree;
         }};
  return {"dilation", "Dilation against step, soil that fails", x, step_axis(kSteps), formulations()};
}

}  // namespace

std::vector<Map> stability_maps() {
  return {conductivity(), bulk_modulus(), points(), porosity(), saturation(), dilation()};
}

}  // namespace polder::bench
