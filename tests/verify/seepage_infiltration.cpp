#include "tests/verify/seepage_infiltration.hpp"

#include <algorithm>
#include <ctime>

#include "tests/unit/reference_csv.hpp"
#include "tests/verify/seepage_scene.hpp"

namespace polder::verify {
namespace {

using Boundary = fdm::WaterBoundary<2>;
constexpr double kCentimetre = 0.01;

// A column of the reference's depth with the pressure heads of its header, run to the reference's last time.
Infiltration run_column(const std::string& name, const fdm::Soil<2>& soil, const InfiltrationChoice& choice) {
  const ReferenceCsv profiles(name + "_profiles.csv"), inflow(name + "_inflow.csv");
  const double depth = profiles.get("L") * kCentimetre, h = depth / choice.cells;
  const double porosity = profiles.get("theta_s"), initial = profiles.get("h_init") * kCentimetre;
  SeepageScene s({0, 0}, {1, choice.cells}, h, {soil});
  std::fill(s.porosity.begin(), s.porosity.end(), porosity);
  s.set_conductivity(profiles.get("Ks") * kCentimetre);
  const auto pressure = [&](int side, const char* head) {
    return fdm::test::boundary<2>(Boundary::Kind::pressure, side, kGamma * profiles.get(head) * kCentimetre);
  };
  s.conditions.boundaries = {pressure(2, "h_bottom"), pressure(3, "h_top")};
  if (choice.upstream) s.field.set_weighting(fdm::FaceWeighting::upstream);
  s.update();
  s.set_head([&](const auto&) { return initial; });

  const double end = inflow.rows.back()[0];
  const std::clock_t start = std::clock();
  double step = choice.first_step;
  if (choice.step > 0)
    s.run_fixed(end, choice.step);
  else
    s.run(end, step);
  Infiltration r;
  r.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;

  // The last column is the water content at the end, by depth [cm]; ours between the centres of the cells.
  double error = 0, size = 0, increase = 0;
  const double dry = profiles.rows.back().back();
  for (const auto& row : profiles.rows) {
    const double y = depth - row[0] * kCentimetre;
    if (y < 0.5 * h || y > depth - 0.5 * h) continue;
    const int below = std::min(static_cast<int>(y / h - 0.5), choice.cells - 2);
    const double part = y / h - 0.5 - below;
    const auto content = [&](int cell) { return porosity * s.field.saturation()[s.grid.slot({0, cell})]; };
    const double ours = (1 - part) * content(below) + part * content(below + 1), theirs = row.back();
    error += (ours - theirs) * (ours - theirs);
    size += theirs * theirs;
    increase += (theirs - dry) * (theirs - dry);
  }
  r.profile_error = std::sqrt(error / size);
  r.front_error = std::sqrt(error / increase);
  r.inflow_error = -s.out[1] / h / (inflow.rows.back()[1] * kCentimetre) - 1;
  r.defect = s.defect / s.inflow;
  r.steps = s.steps, r.rejected = s.rejected;
  r.iterations = static_cast<double>(s.iterations) / static_cast<double>(s.steps);
  return r;
}

}  // namespace

Infiltration celia_new_mexico(const InfiltrationChoice& choice) {
  fdm::Soil<2> soil;
  soil.retention.model = fdm::Retention::Model::van_genuchten;
  soil.retention.alpha = 3.35;
  soil.retention.n = 2;
  soil.retention.residual = 0.102 / 0.368;
  return run_column("celia_new_mexico", soil, choice);
}

Infiltration celia_haverkamp(const InfiltrationChoice& choice) {
  fdm::Soil<2> soil;
  soil.retention.model = fdm::Retention::Model::haverkamp;
  soil.retention.residual = 0.075 / 0.287;
  soil.retention.haverkamp = {1.611e6 * std::pow(kCentimetre, 3.96), 3.96,
                              1.175e6 * std::pow(kCentimetre, 4.74), 4.74};
  return run_column("celia_haverkamp", soil, choice);
}

}  // namespace polder::verify
