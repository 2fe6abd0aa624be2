// The case as a whole, its grid and its numerics.
#include <cmath>

#include "app/case_keys.hpp"
#include "app/codecs.hpp"

namespace polder::app {

using coupling::GridSpec;
using coupling::NumericsSpec;
using coupling::Scene;

namespace {

std::vector<std::string> formulation_names(bool available) {
  std::vector<std::string> names;
  for (const auto& f : coupling::formulations())
    if (f.available == available) names.push_back(f.name);
  return names;
}

// Every side of the grid must be a whole number of cells.
void check_cells(GridSpec& grid, const std::string& path, Reader& reader) {
  const std::string key = key_path(path, "size");
  if (reader.failed(path)) return;
  const int dimension = reader.dimension();
  for (int axis = 0; axis < dimension; ++axis) {
    const double size = grid.size[static_cast<std::size_t>(axis)];
    if (!(size > 0)) {
      reader.error(key, "the grid has no extent along " + std::string(1, "xyz"[axis]),
                   "lengths greater than 0");
      return;
    }
    const double cells = size / grid.cell;
    constexpr double kTolerance = 1e-6;  // sizes are decimal numbers: 12 / 0.1 is not exactly 120
    if (std::abs(cells - std::round(cells)) > kTolerance * std::max(1.0, cells) || cells < 0.5) {
      const double fewer = std::max(1.0, std::floor(cells)), more = fewer + 1;
      const auto rounded = [](double length) { return format_number(std::round(length * 1e9) / 1e9); };
      reader.error(key,
                   format_number(size) + " m along " + std::string(1, "xyz"[axis]) + " is " +
                       format_number(std::round(cells * 1e3) / 1e3) + " cells of " +
                       format_number(grid.cell) + " m",
                   "a whole number of cells, for example " + rounded(fewer * grid.cell) + " or " +
                       rounded(more * grid.cell));
    }
  }
  if (grid.space == Space::axisymmetric && grid.origin[0] < 0)
    reader.error(key_path(path, "origin"),
                 "the axisymmetric grid begins at x = " + format_number(grid.origin[0]) + ", beyond the axis",
                 "x of at least 0");
}

}  // namespace

const Table<GridSpec>& grid_keys() {
  static const Table<GridSpec> table = [] {
    Table<GridSpec> t;
    t.add("space",
          choice<Space>({{"plane-strain", Space::plane_strain},
                         {"axisymmetric", Space::axisymmetric},
                         {"3d", Space::three_d}}),
          &GridSpec::space,
          "Geometry. The last axis points up: y in 2D, z in 3D; axisymmetric: x is the radius.");
    t.add("origin", vector(dimension::kLength), &GridSpec::origin, "Lower corner of the grid.");
    t.add("size", vector(dimension::kLength), &GridSpec::size,
          "Extent along each axis, a whole number of cells. Leave room for the run-out: soil cannot leave "
          "the grid.")
        .required();
    t.add("cell", number(dimension::kLength, kPositive), &GridSpec::cell, "Side of a cell.").required();
    t.add("shape",
          choice<mpm::ShapeKind>({{"linear", mpm::ShapeKind::linear},
                                  {"gimp", mpm::ShapeKind::gimp},
                                  {"quadratic-bspline", mpm::ShapeKind::quadratic_bspline}},
                                 {"cubic-bspline", "cpdi", "cmpm"}),
          &GridSpec::shape, "Shape functions between particles and nodes.");
    t.check(check_cells);
    return t;
  }();
  return table;
}

const Table<NumericsSpec>& numerics_keys() {
  using coupling::DragStep;
  using coupling::LockingCure;
  using coupling::PointPressure;
  using coupling::PressureMethod;
  using coupling::StressOrder;
  using coupling::Transfer;
  static const Table<NumericsSpec> table = [] {
    Table<NumericsSpec> t;
    t.add("order", choice<StressOrder>({{"musl", StressOrder::musl}, {"usl", StressOrder::usl}}),
          &NumericsSpec::order,
          "Stresses from the re-mapped momentum of the moved particles (musl) or from the updated grid "
          "velocity (usl).");
    t.add("transfer",
          choice<Transfer>({{"flip", Transfer::flip}, {"apic", Transfer::apic}, {"tpic", Transfer::tpic}}),
          &NumericsSpec::transfer, "Velocity between particles and grid: FLIP/PIC blend, affine, or Taylor.");
    t.add(
         "flip", number(dimension::kNone, {.min = 0, .max = 1}), &NumericsSpec::flip,
         "Share of FLIP in the blend; the rest is PIC. Where the pressure is explicit (formulations higo, "
         "u-p, v-w; "
         "pressure compressible) that of a step of the skeleton, spread over the shorter ones that the water "
         "asks for.")
        .only_with("transfer", "transfer = \"flip\"",
                   [](const NumericsSpec& n) { return n.transfer == Transfer::flip; });
    t.add("locking",
          choice<LockingCure>({{"automatic", LockingCure::automatic},
                               {"none", LockingCure::none},
                               {"cell-average", LockingCure::cell_average}}),
          &NumericsSpec::locking,
          "Cure of volumetric locking: cell-average takes one volumetric strain for a cell; automatic "
          "decides by the "
          "materials.");
    t.add("water_transfer", choice<Transfer>({{"flip", Transfer::flip}, {"apic", Transfer::apic}}),
          &NumericsSpec::water_transfer,
          "The same between particles of water and the grid, in formulations with such: a FLIP/PIC blend, or "
          "affine, which is quieter in free water but gains energy in soil under musl.");
    t.add("water_flip", number(dimension::kNone, {.min = 0, .max = 1}), &NumericsSpec::water_flip,
          "Share of FLIP in that blend.")
        .only_with("water_transfer", "water_transfer = \"flip\"",
                   [](const NumericsSpec& n) { return n.water_transfer == Transfer::flip; });
    t.add("pressure",
          choice<PressureMethod>(
              {{"projected", PressureMethod::projected}, {"compressible", PressureMethod::compressible}}),
          &NumericsSpec::pressure,
          "Pore pressure in formulations with particles of water that keep its inertia: solved for in each "
          "step, or explicitly from the bulk modulus of the water, which limits the step.");
    t.add("drag_step",
          choice<DragStep>({{"implicit", DragStep::implicit}, {"explicit", DragStep::by_last_velocities}}),
          &NumericsSpec::drag,
          "Drag between grains and water in formulation v-w: implicit at each node, for any conductivity, or "
          "by "
          "the velocities of the last step, as published, which limits the step.");
    t.add(
        "point_pressure",
        choice<PointPressure>({{"cell-mean", PointPressure::cell_mean},
                               {"points", PointPressure::points},
                               {"mixed", PointPressure::mixed}}),
        &NumericsSpec::point_pressure,
        "Pore pressure in formulations u-p and v-w: points of one cell share their mean head; each keeps its "
        "own; or, mixed, cells full of points are integrated at their centre and the others by points.");
    t.add("smooth_rates", boolean(), &NumericsSpec::smooth_rates,
          "Smooth the change of volume that pore pressure follows over the nodes, in formulations u-p and "
          "v-w.");
    t.add("time_step", number(dimension::kTime, kPositive), &NumericsSpec::time_step,
          "Fixed time step; without it the step is chosen from the limits.");
    t.add("courant", number(dimension::kNone, {.min = 0, .max = 1.5, .min_open = true}),
          &NumericsSpec::courant,
          "Time step as a share of cell over drained wave speed, where the pressure is explicit "
          "(formulations higo, "
          "u-p, v-w; pressure compressible) of what the water allows, which is far less; the stable limit, "
          "1.7 or "
          "more for musl, is what explain prints. Damped stages take 1 at most, because damping shortens it; "
          "formulations with particles of water 0.5.")
        .only_with("time_step", "time_step absent", [](const NumericsSpec& n) { return !n.time_step; });
    t.add("rhie_chow", number(dimension::kNone, {.min = 0, .max = 1}), &NumericsSpec::rhie_chow,
          "Coefficient of the term that damps checkerboard patterns of the pore pressure.");
    t.add("solver_tolerance", number(dimension::kNone, {.min = 1e-14, .max = 1e-2}),
          &NumericsSpec::solver_tolerance,
          "Relative residual to which the pressure system is solved; of unsaturated flow, water left over in "
          "a step as a share of what moves, a hundred times as much where the skeleton moves. Formulation "
          "higo solves no system in stages of motion.");
    t.add(
        "cell_means", boolean(), &NumericsSpec::cell_means,
        "Retention curves and flows through upright faces as means over the height of a cell in which water "
        "hangs at rest: a free surface then passes evenly through cells that are larger than the capillary "
        "fringe. Only where all stages are of mode \"seepage\".");
    const auto sleeps = [](const NumericsSpec& n) { return n.sleep; };
    t.add("sleep", boolean(), &NumericsSpec::sleep,
          "In dynamic stages soil that has come to rest is put to sleep, block by block of the grid, until "
          "forces, motion or pore pressure wake it: faster, with a small error. Formulations dry and "
          "one-layer.");
    t.add("sleep_velocity", number(dimension::kVelocity, kNotNegative), &NumericsSpec::sleep_velocity,
          "Nodes slower than this rest: soil that creeps so slowly stands still instead. 0: 0.003 of "
          "sqrt(g cell).")
        .only_with("sleep", "sleep = true", sleeps);
    t.add("sleep_delay", number(dimension::kTime, kNotNegative), &NumericsSpec::sleep_delay,
          "How long they must rest before they sleep. 0: 15 sqrt(cell / g).")
        .only_with("sleep", "sleep = true", sleeps);
    t.add("sleep_force", number(dimension::kNone, {.min = 0, .max = 1, .min_open = true}),
          &NumericsSpec::sleep_force,
          "Out-of-balance force over weight, of a block, that wakes it; half of it must not be passed to "
          "fall asleep.")
        .only_with("sleep", "sleep = true", sleeps);
    return t;
  }();
  return table;
}

const Table<Scene>& case_keys() {
  static const Table<Scene> table = [] {
    std::string coupling::Material::*const material_name = &coupling::Material::name;
    Table<Scene> t;
    t.add("title", text(), &Scene::title, "What the case is, for people.");
    t.add(
        "effort",
        choice<coupling::Effort>({{"quick", coupling::Effort::quick},
                                  {"normal", coupling::Effort::normal},
                                  {"extensive", coupling::Effort::extensive}}),
        &Scene::effort,
        "How long it takes, for `polder verify`: quick, a few seconds, is all that --quick runs; normal, up "
        "to a minute; extensive runs only with --all or by name.");
    t.add("formulation", word(formulation_names(true), formulation_names(false)), &Scene::formulation,
          "How the pore water is computed; dry: not at all.");
    t.add("grid", one_table(grid_keys()), &Scene::grid, "The background grid.").required();
    t.add("gravity", vector(dimension::kAcceleration), &Scene::gravity,
          "Acceleration of gravity; in 3D the default is [0, 0, -9.81].");
    t.add("numerics", one_table(numerics_keys()), &Scene::numerics,
          "How it is computed; the defaults are meant to be kept.");
    t.add("pore_water", one_table(pore_water_keys()), &Scene::water,
          "Properties and initial state of the pore water.");
    t.add("material", named_tables(material_keys(), material_name), &Scene::materials,
          "Materials, by name; needed by bodies.");
    t.add("body", list_of_tables(body_keys()), &Scene::bodies,
          "Bodies of one material each; at least one, or a water_body.");
    t.add(
        "water_body", list_of_tables(water_body_keys()), &Scene::water_bodies,
        "Water that stands or moves by itself: reservoirs, waves, floods; in formulations in which water has "
        "particles of its own. Where it overlaps a body the soil keeps its place.");
    t.add("boundary", list_of_tables(boundary_keys()), &Scene::boundaries,
          "Mechanical boundaries. A side of the grid without one is a roller.");
    t.add("water", list_of_tables(water_keys()), &Scene::water_boundaries,
          "Where water enters or leaves: parts of the grid's sides, which are impermeable elsewhere, or of "
          "the soil's "
          "surface.");
    t.add("water_line", list_of_tables(water_line_keys()), &Scene::water_lines,
          "Wells, drains and impermeable sheets inside the soil (2D, with retention curves).");
    t.add("stage", list_of_tables(stage_keys()), &Scene::stages,
          "Stages of the simulation, one after the other.")
        .required();
    t.add("measure", list_of_tables(measure_keys()), &Scene::measures, "Quantities recorded over time.");
    t.add("expect", list_of_tables(expect_keys()), &Scene::expectations,
          "What `polder verify` compares measures with.");
    t.add("output", one_table(output_keys()), &Scene::output, "What is written, and how often.");
    t.check([](Scene& scene, const std::string&, Reader& reader) {
      if (scene.dimension() == 3 && !reader.given("gravity")) scene.gravity = {0, 0, -9.81};
      const auto not_empty = [&](const std::string& key, bool empty) {
        if (empty && reader.given(key) && !reader.failed(key)) reader.error(key, "is empty", "at least one");
      };
      not_empty("material", scene.materials.empty());
      not_empty("body", scene.bodies.empty());
      not_empty("stage", scene.stages.empty());
      if (scene.water_bodies.empty() && !reader.given("water_body")) {
        if (!reader.given("material")) reader.error("material", "missing", "[material.NAME]");
        if (!reader.given("body")) reader.error("body", "missing", "[[body]]");
      }
    });
    return t;
  }();
  return table;
}

}  // namespace polder::app
