// Frames of results that ParaView 5.11 and newer, VTK and h5py open: VTKHDF 1.0 UnstructuredGrid.
//
// One file per set and frame, soil_000120.hdf, and beside them soil.hdf.series, a JSON list of the files with
// their times (without it readers count frames instead of showing seconds). A file is complete or absent
// (atomic_file.hpp). Points and floating-point arrays are stored in single precision; integers keep theirs.
// SI units, the signs of the caller: Polder's frames hold effective stress positive in tension and pore
// pressure positive in compression.
//
// Format: VTK 9.2 documentation, "VTKHDF file format", version 1.0.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace polder {

// Values of one quantity on all points or cells: components of one point together, points one after another.
// Symmetric tensors have the 6 components xx, yy, zz, xy, yz, zx (in plane problems too), full ones 9,
// vectors 3.
struct FrameArray {
  std::string name;
  int components = 1;  // 1, 3, 6 or 9
  std::variant<std::span<const double>, std::span<const float>, std::span<const std::int32_t>,
               std::span<const std::int64_t>>
      values;
};

enum class CellShape { vertex, quad, hexahedron };

struct Frame {
  double time = 0.0;               // [s]
  int dimension = 3;               // coordinates per point in `points`, 2 or 3; two are written with z = 0
  std::span<const double> points;  // [m]
  CellShape shape = CellShape::vertex;  // vertex: one cell per point, `cells` stays empty
  std::span<const std::int64_t>
      cells;  // point numbers, 4 or 8 per cell, in VTK's order: lower face counter-clockwise
  std::vector<FrameArray> point_data;
  std::vector<FrameArray> cell_data;
};

// Throws EnvironmentError if the disk refuses, std::invalid_argument if the sizes of the arrays do not fit
// together.
void write_frame(const std::filesystem::path& path, const Frame& frame);

// Time of a written frame; EnvironmentError if the file is damaged or something else.
double frame_time(const std::filesystem::path& path);

// The frames of one set in a run's folder and their index.
class FrameSeries {
 public:
  struct Entry {
    std::string file;  // name without folder
    double time = 0.0;
  };

  // Takes up the frames already there, in order of their numbers. Those later than `keep_until` belong to a
  // future that a restart computes again: they are deleted. Unreadable ones are left alone and listed in
  // damaged().
  FrameSeries(std::filesystem::path folder, std::string name, double keep_until);
  // All present frames are kept; in a fresh folder there are none.
  FrameSeries(std::filesystem::path folder, std::string name);

  // Writes the next frame, then the index. Returns the frame's path.
  std::filesystem::path write(const Frame& frame);

  int next_number() const { return next_number_; }
  const std::vector<Entry>& entries() const { return entries_; }
  const std::vector<std::string>& damaged() const { return damaged_; }

 private:
  void write_index() const;

  std::filesystem::path folder_;
  std::string name_;
  int next_number_ = 0;
  std::vector<Entry> entries_;
  std::vector<std::string> damaged_;
};

}  // namespace polder
