// VTKHDF frames: written, read back through HDF5, indexed, and taken up again by a restart.
// tests/plot reads the same kind of files with h5py.
#include <doctest/doctest.h>

#include <stdexcept>
#include <vector>

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/hdf5_file.hpp"
#include "io/vtkhdf.hpp"
#include "tests/unit/io_support.hpp"

using namespace polder;
using polder::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

Frame cloud(double time, const std::vector<double>& points) {
  Frame frame;
  frame.time = time;
  frame.dimension = 2;
  frame.points = points;
  return frame;
}

}  // namespace

TEST_CASE("a cloud of points comes back with its arrays, padded to three dimensions") {
  const TemporaryFolder folder;
  const std::vector<double> points = {0.1, 0.2, 1.5, -2.5, 3.0, 4.0};
  const std::vector<double> pressure = {1.0, -2.0, 1e5};
  const std::vector<float> velocity = {1, 2, 0, 3, 4, 0, 5, 6, 0};
  const std::vector<double> stress(18, -1234.5);
  const std::vector<double> gradient(27, 0.25);
  const std::vector<std::int64_t> id = {7, 16777217, 9};  // 2^24 + 1 is not a single-precision number
  Frame frame = cloud(12.75, points);
  frame.point_data = {{"pore_pressure", 1, std::span<const double>(pressure)},
                      {"velocity", 3, std::span<const float>(velocity)},
                      {"effective_stress", 6, std::span<const double>(stress)},
                      {"gradient", 9, std::span<const double>(gradient)},
                      {"id", 1, std::span<const std::int64_t>(id)}};
  write_frame(folder / "soil_000000.hdf", frame);

  const hdf5::Reader file(folder / "soil_000000.hdf");
  CHECK(file.text_attribute("VTKHDF", "Type") == "UnstructuredGrid");
  CHECK(file.attribute<std::int64_t>("VTKHDF", "Version") == std::vector<std::int64_t>{1, 0});
  CHECK(file.dataset<std::int64_t>("VTKHDF/NumberOfPoints") == std::vector<std::int64_t>{3});
  CHECK(file.dataset<std::int64_t>("VTKHDF/NumberOfCells") == std::vector<std::int64_t>{3});
  CHECK(file.dataset<float>("VTKHDF/Points", true) ==
        std::vector<float>{0.1f, 0.2f, 0, 1.5f, -2.5f, 0, 3.0f, 4.0f, 0});
  CHECK(file.dataset<std::int64_t>("VTKHDF/Connectivity") == std::vector<std::int64_t>{0, 1, 2});
  CHECK(file.dataset<std::int64_t>("VTKHDF/Offsets") == std::vector<std::int64_t>{0, 1, 2, 3});
  CHECK(file.dataset<std::uint8_t>("VTKHDF/Types") == std::vector<std::uint8_t>{1, 1, 1});
  CHECK(file.dataset<float>("VTKHDF/PointData/pore_pressure", true) == std::vector<float>{1, -2, 1e5f});
  CHECK(file.dataset<float>("VTKHDF/PointData/velocity", true) == velocity);
  CHECK(file.dataset<float>("VTKHDF/PointData/effective_stress", true) == std::vector<float>(18, -1234.5f));
  CHECK(file.dataset<float>("VTKHDF/PointData/gradient", true) == std::vector<float>(27, 0.25f));
  CHECK(file.dataset<std::int64_t>("VTKHDF/PointData/id", true) == id);
  CHECK(frame_time(folder / "soil_000000.hdf") == 12.75);
  CHECK_FALSE(fs::exists(folder / "soil_000000.hdf.tmp"));
}

TEST_CASE("cells: a quad and a hexahedron with cell and point data") {
  const TemporaryFolder folder;
  const std::vector<double> square = {0, 0, 1, 0, 1, 1, 0, 1};
  const std::vector<std::int64_t> quad = {0, 1, 2, 3};
  const std::vector<double> one = {42.0};
  const std::vector<double> four = {1, 2, 3, 4};
  Frame frame = cloud(1.0, square);
  frame.shape = CellShape::quad;
  frame.cells = quad;
  frame.cell_data = {{"head", 1, std::span<const double>(one)}};
  frame.point_data = {{"corner", 1, std::span<const double>(four)}};
  write_frame(folder / "quad.hdf", frame);
  const hdf5::Reader plane(folder / "quad.hdf");
  CHECK(plane.dataset<std::uint8_t>("VTKHDF/Types") == std::vector<std::uint8_t>{9});
  CHECK(plane.dataset<std::int64_t>("VTKHDF/Connectivity") == quad);
  CHECK(plane.dataset<std::int64_t>("VTKHDF/Offsets") == std::vector<std::int64_t>{0, 4});
  CHECK(plane.dataset<float>("VTKHDF/CellData/head") == std::vector<float>{42});
  CHECK(plane.dataset<float>("VTKHDF/PointData/corner") == std::vector<float>{1, 2, 3, 4});

  std::vector<double> cube;
  for (double z : {0.0, 1.0}) cube.insert(cube.end(), {0, 0, z, 1, 0, z, 1, 1, z, 0, 1, z});
  const std::vector<std::int64_t> corners = {0, 1, 2, 3, 4, 5, 6, 7};
  Frame block;
  block.points = cube;
  block.shape = CellShape::hexahedron;
  block.cells = corners;
  block.cell_data = {{"head", 1, std::span<const double>(one)}};
  write_frame(folder / "cube.hdf", block);
  const hdf5::Reader solid(folder / "cube.hdf");
  CHECK(solid.dataset<std::uint8_t>("VTKHDF/Types") == std::vector<std::uint8_t>{12});
  CHECK(solid.dataset<std::int64_t>("VTKHDF/NumberOfConnectivityIds") == std::vector<std::int64_t>{8});
}

