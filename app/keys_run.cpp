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
          choice<Stage::Mode>({{"equilibrium", Stage::Mode::equilibrium},
                               {"seepage", Stage::Mode::seepage},
                               {"quasi-static", Stage::Mode::quasi_static},
                               {"dynamic", Stage::Mode::dynamic}}),
          &Stage::mode,
          "equilibrium: until the forces balance, by relaxation, or by damped motion where damping is given; "
          "seepage: water flows through a rigid skeleton; quasi-static: the "
          "skeleton follows in equilibrium while water flows; dynamic: with inertia.")
        .required();
    t.add("until",
          choice<Stage::Until>({{"duration", Stage::Until::duration},
                                {"failure", Stage::Until::failure},
                                {"steady", Stage::Until::steady}}),
          &Stage::until,
          "What ends the stage at the latest after its duration. failure (quasi-static): failure_share of "
          "the soil "
          "has moved by failure_displacement. steady (seepage): the flow does not change any more.");
    t.add("duration", number(dimension::kTime, kPositive), &Stage::duration,
          "Simulated time; of an equilibrium stage, or one that an event ends, at most.")
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
          &Stage::force_tolerance, "Out-of-balance force ratio that counts as equilibrium.")
        .only_with("mode", "mode = \"equilibrium\" or \"quasi-static\"", [](const Stage& s) {
          return s.mode == Stage::Mode::equilibrium || s.mode == Stage::Mode::quasi_static;
        });
    t.add("energy_tolerance", number(dimension::kNone, {.min = 0, .max = 1, .min_open = true}),
          &Stage::energy_tolerance, "Kinetic energy ratio below which an equilibrium stage ends.")
        .only_with("mode", with_equilibrium, equilibrium);
    t.add("reset_displacement", boolean(), &Stage::reset_displacement,
          "At the end of the stage displacements and plastic strains start from zero.");
    t.add("reset_velocity", boolean(), &Stage::reset_velocity,
          "At the end of the stage the soil is brought to rest.");
    t.add("output_every", number(dimension::kTime, kNotNegative), &Stage::output_every,
          "Simulated time between frames in this stage; 0: as [output] says.");
    t.add("history_every", number(dimension::kTime, kNotNegative), &Stage::history_every,
          "Simulated time between lines of the history in this stage; 0: as [output] says.");
    const auto slow = [](const Stage& s) {
      return s.mode == Stage::Mode::seepage || s.mode == Stage::Mode::quasi_static;
    };
    const auto quasi_static = [](const Stage& s) { return s.mode == Stage::Mode::quasi_static; };
    const std::string with_slow = "mode = \"seepage\" or \"quasi-static\"",
                      with_quasi_static = "mode = \"quasi-static\"";
    t.add("first_step", number(dimension::kTime, kNotNegative), &Stage::first_step,
          "First step of the water; 0: a hundred-thousandth of the duration. Later ones follow the iteration "
          "count.")
        .only_with("mode", with_slow, slow);
    t.add("largest_step", number(dimension::kTime, kNotNegative), &Stage::largest_step,
          "Largest step of the water; 0: a hundredth of the duration, with until = \"steady\" no limit.")
        .only_with("mode", with_slow, slow);
    t.add("steady_rate", number(dimension::kVelocity, kPositive), &Stage::steady_rate,
          "Change of the head with time, anywhere, below which the flow is steady.")
        .only_with("until", "until = \"steady\"",
                   [](const Stage& s) { return s.until == Stage::Until::steady; });
    t.add("relax_change", number(dimension::kPressure, kNotNegative), &Stage::relax_change,
          "Change of the pore pressure, anywhere, after which equilibrium is sought again; 0: two hundredths "
          "of the "
          "hydrostatic pressure over the height of the soil.")
        .only_with("mode", with_quasi_static, quasi_static);
    t.add("relaxation_steps", integer(100, 1000000), &Stage::relaxation_steps,
          "Most steps of one search for equilibrium. Where it ends without one, soil yields on: the next "
          "search goes on "
          "from there.")
        .only_with("mode", with_quasi_static, quasi_static);
    t.add("failure_displacement", number(dimension::kLength, kNotNegative), &Stage::failure_displacement,
          "The first point that has moved so far since the stage began is reported as a local failure; 0: "
          "half a cell.")
        .only_with("mode", with_quasi_static, quasi_static);
    t.add("failure_share", number(dimension::kNone, {.min = 0, .max = 1, .min_open = true}),
          &Stage::failure_share, "Share of the soil's volume that has moved so far when the soil has failed.")
        .only_with("mode", with_quasi_static, quasi_static);
    t.check([](Stage& s, const std::string& path, Reader& reader) {
      if (s.until == Stage::Until::failure && s.mode != Stage::Mode::quasi_static && !reader.failed(path))
        reader.error(key_path(path, "until"), "\"failure\" ends quasi-static stages only",
                     "mode = \"quasi-static\"");
      if (s.until == Stage::Until::steady && s.mode != Stage::Mode::seepage && !reader.failed(path))
        reader.error(key_path(path, "until"), "\"steady\" ends seepage stages only", "mode = \"seepage\"");
      const auto refuse = [&](const char* name, bool ignored, const char* why, const char* allowed) {
        if (ignored && !reader.failed(key_path(path, name)) && !reader.failed(key_path(path, "mode")))
          reader.error(key_path(path, name), why, allowed);
      };
      refuse("damping", s.damping > 0 && !s.moves(), "nothing moves with inertia while water seeps",
             "mode = \"equilibrium\" or \"dynamic\"");
      refuse("water_flows", !s.water_flows && !s.moves(), "the stage is about the flow of water",
             "true; or mode = \"equilibrium\"");
      const bool rigid = s.mode == Stage::Mode::seepage;
      refuse("plastic", !s.plastic && rigid, "the skeleton is rigid", "mode = \"quasi-static\"");
      refuse("sticking", s.sticking && rigid, "the skeleton is rigid", "mode = \"quasi-static\"");
      if (s.gravity_ramp > 0 && !s.moves() && !reader.failed(path))
        reader.error(key_path(path, "gravity_ramp"), "gravity does not change while water seeps",
                     "mode = \"equilibrium\" or \"dynamic\"");
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
