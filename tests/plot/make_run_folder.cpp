// Writes a run's folder through the writers of io/, for the tests of `polder plot`: a levee of 3 m that slips
// along a circle, with invented but smooth fields. No mechanics is computed here.
//
//   make_run_folder DIR [3d]      3d: the same section, extruded by 2 m
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "io/csv.hpp"
#include "io/run_folder.hpp"
#include "io/vtkhdf.hpp"

using namespace polder;

namespace {

constexpr double kEnd = 10.0;     // [s]
constexpr double kSpacing = 0.1;  // of the material points [m]
constexpr double kUnitWeight = 9810.0;

double phreatic(double x) {
  return x < 1.8 ? 2.4 : 2.4 * (9.0 - x) / 7.2;
}
bool inside(double x, double y) {
  return y > 0 && y < 3.0 && y < (9.0 - x) / 2.0;
}

struct Cloud {
  std::vector<double> points, displacement, velocity, stress, pressure, strain, volume;
  std::vector<std::int64_t> id;
};

// Soil at time t: what lies within the slip circle turns about its centre by an angle that grows with t^2.
Cloud soil(double t, bool three_d) {
  constexpr double kCentreX = 7.5, kCentreY = 4.5, kRadius = 4.2;
  const double turn = 0.25 * (t / kEnd) * (t / kEnd), rate = 0.5 * t / (kEnd * kEnd);
  Cloud cloud;
  const double depth = three_d ? 2.0 : kSpacing;
  std::int64_t id = 0;
  for (double z = 0.5 * kSpacing; z < depth; z += three_d ? 4 * kSpacing : kSpacing) {
    for (double x = 0.5 * kSpacing; x < 9.0; x += kSpacing) {
      for (double y = 0.5 * kSpacing; y < 3.0; y += kSpacing) {
        if (!inside(x, y)) continue;
        const double rx = x - kCentreX, ry = y - kCentreY, r = std::hypot(rx, ry);
        const double slips = 0.5 * (1 - std::tanh((r - kRadius) / 0.1));
        const double angle = -turn * slips;
        const double ux = rx * std::cos(angle) - ry * std::sin(angle) - rx;
        const double uy = rx * std::sin(angle) + ry * std::cos(angle) - ry;
        const double vx = rate * slips * ry, vy = -rate * slips * rx;
        const double p = std::max(kUnitWeight * (phreatic(x) - y), -2000.0);
        const double vertical = -18000.0 * (std::min(3.0, (9.0 - x) / 2.0) - y) + std::max(p, 0.0);
        const double gamma = 2 * turn * std::exp(-std::pow((r - kRadius) / 0.2, 2));
        if (three_d)
          cloud.points.insert(cloud.points.end(), {x + ux, z, y + uy});
        else
          cloud.points.insert(cloud.points.end(), {x + ux, y + uy});
        const std::array<double, 3> u = three_d ? std::array{ux, 0.0, uy} : std::array{ux, uy, 0.0};
        const std::array<double, 3> v = three_d ? std::array{vx, 0.0, vy} : std::array{vx, vy, 0.0};
        cloud.displacement.insert(cloud.displacement.end(), u.begin(), u.end());
        cloud.velocity.insert(cloud.velocity.end(), v.begin(), v.end());
        const double syy = three_d ? 0.5 * vertical : vertical, szz = three_d ? vertical : 0.5 * vertical;
        cloud.stress.insert(cloud.stress.end(), {0.5 * vertical, syy, szz, 0.1 * vertical, 0.0, 0.0});
        cloud.pressure.push_back(p);
        cloud.strain.push_back(gamma);
        cloud.volume.push_back(kSpacing * kSpacing);
        cloud.id.push_back(id++);
      }
    }
  }
  return cloud;
}

// The saturated cells of 0.1 m of the section (2D only).
void write_fluid(FrameSeries& series, double t) {
  constexpr double kCell = 0.1;
  std::vector<double> points, pressure, fill;
  std::vector<std::int64_t> cells;
  for (double x = 0; x < 9.0 - 1e-9; x += kCell) {
    for (double y = 0; y < 3.0 - 1e-9; y += kCell) {
      const double xm = x + 0.5 * kCell, ym = y + 0.5 * kCell;
      if (!inside(xm, ym) || ym > phreatic(xm)) continue;
      const auto first = static_cast<std::int64_t>(points.size() / 2);
      points.insert(points.end(), {x, y, x + kCell, y, x + kCell, y + kCell, x, y + kCell});
      cells.insert(cells.end(), {first, first + 1, first + 2, first + 3});
      pressure.push_back(kUnitWeight * (phreatic(xm) - ym) * (1 + 0.1 * t / kEnd));
      fill.push_back(1.0);
    }
  }
  Frame frame;
  frame.time = t;
  frame.dimension = 2;
  frame.points = points;
  frame.shape = CellShape::quad;
  frame.cells = cells;
  frame.cell_data = {{"pore_pressure", 1, std::span<const double>(pressure)},
                     {"fill", 1, std::span<const double>(fill)}};
  series.write(frame);
}

void write_tables(const RunFolder& folder) {
  CsvWriter history(folder.history(),
                    {"time[s]", "step", "dt[s]", "dt_limit", "kinetic_energy[J]", "strain_energy[J]",
                     "dissipated_energy[J]", "unbalanced_force_ratio", "solid_mass_error", "water_mass_error",
                     "momentum_defect[N.s]", "max_speed[m/s]", "pore_pressure_roughness", "discharge[m2/s]",
                     "active_cells"},
                    CsvWriter::Mode::fresh);
  CsvWriter probes(folder.probes(), {"time[s]",       "crest:x[m]",
                                     "crest:y[m]",    "crest:ux[m]",
                                     "crest:uy[m]",   "crest:vx[m/s]",
                                     "crest:vy[m/s]", "toe:x[m]",
                                     "toe:y[m]",      "toe:ux[m]",
                                     "toe:uy[m]",     "toe:vx[m/s]",
                                     "toe:vy[m/s]",   "toe:pore_pressure[Pa]",
                                     "toe:syy[Pa]",   "toe:p[Pa]",
                                     "toe:q[Pa]",     "crest:pore_pressure[Pa]",
                                     "crest:syy[Pa]", "crest:p[Pa]",
                                     "crest:q[Pa]"},
                   CsvWriter::Mode::fresh);
  CsvWriter line(folder.phreatic(), {"time[s]", "x[m]", "y[m]"}, CsvWriter::Mode::fresh);
  for (int i = 0; i <= 200; ++i) {
    const double t = kEnd * i / 200, s = t / kEnd;
    history.row({t, std::int64_t{i * 50}, 1e-3 * (1 - 0.4 * s), i % 3 ? "skeleton wave" : "particle speed",
                 900 * s * s, 2000 * (1 - 0.3 * s), 3000 * s * s * s, 1e-3 + 0.5 * s * s, 0.0,
                 1e-12 * (1 + i), 1e-10 * std::sin(0.3 * i), 1.5 * s, 1e-5 * (2 + std::sin(0.1 * i)),
                 1e-4 * (1 - s), std::int64_t{800 - i}});
    const double u = s * s;
    probes.row(std::vector<double>{t,
                                   6.0,
                                   3.0,
                                   0.8 * u,
                                   -0.9 * u,
                                   0.16 * s,
                                   -0.18 * s,
                                   8.5,
                                   0.2,
                                   1.1 * u,
                                   0.3 * u,
                                   0.22 * s,
                                   0.06 * s,
                                   1500 + 800 * s,
                                   -3000 * (1 - 0.7 * s),
                                   2400 * (1 - 0.6 * s),
                                   1500 + 900 * std::sin(2 * s),
                                   -1000.0,
                                   -9000 + 2000 * s,
                                   7000 - 1500 * s,
                                   3000 + 2500 * s});
    if (i % 50 == 0) {
      for (double x = 0; x <= 9.0; x += 0.25) line.row(std::vector<double>{t, x, phreatic(x)});
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: make_run_folder DIR [3d]\n");
    return 2;
  }
  const bool three_d = argc > 2 && std::string(argv[2]) == "3d";
  try {
    const RunFolder folder(argv[1], RunFolder::Mode::overwrite);
    FrameSeries soil_frames(folder.path(), "soil"), fluid_frames(folder.path(), "fluid");
    for (int i = 0; i <= 4; ++i) {
      const double t = kEnd * i / 4;
      const Cloud cloud = soil(t, three_d);
      Frame frame;
      frame.time = t;
      frame.dimension = three_d ? 3 : 2;
      frame.points = cloud.points;
      frame.point_data = {{"id", 1, std::span<const std::int64_t>(cloud.id)},
                          {"displacement", 3, std::span<const double>(cloud.displacement)},
                          {"velocity", 3, std::span<const double>(cloud.velocity)},
                          {"effective_stress", 6, std::span<const double>(cloud.stress)},
                          {"pore_pressure", 1, std::span<const double>(cloud.pressure)},
                          {"deviatoric_strain", 1, std::span<const double>(cloud.strain)},
                          {"volume", 1, std::span<const double>(cloud.volume)}};
      soil_frames.write(frame);
      if (!three_d) write_fluid(fluid_frames, t);
    }
    write_tables(folder);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 4;
  }
}
