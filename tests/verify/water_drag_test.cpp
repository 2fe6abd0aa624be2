// Drag laws at work: beds in permeameters, momentum between the layers.
#include "tests/verify/water_drag.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/threads.hpp"
#include "tests/verify/cut_run.hpp"
#include "tests/verify/two_layer_scenes.hpp"

using namespace polder;
using namespace polder::verify;
using coupling::DragLaw;
using coupling::Material;

namespace {

Choice layers() {
  return {.formulation = "two-layer", .cell = 0.1};
}

Material bed(DragLaw law, double diameter) {
  Material m;
  m.porosity = 0.4;
  m.drag_law = law;
  m.grain_diameter = diameter;
  return m;
}

}  // namespace

TEST_CASE("drag laws: Ergun's bed lets through the root of his quadratic") {
  set_threads(1);
  for (const double d : {1e-3, 1e-2})
    for (const double gradient : {0.01, 1.0}) {
      const Permeameter r = permeameter(layers(), bed(DragLaw::ergun, d), gradient);
      const double n = 0.4, a = 1.75 * 1000 * (1 - n) / (n * n * n * d);
      const double b = 150 * 1e-3 * (1 - n) * (1 - n) / (n * n * n * d * d), c = -9810 * gradient;
      const double root = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
      CAPTURE(d);
      CAPTURE(gradient);
      CAPTURE(r.reynolds);
      CHECK(r.exact == doctest::Approx(root).epsilon(1e-9));
      CHECK(r.discharge == doctest::Approx(root).epsilon(0.01));
      CHECK(r.difference < 0.01);
    }
}

TEST_CASE("drag laws: every law's bed lets through what the law says") {
  set_threads(1);
  Material forchheimer;
  forchheimer.porosity = 0.4;
  forchheimer.drag_law = DragLaw::forchheimer;
  forchheimer.hydraulic_conductivity = 1e-2;
  forchheimer.forchheimer = 2000;
  Material darcy;
  darcy.porosity = 0.4;
  darcy.hydraulic_conductivity = 1e-2;
  Material dilute = bed(DragLaw::gidaspow, 1e-3);
  dilute.porosity = 0.9;
  for (const Material& m : {darcy, forchheimer, bed(DragLaw::di_felice, 3e-3), dilute}) {
    const Permeameter r = permeameter(layers(), m, 0.5);
    CAPTURE(static_cast<int>(m.drag_law));
    CHECK(r.discharge == doctest::Approx(r.exact).epsilon(0.01));
  }
}

TEST_CASE("drag laws: momentum passes exactly, drag follows the velocity before the step") {
  set_threads(1);
  for (const DragLaw law : {DragLaw::ergun, DragLaw::gidaspow, DragLaw::di_felice})
    for (const double d : {1e-3, 0.1}) {
      const Slowing r = slowing(layers(), bed(law, d), 60);
      CAPTURE(static_cast<int>(law));
      CAPTURE(d);
      CAPTURE(r.relative);
      CHECK(r.momentum_error < 1e-13);
      CHECK(r.decay_error < 1e-3);
    }
}

TEST_CASE("drag laws: a run cut at any step goes on with the same bits, on any number of threads") {
  Scene scene = open_sides_scene(layers(), 0.3);
  scene.materials[0].drag_law = DragLaw::gidaspow;
  scene.materials[0].grain_diameter = 4e-3;
  set_threads(1);
  const WholeRun whole = run_whole(scene);
  for (const long at : {whole.steps / 5, whole.steps / 2}) check_cut_run(scene, at, whole.state, whole.steps);
  set_threads(4);
  check_same_bits(run_whole(scene).state, whole.state);
  set_threads(1);
}
