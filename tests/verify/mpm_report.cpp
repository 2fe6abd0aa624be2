// Tables of the validation book (docs/validation/mpm.md): mpm_report NAME ... prints one each.
#include <cstdio>
#include <cstring>
#include <functional>
#include <map>
#include <string>

#include "core/threads.hpp"
#include "tests/verify/mpm_collapse.hpp"
#include "tests/verify/mpm_column.hpp"

using namespace polder::verify;

namespace {

const char* name_of(ShapeKind s) {
  return s == ShapeKind::linear ? "linear" : s == ShapeKind::gimp ? "GIMP" : "B-spline";
}

void column() {
  std::printf(
      "| start | shape | cell average | h [m] | RMS, points | RMS, cell means | worst point | at height [m] "
      "| "
      "lowest cell | settlement | base reaction | unbalanced | steps |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const bool exact : {false, true})
    for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
      for (const bool average : {false, true})
        for (const double h : {0.1, 0.05, 0.025}) {
          ColumnOptions o;
          o.shape = shape, o.cell_average = average, o.spacing = h, o.from_exact_stress = exact;
          const ColumnResult r = settle_column(o);
          std::printf(
              "| %s | %s | %s | %g | %.3f %% | %.3f %% | %.2f %% | %.3f | %.2f %% | %.1e | %.1e | %.1e | %ld "
              "|\n",
              exact ? "exact stress" : "no stress", name_of(shape), average ? "yes" : "no", h, 100 * r.rms,
              100 * r.cell_rms, 100 * r.worst, r.where, 100 * r.bottom, r.settlement_error, r.reaction_error,
              r.unbalanced, r.steps);
        }
}

void collapse_table() {
  // Lube et al. (2005) and Lajeunesse et al. (2005), fits to experiments between walls
  // (tests/reference/collapse_plane.csv).
  const std::map<double, std::array<double, 3>> fits = {
      {0.5, {0.6, 0.9, 0.5}}, {1, {1.2, 1.8, 1.0}}, {2, {2.483, 3.6, 1.320}}, {4, {4.788, 5.796, 1.741}}};
  std::printf(
      "| H/L | shape | transfer | c [Pa] | run-out | front | height | Lube | Lajeunesse | height, Lube | "
      "fastest / free fall | points lost | change of volume | wall [s] |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  struct Scheme {
    const char* name;
    double flip;
    AffineKind affine;
  };
  for (const auto& [aspect, fit] : fits)
    for (const ShapeKind shape : {ShapeKind::gimp, ShapeKind::quadratic_bspline})
      for (const Scheme& scheme :
           {Scheme{"FLIP 0.98", 0.98, AffineKind::none}, Scheme{"FLIP 0.99", 0.99, AffineKind::none},
            Scheme{"FLIP 0.999", 0.999, AffineKind::none}, Scheme{"FLIP 1", 1, AffineKind::none},
            Scheme{"APIC", 1, AffineKind::apic}})
        for (const double cohesion : {0.0, 1.0, 100.0}) {
          CollapseOptions o;
          o.aspect = aspect, o.shape = shape, o.flip = scheme.flip, o.affine = scheme.affine,
          o.cohesion = cohesion;
          o.musl = scheme.affine == AffineKind::none;
          const CollapseResult r = collapse(o);
          std::printf(
              "| %g | %s | %s | %g | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %d | %.2f %% | %.1f "
              "|\n",
              aspect, name_of(shape), scheme.name, cohesion, r.runout, r.front, r.height, fit[0], fit[1],
              fit[2], r.fastest, r.lost, 100 * r.volume_change, r.wall);
        }
}

}  // namespace

int main(int count, char** names) {
  const std::map<std::string, std::function<void()>> tables = {{"column", column},
                                                               {"collapse", collapse_table}};
  polder::set_threads(1);
  int status = count > 1 ? 0 : 2;
  for (int i = 1; i < count; ++i) {
    const auto table = tables.find(names[i]);
    if (table != tables.end())
      table->second();
    else
      status = 2;
  }
  if (status != 0) {
    std::fprintf(stderr, "usage: mpm_report TABLE ...   tables:");
    for (const auto& [name, f] : tables) std::fprintf(stderr, " %s", name.c_str());
    std::fprintf(stderr, "\n");
  }
  return status;
}
