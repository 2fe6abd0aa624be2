#include "io/vtkhdf.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/hdf5_file.hpp"
#include "io/json.hpp"

namespace polder {
namespace fs = std::filesystem;
namespace {

constexpr char kExtension[] = ".hdf";
constexpr int kDigits = 6;  // of the frame number, so that names sort

struct ShapeTraits {
  std::uint8_t vtk_type;  // vtkCellType.h
  std::size_t corners;
};

ShapeTraits traits(CellShape shape) {
  switch (shape) {
    case CellShape::quad:
      return {9, 4};
    case CellShape::hexahedron:
      return {12, 8};
    case CellShape::vertex:
      break;
  }
  return {1, 1};
}

[[noreturn]] void misuse(const std::string& what) {
  throw std::invalid_argument("frame: " + what);
}

void check_array(const FrameArray& array, std::size_t count) {
  const int c = array.components;
  if (c != 1 && c != 3 && c != 6 && c != 9) misuse(array.name + " has " + std::to_string(c) + " components");
  const std::size_t size = std::visit([](auto values) { return values.size(); }, array.values);
  if (size != count * static_cast<std::size_t>(c)) {
    misuse(array.name + " has " + std::to_string(size) + " values, " + std::to_string(count) + " x " +
           std::to_string(c) + " expected");
  }
}

template <class T>
hid_t stored_type() {
  return std::is_floating_point_v<T> ? hdf5::file_type<float>() : hdf5::file_type<T>();
}

void put_arrays(hdf5::Image& image, const std::string& group, const std::vector<FrameArray>& arrays,
                std::size_t count) {
  image.group(group);
  for (const FrameArray& array : arrays) {
    check_array(array, count);
    std::visit(
        [&]<class T>(std::span<const T> values) {
          const hsize_t columns = array.components == 1 ? 0 : static_cast<hsize_t>(array.components);
          image.dataset(group + "/" + array.name, values, columns, stored_type<T>());
        },
        array.values);
  }
}

std::size_t expected_bytes(const Frame& frame, std::size_t points, std::size_t cells) {
  std::size_t bytes = 4096 + points * 3 * sizeof(float) + frame.cells.size() * 8 + cells * 17;
  for (const auto* arrays : {&frame.point_data, &frame.cell_data}) {
    for (const FrameArray& array : *arrays) {
      bytes += 1024 + std::visit(
                          [](auto values) {
                            using T = typename decltype(values)::value_type;
                            return values.size() * (std::is_floating_point_v<T> ? sizeof(float) : sizeof(T));
                          },
                          array.values);
    }
  }
  return bytes;
}

}  // namespace

void write_frame(const fs::path& path, const Frame& frame) {
  const ShapeTraits shape = traits(frame.shape);
  const auto dimension = static_cast<std::size_t>(frame.dimension);
  if (dimension != 2 && dimension != 3) misuse("points have 2 or 3 coordinates");
  if (frame.points.size() % dimension != 0) misuse("coordinates do not fill the last point");
  if (frame.shape == CellShape::vertex && !frame.cells.empty())
    misuse("vertex cells are implied, one per point");
  if (frame.cells.size() % shape.corners != 0) misuse("point numbers do not fill the last cell");
  const std::size_t points = frame.points.size() / dimension;
  const bool vertices = frame.shape == CellShape::vertex;
  const std::size_t cells = vertices ? points : frame.cells.size() / shape.corners;

  std::vector<float> position(points * 3, 0.0f);
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t d = 0; d < dimension; ++d) {
      position[i * 3 + d] = static_cast<float>(frame.points[i * dimension + d]);
    }
  }
  std::vector<std::int64_t> connectivity(cells * shape.corners);
  if (vertices) {
    for (std::size_t i = 0; i < cells; ++i) connectivity[i] = static_cast<std::int64_t>(i);
  } else {
    std::copy(frame.cells.begin(), frame.cells.end(), connectivity.begin());
    for (const std::int64_t corner : connectivity) {
      if (corner < 0 || static_cast<std::size_t>(corner) >= points)
        misuse("a cell names a point that is not there");
    }
  }
  std::vector<std::int64_t> offsets(cells + 1);
  for (std::size_t i = 0; i <= cells; ++i) offsets[i] = static_cast<std::int64_t>(i * shape.corners);
  const std::vector<std::uint8_t> types(cells, shape.vtk_type);

  hdf5::Image image(path, expected_bytes(frame, points, cells));
  const auto one_number = [&](const char* name, std::size_t n) {
    const auto value = static_cast<std::int64_t>(n);
    image.dataset(name, std::span<const std::int64_t>(&value, 1));
  };
  image.group("VTKHDF");
  const std::int64_t version[2] = {1, 0};
  image.attribute("VTKHDF", "Version", std::span<const std::int64_t>(version));
  image.attribute("VTKHDF", "Type", "UnstructuredGrid");
  one_number("VTKHDF/NumberOfPoints", points);
  one_number("VTKHDF/NumberOfCells", cells);
  one_number("VTKHDF/NumberOfConnectivityIds", connectivity.size());
  image.dataset("VTKHDF/Points", std::span<const float>(position), 3, hdf5::file_type<float>());
  image.dataset("VTKHDF/Connectivity", std::span<const std::int64_t>(connectivity));
  image.dataset("VTKHDF/Offsets", std::span<const std::int64_t>(offsets));
  image.dataset("VTKHDF/Types", std::span<const std::uint8_t>(types));
  put_arrays(image, "VTKHDF/PointData", frame.point_data, points);
  put_arrays(image, "VTKHDF/CellData", frame.cell_data, cells);
  image.dataset("VTKHDF/FieldData/TimeValue", std::span<const double>(&frame.time, 1));
  image.write();
}

