#include "tests/verify/seepage_columns.hpp"

#include <algorithm>

#include "tests/unit/reference_csv.hpp"
#include "tests/verify/seepage_scene.hpp"

namespace polder::verify {
namespace {

using Boundary = fdm::WaterBoundary<2>;
using Kind = Boundary::Kind;
using fdm::test::boundary;
using fdm::test::kInfinity;

// Value at x of the piecewise linear function through (xs, ys), xs ascending or descending.
double interpolate(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  const bool up = xs.back() > xs.front();
  std::size_t i = 1;
  while (i + 1 < xs.size() && (up ? xs[i] < x : xs[i] > x)) ++i;
  const double t = (x - xs[i - 1]) / (xs[i] - xs[i - 1]);
  return ys[i - 1] + t * (ys[i] - ys[i - 1]);
}

std::vector<double> column(const ReferenceCsv& csv, std::size_t number) {
  std::vector<double> values;
  for (const auto& row : csv.rows) values.push_back(row[number]);
  return values;
}

fdm::Soil<2> exponential(double alpha, double residual) {
  fdm::Soil<2> s;
  s.retention.model = fdm::Retention::Model::gardner;
  s.retention.alpha = alpha;
  s.retention.residual = residual;
  return s;
}

fdm::Soil<2> new_mexico() {
  fdm::Soil<2> s;
  s.retention.model = fdm::Retention::Model::van_genuchten;
  s.retention.alpha = 3.35;
  s.retention.n = 2;
  s.retention.residual = 0.102 / 0.368;
  return s;
}

// A soil whose pores fill within a few per cent of the air-entry head; integral of k_r over suction: `drive`.
fdm::Soil<2> nearly_a_step(double drive) {
  constexpr double kIndex = 20;
  fdm::Soil<2> s;
  s.retention.model = fdm::Retention::Model::brooks_corey;
  s.retention.lambda = kIndex;
  const double exponent = 2 + kIndex * (2 + s.retention.connectivity);  // of 1/h in k_r
  s.retention.entry_head = drive * (exponent - 1) / exponent;
  return s;
}

}  // namespace

Absorption sorptivity(int cells) {
  const ReferenceCsv csv("sorptivity_new_mexico.csv");
  const double end = 3600, root = std::sqrt(end), length = 0.12;
  const double h = length / cells;
  SeepageScene s({0, 0}, {cells, 1}, h, {new_mexico()}, kInfinity, fdm::SolverKind::automatic, 0);
  std::fill(s.porosity.begin(), s.porosity.end(), csv.get("theta_s"));
  s.set_conductivity(csv.get("Ks") * 0.01);
  const double dry = csv.get("h_i") * 0.01;
  s.conditions.boundaries = {boundary<2>(Kind::pressure, 0, kGamma * csv.get("h_0") * 0.01),
                             boundary<2>(Kind::pressure, 1, kGamma * dry)};
  s.update();
  s.set_head([&](const auto&) { return dry; });
  double step = 1e-3;
  s.run(end, step, end / 400);
  Absorption r;
  r.volume_error = -s.out[0] / h / (csv.get("S") * 0.01 * root) - 1;
  r.defect = s.defect / s.inflow;
  r.steps = s.steps;
  const auto lambda = column(csv, 0), theta = column(csv, 2);
  double error = 0, size = 0;
  for (int i = 0; i < cells; ++i) {
    const double at = (i + 0.5) * h * 100 / root;  // [cm / s^1/2]
    const double theirs = at < lambda.back() ? interpolate(lambda, theta, at) : theta.back();
    const double ours = csv.get("theta_s") * s.field.saturation()[s.grid.slot({i, 0})];
    error += (ours - theirs) * (ours - theirs), size += theirs * theirs;
  }
  r.profile_error = std::sqrt(error / size);
  return r;
}

SharpFront green_ampt(int cells) {
  const ReferenceCsv csv("green_ampt_ponded.csv");
  const double depth = 1, h = depth / cells;
  SeepageScene s({0, 0}, {1, cells}, h, {nearly_a_step(csv.get("psi_front_m"))});
  std::fill(s.porosity.begin(), s.porosity.end(), csv.get("dtheta"));
  s.set_conductivity(csv.get("K_m_s"));
  s.conditions.boundaries = {boundary<2>(Kind::pressure, 3, kGamma * csv.get("h0_m"))};
  s.update();
  s.set_head([&](const auto&) { return -2 * csv.get("psi_front_m"); });
  SharpFront r;
  double step = 1;
  for (const auto& row : csv.rows) {
    if (row[3] > 0.9 * depth) break;
    s.run(row[0], step, 60);
    if (row[0] >= 600) r.volume_error = std::max(r.volume_error, std::abs(-s.out[0] / h / row[1] - 1));
  }
  r.balance = s.defect / s.inflow;
  r.steps = s.steps;
  return r;
}

SharpFront ponding(int cells) {
  const double depth = 0.5, h = depth / cells, k = 1e-5, drive = 0.2, pores = 0.3, rain = 5 * k;
  SeepageScene s({0, 0}, {1, cells}, h, {nearly_a_step(drive)});
  std::fill(s.porosity.begin(), s.porosity.end(), pores);
  s.set_conductivity(k);
  s.conditions.boundaries = {boundary<2>(Kind::atmosphere, 3, rain)};
  s.update();
  s.set_head([&](const auto&) { return -2 * drive; });
  // Mein & Larson (1973): ponding when K (1 + drive pores / F) = rain with F = rain t.
  const double predicted = k * drive * pores / (rain * (rain - k)), end = 4 * predicted;
  SharpFront r;
  const double dt = predicted / 400;
  while (s.time < end * (1 - 1e-9)) {
    s.run_fixed(s.time + dt, dt);
    const double taken = -s.field.discharge().boundary[0] / h;
    if (r.ponding_time == 0 && taken < rain * (1 - 1e-6)) r.ponding_time = s.time / predicted;
  }
  const double fallen = rain * s.time * h;
  r.run_off = (fallen - s.inflow) / fallen;
  r.balance = (s.inflow - s.stored) / fallen;
  // Infiltration after ponding: K (t - t_p + t_s) = F - drive pores ln(1 + F / (drive pores)), t_s the time
  // in which ponding from the start would have let the volume at t_p in.
  const double sp = drive * pores, at_ponding = rain * predicted;
  const double shift = (at_ponding - sp * std::log1p(at_ponding / sp)) / k;
  double volume = at_ponding;
  for (int i = 0; i < 100; ++i) volume = k * (s.time - predicted + shift) + sp * std::log1p(volume / sp);
  r.volume_error = s.inflow / h / volume - 1;
  r.steps = s.steps;
  return r;
}

Profiles srivastava_yeh(bool wetting, int cells, double step) {
  const std::string name = wetting ? "srivastava_yeh_wetting" : "srivastava_yeh_drying";
  const ReferenceCsv csv(name + "_profiles.csv"), flux(name + "_baseflux.csv");
  constexpr double kHour = 3600;
  const double length = csv.get("L") * 0.01, alpha = csv.get("alpha") * 100, k = csv.get("Ks") * 0.01 / kHour;
  const double before = csv.get("qA") / csv.get("Ks"), h = length / cells;
  SeepageScene s({0, 0}, {1, cells}, h, {exponential(alpha, csv.get("theta_r") / csv.get("theta_s"))});
  std::fill(s.porosity.begin(), s.porosity.end(), csv.get("theta_s"));
  s.set_conductivity(k);
  s.conditions.boundaries = {boundary<2>(Kind::pressure, 2, 0),
                             boundary<2>(Kind::flux, 3, csv.get("qB") * 0.01 / kHour)};
  s.update();
  s.set_head(
      [&](const Point<2>& x) { return std::log((1 - before) * std::exp(-alpha * x[1]) + before) / alpha; });
  Profiles r;
  const auto z = column(csv, 0);
  std::size_t next_flux = 0;
  for (std::size_t c = 2; c < csv.columns.size(); c += 2) {
    const double time = kHour * std::stod(csv.columns[c].substr(csv.columns[c].find("t=") + 2));
    while (next_flux < flux.rows.size() && flux.rows[next_flux][0] * kHour <= time) {
      s.run_fixed(flux.rows[next_flux][0] * kHour, step);
      const double q = s.field.discharge().boundary[0] / h * kHour * 100;
      r.flux_error = std::max(r.flux_error, std::abs(q - flux.rows[next_flux][1]) / flux.rows.back()[1]);
      ++next_flux;
    }
    if (time > s.time * (1 + 1e-9)) s.run_fixed(time, std::min(step, time - s.time));
    const auto head = column(csv, c - 1);  // smoother than the water content, between the points
    double error = 0, size = 0;
    for (int i = 0; i < cells; ++i) {
      const double suction = 0.01 * interpolate(z, head, (i + 0.5) * h * 100);
      const double theirs =
          csv.get("theta_r") + (csv.get("theta_s") - csv.get("theta_r")) * std::exp(alpha * suction);
      const double ours = csv.get("theta_s") * s.field.saturation()[s.grid.slot({0, i})];
      error += (ours - theirs) * (ours - theirs), size += theirs * theirs;
    }
    r.error.push_back(std::sqrt(error / size));
  }
  r.iterations = static_cast<int>(s.iterations);
  return r;
}

Profiles gardner(int cells) {
  const ReferenceCsv csv("gardner_steady.csv");
  const double length = csv.get("L"), alpha = csv.get("alpha"), k = csv.get("Ks"), h = length / cells;
  Profiles r;
  for (std::size_t c = 1; c < csv.columns.size(); ++c) {
    const double upward = std::stod(csv.columns[c].substr(csv.columns[c].find("q=") + 2));
    SeepageScene s({0, 0}, {1, cells}, h, {exponential(alpha, 0.1)});
    s.set_conductivity(k);
    s.conditions.boundaries = {boundary<2>(Kind::pressure, 2, 0), boundary<2>(Kind::flux, 3, -upward)};
    s.update();
    s.set_head([](const Point<2>& x) { return -x[1]; });
    const fdm::StepReport report = s.field.steady(s.unsaturated(3600));
    REQUIRE(report.converged);
    r.iterations += report.iterations;
    double error = 0, size = 0;
    for (const auto& cell : s.cells.cells()) {
      const double z = s.cells.centre(cell.index)[1];
      const double theirs = std::log((1 + upward / k) * std::exp(-alpha * z) - upward / k) / alpha;
      error += std::pow(s.head(cell) - theirs, 2), size += theirs * theirs;
    }
    r.error.push_back(std::sqrt(error / std::max(size, 1e-30)));
  }
  return r;
}

double limiting_evaporation(int cells) {
  const ReferenceCsv csv("gardner_steady.csv");
  const double length = csv.get("L"), alpha = csv.get("alpha"), k = csv.get("Ks"), h = length / cells;
  SeepageScene s({0, 0}, {1, cells}, h, {exponential(alpha, 0.1)});
  s.set_conductivity(k);
  auto sun = boundary<2>(Kind::atmosphere, 3, -2e-7);
  sun.limiting_pressure = -100 * kGamma;
  s.conditions.boundaries = {boundary<2>(Kind::pressure, 2, 0), sun};
  s.update();
  s.set_head([](const Point<2>& x) { return -x[1]; });
  REQUIRE(s.field.steady(s.unsaturated(3600)).converged);
  const double limit = k / std::expm1(alpha * length);
  return s.field.discharge().boundary[1] / h / limit - 1;
}

Profiles steady_van_genuchten(int cells) {
  const ReferenceCsv csv("steady_van_genuchten.csv");
  Profiles r;
  for (std::size_t c = 1; c < csv.columns.size(); ++c) {
    const double upward = 0.01 * std::stod(csv.columns[c].substr(csv.columns[c].find("q=") + 2));
    std::vector<double> head, height;
    for (const auto& row : csv.rows)
      if (std::isfinite(row[c])) head.push_back(row[0] * 0.01), height.push_back(row[c] * 0.01);
    const double length = std::min(0.9 * height.back(), 1.0), h = length / cells;
    SeepageScene s({0, 0}, {1, cells}, h, {new_mexico()});
    s.set_conductivity(csv.get("Ks") * 0.01);
    s.conditions.boundaries = {boundary<2>(Kind::pressure, 2, 0), boundary<2>(Kind::flux, 3, -upward)};
    s.update();
    s.set_head([](const Point<2>& x) { return -x[1]; });
    const fdm::StepReport report = s.field.steady(s.unsaturated(3600));
    REQUIRE(report.converged);
    r.iterations += report.iterations;
    // The table's points, not between them: the head is ours that is interpolated.
    std::vector<double> z, p;
    for (const auto& cell : s.cells.cells())
      z.push_back(s.cells.centre(cell.index)[1]), p.push_back(s.head(cell));
    double error = 0, size = 0;
    for (std::size_t i = 0; i < head.size(); ++i) {
      if (height[i] < z.front() || height[i] > z.back()) continue;
      error += std::pow(interpolate(z, p, height[i]) - head[i], 2), size += head[i] * head[i];
    }
    r.error.push_back(std::sqrt(error / size));
  }
  return r;
}

FallingHead falling_head(int cells) {
  const ReferenceCsv csv("falling_head.csv");
  const double length = csv.get("L_m"), h = length / cells, k = 1e-4, modulus = 1e5, dt = 0.005;
  FallingHead r;
  for (const bool rigid : {true, false}) {
    SeepageScene s({0, 0}, {1, cells}, h, {fdm::Soil<2>{}});
    s.set_conductivity(k);
    s.compressibility.assign(s.grid.slots(), rigid ? 0 : 1 / modulus);
    double level = csv.get("h0_m");  // above the outlet's, over the sample's top
    // Heads from the outlet, so gravity's part of the pressure drops out: the top stands at its own height.
    const auto apply = [&] {
      s.conditions.boundaries = {boundary<2>(Kind::pressure, 2, kGamma * length),
                                 boundary<2>(Kind::pressure, 3, kGamma * level)};
      s.update();
    };
    apply();
    s.set_head([&](const Point<2>& x) { return length - x[1] + level * x[1] / length; });  // steady flow
    const double ratio = csv.get("A_m2") / csv.get("a_m2");
    for (const auto& row : csv.rows) {
      while (s.time < row[0] * (1 - 1e-9)) {
        REQUIRE(s.step(dt));
        level += dt * ratio * s.field.discharge().boundary[1] / h;  // outflow is negative: the pipe feeds it
        apply();
      }
      double& worst = rigid ? r.rigid_error : r.compressible_error;
      worst = std::max(worst, std::abs(level - row[rigid ? 1 : 2]) / csv.get("h0_m"));
    }
  }
  return r;
}

}  // namespace polder::verify
