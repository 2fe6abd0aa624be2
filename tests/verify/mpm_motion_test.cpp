// Elastic bodies in motion: orders of convergence, free rotation, stability of the locking cure.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/threads.hpp"
#include "io/csv.hpp"
#include "tests/verify/mpm_motion.hpp"

using namespace polder;
using namespace polder::verify;

namespace {

const std::filesystem::path kReference = std::filesystem::path(POLDER_SOURCE_DIR) / "tests" / "reference";

constexpr Scheme kGimpMusl{"GIMP MUSL", ShapeKind::gimp, true, 1, AffineKind::none};
constexpr Scheme kGimpApic{"GIMP APIC", ShapeKind::gimp, false, 1, AffineKind::apic};
constexpr Scheme kSplineMusl{"B-spline MUSL", ShapeKind::quadratic_bspline, true, 1, AffineKind::none};
constexpr Scheme kSplineUsl{"B-spline USL", ShapeKind::quadratic_bspline, false, 1, AffineKind::none};
constexpr Scheme kSplineApic{"B-spline APIC", ShapeKind::quadratic_bspline, false, 1, AffineKind::apic};

}  // namespace

TEST_CASE("the exact solutions used here are those of the reference tables") {
  const CsvTable table(kReference / "mms_axis_aligned.csv");
  const Manufactured x = manufactured_axis(0, 0.05), y = manufactured_axis(1, 0.05);
  const auto t = table.column("t[s]"), px = table.column("X[m]"), py = table.column("Y[m]");
  const auto u = table.column("u[m]"), v = table.column("v[m]"), vx = table.column("vx[m/s]");
  const auto bx = table.column("bx[m/s2]"), by = table.column("by[m/s2]");
  REQUIRE(t.size() > 100);
  for (std::size_t i = 0; i < t.size(); ++i) {
    CHECK(std::abs(x.displacement(px[i], t[i]) - u[i]) < 1e-8);
    CHECK(std::abs(y.displacement(py[i], t[i]) - v[i]) < 1e-8);
    CHECK(std::abs(x.velocity(px[i], t[i]) - vx[i]) < 1e-5);
    CHECK(std::abs(x.body_force(px[i], t[i], y.stretch(py[i], t[i])) - bx[i]) < 1e-6 * 3e4);
    CHECK(std::abs(y.body_force(py[i], t[i], x.stretch(px[i], t[i])) - by[i]) < 1e-6 * 3e4);
  }
}

TEST_CASE("vibrating bar: second order in space and time") {
  set_threads(1);
  for (const Scheme& scheme : {kGimpMusl, kSplineMusl, kSplineUsl, kSplineApic}) {
    CAPTURE(scheme.name);
    const MotionError coarse = vibrate_bar(scheme, 16, 0.5), fine = vibrate_bar(scheme, 32, 0.5);
    CHECK(fine.displacement < 3e-3);
    CHECK(std::log2(coarse.displacement / fine.displacement) > 1.8);
    CHECK(std::abs(fine.energy) < 1e-3);
  }
}

TEST_CASE("manufactured large deformation: second order") {
  set_threads(1);
  for (const Scheme& scheme : {kGimpMusl, kGimpApic}) {
    CAPTURE(scheme.name);
    const double coarse = manufactured(scheme, 16, 0.5).displacement,
                 fine = manufactured(scheme, 32, 0.5).displacement;
    CHECK(std::log2(coarse / fine) > 1.8);
  }
  // The B-spline's integrals over two points an axis stop converging when large strains pull them apart
  // (docs/validation).
  for (const Scheme& scheme : {kSplineUsl, kSplineApic}) {
    CAPTURE(scheme.name);
    CHECK(std::log2(manufactured(scheme, 16, 0.5, 0.01).displacement /
                    manufactured(scheme, 32, 0.5, 0.01).displacement) > 1.8);
    CHECK(std::log2(manufactured(scheme, 16, 0.5, 0.05, 4).displacement /
                    manufactured(scheme, 32, 0.5, 0.05, 4).displacement) > 1.8);
  }
}

TEST_CASE("a disk that turns by 360 degrees keeps energy and shape") {
  set_threads(1);
  const SpinResult apic = spin_disk(kSplineApic, 6, 0.5);
  CHECK(std::abs(apic.energy) < 5e-4);
  CHECK(std::abs(apic.angular) < 1e-12);
  CHECK(apic.shape < 1e-3);
  CHECK(std::abs(apic.area) < 5e-4);
  CHECK(std::abs(apic.angle) < 0.5);
  const SpinResult flip = spin_disk(kSplineMusl, 6, 0.5);
  CHECK(std::abs(flip.energy) < 0.1);
  CHECK(flip.shape < 5e-3);
  CHECK(std::abs(flip.area) < 1e-3);
}

TEST_CASE("the locking cure feeds no energy, wherever points sit in their cells") {
  set_threads(1);
  for (const Scheme& scheme : {kGimpMusl, kSplineUsl})
    for (const double offset : {0.0, 0.2}) {
      CAPTURE(scheme.name);
      CAPTURE(offset);
      // Positions and velocities live half a step apart: their energies beat by a fifth in the shortest
      // waves.
      CHECK(energy_growth(scheme, true, offset, 800) < 1.3);
    }
}
