#include "app/frames.hpp"

#include <deque>
#include <memory>

#include "app/checkpoint_state.hpp"

namespace polder::app {
namespace {

using coupling::FieldView;
using coupling::Simulation;

// Numbers of points, bodies and materials stay integers: single precision would round them.
bool is_label(const std::string& name) {
  return name == "id" || name == "body" || name == "material";
}

using Labels = std::deque<std::vector<std::int32_t>>;

std::vector<FrameArray> arrays(const std::vector<FieldView>& fields, Labels& labels) {
  std::vector<FrameArray> list;
  for (const FieldView& f : fields) {
    if (is_label(f.name)) {
      const auto& values = labels.emplace_back(f.values.begin(), f.values.end());
      list.push_back({f.name, f.components, std::span<const std::int32_t>(values)});
    } else {
      list.push_back({f.name, f.components, std::span<const double>(f.values)});
    }
  }
  return list;
}

// What the frames of one moment hold.
struct Content {
  double time = 0;  // [s]
  coupling::PointFrame soil, water;
  coupling::CellFrame fluid;
};

void write_points(FrameSeries& series, double time, const coupling::PointFrame& points) {
  Labels labels;
  Frame frame;
  frame.time = time;
  frame.points = points.positions;
  frame.point_data = arrays(points.fields, labels);
  series.write(frame);
}

void write_cells(FrameSeries& series, double time, const coupling::CellFrame& cells) {
  Labels labels;
  Frame frame;
  frame.time = time;
  frame.points = cells.vertices;
  frame.shape = cells.corners_per_cell == 8 ? CellShape::hexahedron : CellShape::quad;
  frame.cells = cells.corners;
  frame.cell_data = arrays(cells.fields, labels);
  series.write(frame);
}

double frame_interval(const Simulation& s) {
  const coupling::Scene& scene = s.scene();
  const double own = s.finished() ? 0 : scene.stages[static_cast<std::size_t>(s.stage())].output_every;
  return own > 0 ? own : scene.output.every;
}

FrameSeries series(const RunFolder& folder, const char* name, std::optional<double> keep_until) {
  return keep_until ? FrameSeries(folder.path(), name, *keep_until) : FrameSeries(folder.path(), name);
}

}  // namespace

Frames::Frames(const Simulation& s, const RunFolder& folder, std::optional<double> keep_until,
               BackgroundWriter& writer)
    : writer_(writer), tick_(frame_interval(s)), stage_(s.stage()) {
  const coupling::Scene& scene = s.scene();
  const bool wet = coupling::find_formulation(scene.formulation)->carrier != coupling::WaterCarrier::none;
  for (const std::string& f : scene.output.fields)
    if (wet || (f != "pore_pressure" && f != "saturation")) fields_.push_back(f);
  soil_.emplace(series(folder, "soil", keep_until));
  if (wet) fluid_.emplace(series(folder, "fluid", keep_until));
  if (scene.layered()) water_.emplace(series(folder, "water", keep_until));
}

void Frames::see(const Simulation& s) {
  const bool due = tick_.due(s.time()), new_stage = s.stage() != stage_;
  // The state at the end of a stage is what the next one starts from: never left out where frames are asked
  // for.
  if (due || last_ < 0 || (new_stage && last_ < s.time() && s.scene().output.every > 0)) write(s);
  if (new_stage) tick_.set_interval(frame_interval(s), s.time());
  stage_ = s.stage();
}

void Frames::finish(const Simulation& s) {
  if (last_ < s.time()) write(s);
}

void Frames::write(const Simulation& s) {
  // A job must be copyable, its values must not be copied: they are shared.
  auto content = std::make_shared<Content>();
  content->time = s.time();
  content->soil = s.points(fields_);
  if (water_) content->water = s.water_points();
  if (fluid_) content->fluid = s.water_cells();
  writer_.submit([this, content = std::move(content)] {
    write_points(*soil_, content->time, content->soil);
    if (water_) write_points(*water_, content->time, content->water);
    if (fluid_) write_cells(*fluid_, content->time, content->fluid);
  });
  last_ = s.time();
}

void Frames::visit(CheckpointVisitor& v) {
  v.number("output/frames", tick_.count());
  v.number("output/last_frame", last_);
}

}  // namespace polder::app
