// Stages and output.
#include "app/case_keys.hpp"
#include "app/codecs.hpp"
#include "coupling/quantities.hpp"

namespace polder::app {

using coupling::OutputSpec;
using coupling::Stage;

namespace {

std::vector<std::string> frame_fields() {
  std::vector<std::string> names;
  for (const coupling::Quantity& q : coupling::frame_quantities()) names.push_back(q.name);
  return names;
}

}  // namespace

const Table<Stage>& stage_keys() {
  static const Table<Stage> table = [] {
    const auto equilibrium = [](const Stage& s) { return s.mode == Stage::Mode::equilibrium; };
    const std::string with_equilibrium = "mode = \"equilibrium\"";
    Table<Stage> t;
    t.add("name", identifier(), &Stage::name, "Name in messages and results; default: stage-1, stage-2, ...");
    t.add("mode",
          choice<Stage::Mode>({{"equilibrium", Stage::Mode::equilibrium}, {"dynamic", Stage::Mode::dynamic}},
                              {"seepage", "quasi-static"}),
          &Stage::mode,
          "equilibrium: until the forces balance, by relaxation, or by damped motion where damping is given; "
          "dynamic: with inertia, for the duration.")
        .required();
    t.add("duration", number(dimension::kTime, kPositive), &Stage::duration,
          "Simulated time; of an equilibrium stage at most.")
        .required();
    t.add(
        "damping", number(dimension::kNone, {.min = 0, .max = 1, .max_open = true}), &Stage::damping,
        "Local damping: share of the out-of-balance force that opposes the motion; of an equilibrium, 0: it "
        "is found by relaxation.");
    t.add("plastic", boolean(), &Stage::plastic, "false: the materials respond elastically.");
    t.add("sticking", boolean(), &Stage::sticking, "true: friction boundaries hold without slip.");
    t.add("water_flows", boolean(), &Stage::water_flows, "false: the pore pressure stays as it is.");
    t.add("gravity_ramp", number(dimension::kTime, kNotNegative), &Stage::gravity_ramp,
          "Time over which gravity grows from nothing; 0: full from the start.");
    t.add("force_tolerance", number(dimension::kNone, {.min = 0, .max = 1, .min_open = true}),
          &Stage::force_tolerance, "Out-of-balance force ratio below which an equilibrium stage ends.")
        .only_with("mode", with_equilibrium, equilibrium);
    t.add("energy_tolerance", number(dimension::kNone, {.min = 0, .max = 1, .min_open = true}),
          &Stage::energy_tolerance, "Kinetic energy ratio below which an equilibrium stage ends.")
        .only_with("mode", with_equilibrium, equilibrium);
    t.add("reset_displacement", boolean(), &Stage::reset_displacement,
          "At the end of the stage displacements and plastic strains start from zero.");
    t.add("reset_velocity", boolean(), &Stage::reset_velocity,
          "At the end of the stage the soil is brought to rest.");
    t.later("until", "events that end a stage");
    t.check([](Stage& s, const std::string& path, Reader& reader) {
      if (s.gravity_ramp > s.duration && !reader.failed(path))
        reader.error(key_path(path, "gravity_ramp"), "longer than the stage",
                     "at most duration, " + format_number(s.duration) + " s");
    });
    return t;
  }();
  return table;
}

const Table<OutputSpec>& output_keys() {
  static const Table<OutputSpec> table = [] {
    using O = OutputSpec;
    Table<O> t;
    t.add("fields", words(frame_fields()), &O::fields, "Fields of the soil's frames.");
    t.add("every", number(dimension::kTime, kNotNegative), &O::every,
          "Simulated time between frames; 0: first and last only.");
    t.add("history_every", number(dimension::kTime, kNotNegative), &O::history_every,
          "Simulated time between lines of the history; 0: a thousandth of the duration.");
    t.add("checkpoint", number(dimension::kTime, kPositive), &O::checkpoint_every,
          "Time of the clock on the wall between checkpoints.");
    return t;
  }();
  return table;
}

}  // namespace polder::app
