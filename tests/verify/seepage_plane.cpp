#include "tests/verify/seepage_plane.hpp"

#include <algorithm>
#include <chrono>

#include "fdm/soil_catalogue.hpp"
#include "tests/unit/reference_csv.hpp"
#include "tests/verify/seepage_scene.hpp"

namespace polder::verify {
namespace {

using Boundary = fdm::WaterBoundary<2>;
using Kind = Boundary::Kind;
using fdm::test::boundary;
using fdm::test::kInfinity;
constexpr double kHour = 3600;

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Cost cost_of(const SeepageScene& s, const Stopwatch& watch) {
  return {s.steps, s.rejected, static_cast<double>(s.iterations) / static_cast<double>(s.steps),
          watch.seconds()};
}

// Pressure head [m] at a point, bilinear between the centres of the cells (constant gradient beyond them).
double head_at(const SeepageScene& s, double x, double y) {
  const double h = s.grid.spacing();
  const auto corner = [&](double at, int cells) {
    return std::clamp(static_cast<int>(std::floor(at / h - 0.5)), 0, cells - 2);
  };
  const int i = corner(x, s.grid.cells()[0]), j = corner(y, s.grid.cells()[1]);
  const double tx = x / h - 0.5 - i, ty = y / h - 0.5 - j;
  const auto at = [&](int a, int b) { return s.field.pressure()[s.grid.slot({a, b})] / kGamma; };
  return (1 - ty) * ((1 - tx) * at(i, j) + tx * at(i + 1, j)) +
         ty * ((1 - tx) * at(i, j + 1) + tx * at(i + 1, j + 1));
}

// Height of the water table above x: the lowest zero of the head.
double water_table(const SeepageScene& s, double x) {
  const double h = s.grid.spacing();
  double below = head_at(s, x, 0.5 * h);
  for (int j = 1; j < s.grid.cells()[1]; ++j) {
    const double above = head_at(s, x, (j + 0.5) * h);
    if (above <= 0) return (j - 0.5) * h + h * below / (below - above);
    below = above;
  }
  return kInfinity;
}

double after(const std::string& text, const std::string& mark) {
  return std::stod(text.substr(text.find(mark) + mark.size()));
}

fdm::Soil<2> vauclin_sand() {
  fdm::Soil<2> s;
  s.retention = fdm::find_soil("vauclin-sand")->retention;
  return s;
}

}  // namespace

Tracy tracy(int cells) {
  const ReferenceCsv csv("tracy_2d.csv");
  const Stopwatch watch;
  const double side = csv.get("L"), h = side / cells, dry = csv.get("hr"), alpha = csv.get("alpha");
  fdm::Soil<2> soil;
  soil.retention.model = fdm::Retention::Model::gardner;
  soil.retention.alpha = alpha;
  soil.retention.residual = csv.get("theta_r") / csv.get("theta_s");
  SeepageScene s({0, 0}, {cells, cells}, h, {soil});
  std::fill(s.porosity.begin(), s.porosity.end(), csv.get("theta_s"));
  s.set_conductivity(csv.get("Ks") / kHour);
  for (const int wall : {0, 1, 2})
    s.conditions.boundaries.push_back(boundary<2>(Kind::pressure, wall, kGamma * dry));
  const double least = std::exp(alpha * dry);
  for (int i = 0; i < cells; ++i) {
    const double x = (i + 0.5) * h, w = least + (1 - least) * std::sin(M_PI * x / side);
    auto top = boundary<2>(Kind::pressure, 3, kGamma * std::log(w) / alpha);
    top.from[0] = x - 0.1 * h, top.to[0] = x + 0.1 * h;
    s.conditions.boundaries.push_back(top);
  }
  s.update();
  s.set_head([&](const auto&) { return dry; });

  // Series of Tracy (2006) at the cells' centres: steady part and decaying modes, W = exp(alpha h).
  const double c = alpha * (csv.get("theta_s") - csv.get("theta_r")) / (csv.get("Ks") / kHour);
  const double beta = std::sqrt(0.25 * alpha * alpha + std::pow(M_PI / side, 2));
  const auto exact = [&](double x, double z, double time) {
    double sum = std::sinh(beta * z) / std::sinh(beta * side);
    for (int k = 1; k < 200 && time < kInfinity; ++k) {
      const double lambda = k * M_PI / side, gamma = (beta * beta + lambda * lambda) / c;
      if (gamma * time > 60) break;
      sum +=
          2 / (side * c) * (k % 2 ? -1 : 1) * lambda / gamma * std::sin(lambda * z) * std::exp(-gamma * time);
    }
    return std::log(least +
                    (1 - least) * std::sin(M_PI * x / side) * std::exp(0.5 * alpha * (side - z)) * sum) /
           alpha;
  };
  Tracy r;
  const auto measure = [&](double time) {
    double error = 0, size = 0;
    for (const auto& cell : s.cells.cells()) {
      const auto x = s.cells.centre(cell.index);
      const double theirs = exact(x[0], x[1], time) - dry;
      error += std::pow(s.head(cell) - dry - theirs, 2), size += theirs * theirs;
    }
    r.head_error.push_back(std::sqrt(error / size));
  };
  double step = 60;
  for (std::size_t i = 2; i < csv.columns.size(); ++i) {
    const double time = after(csv.columns[i], "t=") * kHour;
    for (const auto& row : csv.rows)  // the series here is the one of the reference
      if (row[0] > 0.01 && row[1] > 0.01 && row[0] < side - 0.01 && row[1] < side - 0.01)
        REQUIRE(exact(row[0], row[1], time) == doctest::Approx(row[i]).epsilon(1e-5));
    if (time < kInfinity) {
      s.run(time, step, 0.02 * time);
      r.defect = s.defect / s.inflow;
      r.cost = cost_of(s, watch);
    } else {
      const fdm::StepReport report = s.field.steady(s.unsaturated(kHour));
      REQUIRE(report.converged);
      r.steady_iterations = report.iterations;
    }
    measure(time);
  }
  return r;
}

Recharge vauclin(int cells) {
  const ReferenceCsv heads("vauclin_recharge_heads.csv"), tables("vauclin_recharge_water_table.csv"),
      outflow("vauclin_recharge_outflow.csv");
  const Stopwatch watch;
  const double height = heads.get("Lz_m"), h = height / cells, start = heads.get("initial_water_table_m");
  SeepageScene s({0, 0}, {static_cast<int>(std::lround(heads.get("Lx_m") / h)), cells}, h, {vauclin_sand()});
  std::fill(s.porosity.begin(), s.porosity.end(), heads.get("theta_s"));
  s.set_conductivity(heads.get("Ks") / kHour);
  auto rain = boundary<2>(Kind::flux, 3, heads.get("flux_m_h") / kHour);
  rain.to[0] = 0.5;
  s.conditions.boundaries = {boundary<2>(Kind::head, 1, start), rain};
  s.update();
  s.set_head([&](const Point<2>& x) { return start - x[1]; });
  Recharge r;
  double step = 1;
  for (std::size_t i = 0; i < outflow.rows.size(); ++i) {
    const double hours = outflow.rows[i][0];
    s.run(hours * kHour, step, 60);
    double worst = 0;
    for (const auto& row : tables.rows)  // those extrapolated to fine grids, up to the last cells
      if (row[0] < 2.95) worst = std::max(worst, std::abs(water_table(s, row[0]) - row[5 + i]));
    r.table_error.push_back(worst);
    worst = 0;
    for (std::size_t c = 1; c < heads.columns.size(); ++c) {
      if (std::abs(after(heads.columns[c], "t=") - hours) > 1e-9) continue;
      const double x = after(heads.columns[c], "x=");
      for (const auto& row : heads.rows)
        if (row[c] > -0.3) worst = std::max(worst, std::abs(head_at(s, x, row[0]) - row[c]));
    }
    r.head_error.push_back(worst);
    r.outflow_error.push_back((s.out[0] - outflow.rows[i][2]) / outflow.rows[i][3]);
  }
  r.defect = s.defect / -s.out[1];
  r.cost = cost_of(s, watch);
  return r;
}

Wetting block_wetting(int cells) {
  const ReferenceCsv flux("block_wetting_flux.csv"), tables("block_wetting_water_table.csv");
  const Stopwatch watch;
  const double height = flux.get("H_m"), h = height / cells, tail = flux.get("h2_m"),
               length = flux.get("L_m");
  SeepageScene s({0, 0}, {static_cast<int>(std::lround(length / h)), cells}, h, {vauclin_sand()});
  std::fill(s.porosity.begin(), s.porosity.end(), flux.get("theta_s"));
  s.set_conductivity(flux.get("Ks") / kHour);
  auto down = boundary<2>(Kind::head, 1, tail), face = boundary<2>(Kind::atmosphere, 1, 0);
  down.to[1] = tail;
  face.from[1] = tail;
  s.conditions.boundaries = {boundary<2>(Kind::head, 0, flux.get("h1_m")), down, face};
  s.update();
  s.set_head([&](const Point<2>& x) { return tail - x[1]; });
  Wetting r;
  double step = 1;
  for (std::size_t i = 0; i < flux.rows.size(); ++i) {
    const auto& row = flux.rows[i];
    s.run(row[0] * kHour, step, 0.02 * row[0] * kHour);
    const fdm::Discharge& q = s.field.discharge();
    r.inflow_error.push_back(-q.boundary[0] * kHour / row[1] - 1);
    r.face_error.push_back((q.boundary[2] * kHour - row[3]) / row[1]);
    double worst = 0;
    for (const auto& at : tables.rows)
      if (at[0] > 0 && at[0] <= length - 0.2)
        worst = std::max(worst, std::abs(water_table(s, at[0]) - at[1 + i]));
    r.table_error.push_back(worst);
  }
  r.defect = s.defect / -s.out[0];
  r.cost = cost_of(s, watch);
  return r;
}

Dam dam(int cells, double fringe, fdm::FaceWeighting weighting) {
  const Stopwatch watch;
  const double length = 10, upstream = 10, tail = 2, k = 1e-4, h = upstream / cells;
  fdm::Soil<2> soil;
  soil.retention.model = fdm::Retention::Model::van_genuchten;
  soil.retention.alpha = 1 / fringe;
  soil.retention.n = 3;
  soil.retention.residual = 0.05;
  SeepageScene s({0, 0}, {cells, cells + cells / 8}, h, {soil});
  s.set_conductivity(k);
  auto down = boundary<2>(Kind::head, 1, tail);
  down.seepage_above = true;
  s.conditions.boundaries = {boundary<2>(Kind::head, 0, upstream), down};
  s.field.set_weighting(weighting);
  s.update();
  s.set_head([&](const Point<2>& x) { return upstream + (tail - upstream) * x[0] / length - x[1]; });
  Dam r;
  r.report = s.field.steady(s.unsaturated(1e4));
  r.discharge = s.field.discharge().boundary[1] / (k * (upstream * upstream - tail * tail) / (2 * length));
  // The exit: where the head extrapolated to the face is zero.
  for (int j = 0; j < s.grid.cells()[1]; ++j)
    if (s.field.pressure()[s.grid.slot({cells - 1, j})] > 0) r.exit = (j + 1) * h;
  r.seconds = watch.seconds();
  return r;
}

SheetPile sheet_pile(int cells, double depth) {
  const ReferenceCsv csv("sheet_pile.csv");
  const double h = 1.0 / cells, head = 1, k = 1e-4;
  const int half = 3 * cells;
  SeepageScene s({-half * h, 0}, {2 * half, cells}, h, {fdm::Soil<2>{}});
  s.set_conductivity(k);
  auto left = boundary<2>(Kind::pressure, 3, kGamma * head), right = boundary<2>(Kind::pressure, 3, 0);
  left.to[0] = 0, right.from[0] = 0;
  s.conditions.boundaries = {left, right};
  s.conditions.sheets = {{.name = "pile", .points = {{0, 1}, {0, 1 - depth}}}};
  s.update();
  s.set_head([](const Point<2>& x) { return 1 - x[1]; });
  REQUIRE(s.field.steady(s.unsaturated(1)).converged);
  SheetPile r;
  for (const auto& row : csv.rows) {
    if (std::abs(row[0] - depth) > 1e-9) continue;
    r.discharge_error = s.field.discharge().boundary[1] / (k * head) / row[1] - 1;
    // Gradient of the head between the uppermost cell beside the pile and the surface.
    const double excess = s.field.pressure()[s.grid.slot({half, cells - 1})] / kGamma - 0.5 * h;
    r.gradient_error = excess / (0.5 * h) / (row[2] * head) - 1;
  }
  return r;
}

}  // namespace polder::verify
