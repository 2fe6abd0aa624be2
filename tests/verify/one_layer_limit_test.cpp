// The step limit that the program predicts from a small patch of each soil, against blocks many cells across.
#include "tests/verify/one_layer_limit.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <string>

#include "core/threads.hpp"
#include "coupling/step_limit.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("the predicted step limit is within 10 % of where blocks of 24 by 12 cells become unstable") {
  set_threads(1);
  for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
    for (const bool musl : {true, false})
      for (const double k : {0.0, 1e-12, 1e-3, 1e-2, 1.0}) {
        Block b{{24, 12}, {.shape = shape, .musl = musl, .conductivity = k}};
        const double limit = predicted_step(b);
        const std::string name =
            std::string(shape == ShapeKind::gimp ? "GIMP" : "B-spline") + (musl ? ", MUSL" : ", USL");
        CAPTURE(name);
        CAPTURE(k);
        CAPTURE(limit / wave_step(b));
        // The limit holds wherever the surface cuts its cells, and somewhere it is sharp.
        bool unstable = false;
        for (const bool free_side : {false, true})
          for (const double offset : {0.0, 0.25, 0.5, 0.75}) {
            if (free_side && offset < 0.5) continue;
            b.choice.offset = offset, b.free_side = free_side;
            CAPTURE(offset);
            CAPTURE(free_side);
            CHECK(!grows(b, 0.9 * limit));
            const bool beyond = grows(b, 1.1 * limit);
            unstable |= beyond;
            if (musl) CHECK(beyond);  // the default: sharp for any surface
          }
        CHECK(unstable);
      }
}

TEST_CASE("finding the limit takes less than a second, also in space") {
  set_threads(1);
  Choice c;
  Scene s = wet_scene(c, 1, 1, 1);
  s.grid.space = Space::three_d;
  s.grid.size = {1, 1, 1};
  s.materials = {elastic_soil(1e7, 0.2, 0.4, c.conductivity)};
  s.bodies = {box(0, 0, 1, 1, c)};
  (*s.bodies[0].box)[1][2] = 0.8;
  const auto start = std::chrono::steady_clock::now();
  const coupling::StabilityLimit limit = coupling::find_stability_limit(s);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  MESSAGE("C " << limit.courant_number << ", " << seconds << " s");
  CHECK(limit.courant_number > 1.0);
  CHECK(limit.courant_number < 3.0);
  CHECK(seconds < 1.0);
}
