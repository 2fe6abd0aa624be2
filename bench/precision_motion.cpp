// Benchmark of precision of the skeleton alone: a manufactured large deformation of a neo-Hookean square
// (Wallstedt & Guilkey 2008), for every way to map between points and nodes.
#include <utility>

#include "bench/precision.hpp"
#include "tests/verify/mpm_motion.hpp"

namespace polder::bench {

Benchmark manufactured_benchmark(const Place& place) {
  using mpm::AffineKind;
  using mpm::ShapeKind;
  using verify::Scheme;
  Benchmark b{
      "manufactured", "Manufactured large deformation", "exact motion", {"displacement"}, false, {}, {}};
  struct Kind {
    const char* name;
    bool musl;
    double flip;
    AffineKind affine;
  };
  constexpr Kind kKinds[] = {
      {"musl, flip", true, 0.99, AffineKind::none}, {"usl, flip", false, 0.99, AffineKind::none},
      {"musl, flip 1", true, 1, AffineKind::none},  {"musl, tpic", true, 1, AffineKind::tpic},
      {"usl, tpic", false, 1, AffineKind::tpic},    {"usl, apic", false, 1, AffineKind::apic}};
  struct Shape {
    const char* name;
    ShapeKind shape;
  };
  constexpr Shape kShapes[] = {
      {"gimp", ShapeKind::gimp}, {"bspline", ShapeKind::quadratic_bspline}, {"linear", ShapeKind::linear}};
  for (const Kind& kind : kKinds)
    for (const Shape& shape : kShapes)
      for (const auto& [courant, per_axis] : {std::pair{0.5, 2}, std::pair{0.25, 2}, std::pair{0.5, 4}})
        for (const int cells : {8, 16, 32, 64}) {
          Scheme scheme{kind.name, shape.shape, kind.musl, kind.flip, kind.affine};
          Trial t;
          t.setting =
              std::string(kind.name) + ", " + shape.name + (per_axis == 4 ? ", 16 points a cell" : "");
          t.is_default = t.setting == "musl, flip, gimp";
          t.cell = 1.0 / cells;
          t.step = courant == 0.5 ? "courant 0.5" : "courant 0.25";
          t.quick = t.setting == "musl, flip, gimp" && courant == 0.5 && cells <= 32;
          t.run = [scheme, cells, courant = courant, per_axis = per_axis, place] {
            return in_own_process(place, 1, [&] {
              const verify::MotionError e = verify::manufactured(scheme, cells, courant, 0.05, per_axis);
              return Outcome{{e.displacement},
                             e.seconds,
                             static_cast<double>(e.steps),
                             static_cast<double>(per_axis * per_axis * cells * cells)};
            });
          };
          b.trials.push_back(std::move(t));
        }
  return b;
}

}  // namespace polder::bench