double frame_time(const fs::path& path) {
  const std::vector<double> time = hdf5::Reader(path).dataset<double>("VTKHDF/FieldData/TimeValue");
  if (time.size() != 1)
    throw EnvironmentError(path.string() + ": VTKHDF/FieldData/TimeValue: is not one number");
  return time[0];
}

FrameSeries::FrameSeries(fs::path folder, std::string name)
    : FrameSeries(std::move(folder), std::move(name), std::numeric_limits<double>::infinity()) {}

FrameSeries::FrameSeries(fs::path folder, std::string name, double keep_until)
    : folder_(std::move(folder)), name_(std::move(name)) {
  std::error_code error;
  fs::directory_iterator files(folder_, error);
  if (error) throw_file_error(folder_, "cannot be listed", error.value());

  // name_NNNNNN.hdf, exactly: soil_1_000003.hdf belongs to the set soil_1.
  const std::string prefix = name_ + "_";
  std::vector<std::pair<int, std::string>> found;
  for (const fs::directory_entry& entry : files) {
    const std::string file = entry.path().filename().string();
    if (!file.starts_with(prefix)) continue;
    int number = 0;
    const char* last = file.data() + file.size();
    const auto [end, status] = std::from_chars(file.data() + prefix.size(), last, number);
    if (status != std::errc{} || number < 0) continue;
    const std::string_view rest(end, last);
    if (rest == kExtension) found.emplace_back(number, file);
    if (rest == std::string(kExtension) + std::string(kTemporarySuffix)) fs::remove(entry.path(), error);
  }
  std::sort(found.begin(), found.end());

  bool dropped = false;
  for (const auto& [number, file] : found) {
    double time = 0.0;
    try {
      time = frame_time(folder_ / file);
    } catch (const EnvironmentError&) {
      damaged_.push_back(file);
      next_number_ = number + 1;
      continue;
    }
    if (time > keep_until) {
      if (!fs::remove(folder_ / file, error) && error) {
        throw_file_error(folder_ / file, "cannot be removed", error.value());
      }
      dropped = true;
      continue;
    }
    entries_.push_back({file, time});
    next_number_ = number + 1;
  }
  if (dropped || !found.empty()) write_index();
}

fs::path FrameSeries::write(const Frame& frame) {
  char number[16];
  std::snprintf(number, sizeof number, "_%0*d", kDigits, next_number_);
  const std::string file = name_ + number + kExtension;
  write_frame(folder_ / file, frame);
  entries_.push_back({file, frame.time});
  ++next_number_;
  write_index();
  return folder_ / file;
}

void FrameSeries::write_index() const {
  Json files = Json::array();
  for (const Entry& entry : entries_) {
    Json item = Json::object();
    item["name"] = entry.file;
    item["time"] = entry.time;
    files.push_back(std::move(item));
  }
  Json index = Json::object();
  index["file-series-version"] = "1.0";
  index["files"] = std::move(files);
  write_file_atomically(folder_ / (name_ + kExtension + ".series"), index.text());
}

}  // namespace polder
