// Published slopes with cells of a tenth, a twentieth and a fortieth of their height: the factors fall as
// slip surfaces get sharper, and stay within three per cent. Minutes.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/threads.hpp"
#include "coupling/strength_reduction.hpp"
#include "io/csv.hpp"
#include "tests/verify/quasi_static_scenes.hpp"
#include "tests/verify/stability_scenes.hpp"

using namespace polder;
using namespace polder::verify;

TEST_CASE("published slopes on finer grids") {
  set_threads(1);
  const CsvTable table(std::string(POLDER_SOURCE_DIR) + "/tests/reference/slopes_literature.csv",
                       {"case", "note", "source"});
  const std::vector<std::string>& names = table.text("case");
  for (const PublishedSlope& slope : published_slopes()) {
    const auto found = std::find(names.begin(), names.end(), slope.name);
    REQUIRE(found != names.end());
    const double published = table.column("value[-]")[static_cast<std::size_t>(found - names.begin())];
    double coarser = 10;
    const bool friction = !slope.undrained && slope.below > 0;
    for (const double cell : {1.0, 0.5, 0.25}) {
      if (cell < 0.5 && !friction) continue;  // more points, the same tale
      Simulation simulation(scene_of(slope, cell));
      run_to_end(simulation);
      coupling::StabilityOptions options;
      options.first = published;
      const coupling::StabilityResult r =
          find_factor_of_safety(simulation, options, [](const coupling::StabilityTrial&) { return true; });
      long steps = 0;
      for (const coupling::StabilityTrial& t : r.trials) steps += t.steps;
      MESSAGE(slope.name << ", cells of " << cell << " m, " << simulation.particles() << " points: "
                         << r.factor() << " in " << r.trials.size() << " trials, " << steps << " steps");
      CHECK(std::abs(r.factor() / published - 1) < 0.03);
      CHECK(r.factor() < coarser * 1.005);
      coarser = r.factor();
    }
  }
}