TEST_CASE("an empty set is a file like any other") {
  const TemporaryFolder folder;
  const std::vector<double> nothing;
  Frame frame = cloud(3.0, nothing);
  frame.point_data = {{"velocity", 3, std::span<const double>(nothing)}};
  write_frame(folder / "water_000000.hdf", frame);
  const hdf5::Reader file(folder / "water_000000.hdf");
  CHECK(file.dataset<std::int64_t>("VTKHDF/NumberOfPoints") == std::vector<std::int64_t>{0});
  CHECK(file.dataset<std::int64_t>("VTKHDF/Offsets") == std::vector<std::int64_t>{0});
  CHECK(file.dataset<float>("VTKHDF/Points").empty());
  CHECK(file.has("VTKHDF/PointData/velocity"));
}

TEST_CASE("arrays that do not fit are refused before a file appears") {
  const TemporaryFolder folder;
  const std::vector<double> points = {0, 0, 1, 1};
  const std::vector<double> three = {1, 2, 3};
  Frame frame = cloud(0.0, points);
  frame.point_data = {{"pore_pressure", 1, std::span<const double>(three)}};
  CHECK(test::message_of<std::invalid_argument>([&] { write_frame(folder / "a.hdf", frame); }) ==
        "frame: pore_pressure has 3 values, 2 x 1 expected");
  frame.point_data = {{"pair", 2, std::span<const double>(points)}};
  CHECK_THROWS_AS(write_frame(folder / "a.hdf", frame), std::invalid_argument);
  frame.point_data.clear();
  frame.shape = CellShape::quad;
  const std::vector<std::int64_t> beyond = {0, 1, 2, 1};
  frame.cells = beyond;
  CHECK_THROWS_AS(write_frame(folder / "a.hdf", frame), std::invalid_argument);
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("the index lists files with times and follows a restart") {
  const TemporaryFolder folder;
  const std::vector<double> points = {0, 0};
  {
    FrameSeries series(folder.path(), "soil");
    for (int i = 0; i < 4; ++i) series.write(cloud(0.25 * i, points));
    CHECK(series.next_number() == 4);
    FrameSeries other(folder.path(), "soil_wall");
    other.write(cloud(9.0, points));
  }
  CHECK(read_file(folder / "soil.hdf.series").find("\"name\": \"soil_000003.hdf\",\n      \"time\": 0.75") !=
        std::string::npos);

  fs::remove(folder / "soil.hdf.series");
  test::write_text(folder / "soil_000004.hdf.tmp", "half a frame");
  FrameSeries restarted(folder.path(), "soil", 0.5);
  CHECK(restarted.next_number() == 3);
  REQUIRE(restarted.entries().size() == 3);
  CHECK(restarted.entries()[2].time == 0.5);
  CHECK_FALSE(fs::exists(folder / "soil_000003.hdf"));
  CHECK_FALSE(fs::exists(folder / "soil_000004.hdf.tmp"));
  CHECK(fs::exists(folder / "soil_wall_000000.hdf"));
  const std::string index = read_file(folder / "soil.hdf.series");
  CHECK(index.find("\"file-series-version\": \"1.0\"") != std::string::npos);
  CHECK(index.find("soil_000002.hdf") != std::string::npos);
  CHECK(index.find("soil_000003.hdf") == std::string::npos);
  CHECK(index.find("soil_wall") == std::string::npos);
}

TEST_CASE("a damaged frame is named and left out of the index, its number is not used again") {
  const TemporaryFolder folder;
  const std::vector<double> points = {0, 0};
  FrameSeries(folder.path(), "soil").write(cloud(0.0, points));
  test::write_text(folder / "soil_000001.hdf", "not HDF5");
  FrameSeries series(folder.path(), "soil");
  CHECK(series.damaged() == std::vector<std::string>{"soil_000001.hdf"});
  CHECK(series.write(cloud(1.0, points)) == folder / "soil_000002.hdf");
}

TEST_CASE("a full disk and a missing folder are environment errors, and the old frame survives") {
  const TemporaryFolder folder;
  const std::vector<double> points(200000, 0.5);
  write_frame(folder / "soil_000000.hdf", cloud(1.0, points));
  {
    const test::FileSizeLimit limit(100000);
    const std::string message = test::message_of<EnvironmentError>(
        [&] { write_frame(folder / "soil_000000.hdf", cloud(2.0, points)); });
    CHECK(message == (folder / "soil_000000.hdf").string() + ": cannot be written: File too large");
  }
  CHECK(frame_time(folder / "soil_000000.hdf") == 1.0);
  CHECK_FALSE(fs::exists(folder / "soil_000000.hdf.tmp"));
  CHECK(test::message_of<EnvironmentError>([&] {
          write_frame(folder / "no/such.hdf", cloud(2.0, points));
        }) == (folder / "no/such.hdf").string() + ": cannot be written: No such file or directory");
}
