// CSV tables: written, continued after a restart, read back; and what is said about broken ones.
#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/error.hpp"
#include "io/atomic_file.hpp"
#include "io/csv.hpp"
#include "tests/unit/io_support.hpp"

using namespace polder;
using polder::test::message_of;
using polder::test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {
const std::vector<std::string> kColumns = {"time[s]", "step", "dt_limit", "energy[J]"};
}

TEST_CASE("rows of numbers, counts and words") {
  const TemporaryFolder folder;
  {
    CsvWriter writer(folder / "history.csv", kColumns, CsvWriter::Mode::fresh);
    writer.row({0.1, std::int64_t{1}, "wave", 1.0 / 3.0});
    writer.row({0.25, std::int64_t{2}, "a, \"b\"", -1e-300});
    writer.row({1e6, std::int64_t{1} << 40, "", std::nan("")});
  }
  CHECK(read_file(folder / "history.csv") ==
        "time[s],step,dt_limit,energy[J]\n0.1,1,wave,0.3333333333\n0.25,2,\"a, \"\"b\"\"\",-1e-300\n"
        "1000000,1099511627776,,nan\n");

  const CsvTable table(folder / "history.csv", {"dt_limit"});
  CHECK(table.columns() == kColumns);
  REQUIRE(table.rows() == 3);
  CHECK(table.column("time[s]")[2] == 1e6);
  CHECK(table.column("energy[J]")[1] == -1e-300);
  CHECK(std::isnan(table.column("energy[J]")[2]));
  CHECK(table.text("dt_limit") == std::vector<std::string>{"wave", "a, \"b\"", ""});
  CHECK(table.has("step"));
  CHECK_FALSE(table.has("dt"));
}

TEST_CASE("a restart continues the table as if nothing had happened") {
  const TemporaryFolder folder;
  const auto write = [](CsvWriter& writer, int from, int to) {
    for (int i = from; i < to; ++i) writer.row({i / 3.0, std::int64_t{i}, "wave", 2.0 * i});
  };
  {
    CsvWriter whole(folder / "whole.csv", kColumns, CsvWriter::Mode::fresh);
    write(whole, 0, 12);
  }
  {
    CsvWriter killed(folder / "history.csv", kColumns, CsvWriter::Mode::fresh);
    write(killed, 0, 9);
  }
  test::write_text(folder / "history.csv", read_file(folder / "history.csv") + "3.0,9,wa");  // half a row
  {
    CsvWriter restarted(folder / "history.csv", kColumns, CsvWriter::Mode::append);
    restarted.drop_after(5 / 3.0);  // not exactly what the ten digits of the row say
    write(restarted, 6, 12);
  }
  CHECK(read_file(folder / "history.csv") == read_file(folder / "whole.csv"));
}

TEST_CASE("continuing a table that is empty, missing, not begun or of other columns") {
  const TemporaryFolder folder;
  const fs::path path = folder / "history.csv";
  const std::string header = "time[s],step,dt_limit,energy[J]\n";
  CsvWriter(path, kColumns, CsvWriter::Mode::append).drop_after(1.0);
  CHECK(read_file(path) == header);
  test::write_text(path, "time[s],st");
  CsvWriter(path, kColumns, CsvWriter::Mode::append).drop_after(1.0);
  CHECK(read_file(path) == header);
  test::write_text(path, "time[s],speed[m/s]\n1,2\n");
  CHECK(message_of<EnvironmentError>([&] { CsvWriter writer(path, kColumns, CsvWriter::Mode::append); }) ==
        path.string() + ": has other columns than this run writes; it starts with time[s],speed[m/s]");
  CHECK(read_file(path) == "time[s],speed[m/s]\n1,2\n");
}

TEST_CASE("rows wait for the flush and a wrong number of cells is refused") {
  const TemporaryFolder folder;
  CsvWriter writer(folder / "t.csv", {"time[s]", "x[m]"}, CsvWriter::Mode::fresh, 1e9);
  writer.row(std::vector<double>{1, 2});
  CHECK(read_file(folder / "t.csv") == "time[s],x[m]\n");
  writer.sync();
  CHECK(read_file(folder / "t.csv") == "time[s],x[m]\n1,2\n");
  CHECK_THROWS_AS(writer.row(std::vector<double>{1}), std::invalid_argument);
}

TEST_CASE("a full disk and a missing folder are environment errors") {
  const TemporaryFolder folder;
  CHECK(message_of<EnvironmentError>([&] {
          CsvWriter writer(folder / "no/t.csv", {"time[s]"}, CsvWriter::Mode::fresh);
        }) == (folder / "no/t.csv").string() + ": cannot be written: No such file or directory");
  const test::FileSizeLimit limit(100);
  CsvWriter writer(folder / "t.csv", {"time[s]"}, CsvWriter::Mode::fresh, 0.0);
  CHECK(message_of<EnvironmentError>([&] {
          for (int i = 0; i < 100; ++i) writer.row({1.0 / 3});
        }) == (folder / "t.csv").string() + ": cannot be written: File too large");
}

TEST_CASE("a reference with comments") {
  const CsvTable table(fs::path(POLDER_SOURCE_DIR) / "tests/reference/terzaghi_sand_isochrones.csv");
  CHECK(table.comments().size() == 2);
  CHECK(table.comments()[0].starts_with("Terzaghi consolidation"));
  CHECK(table.columns()[0] == "z[m]");
  CHECK(table.columns()[1] == "p[Pa]@t=0.0014574857s(Tv=0.001)");
  REQUIRE(table.rows() == 41);
  CHECK(table.column(0)[1] == 0.025);
  CHECK(table.column(1)[1] == 4238.49878);
}

TEST_CASE(
    "spreadsheet files: carriage returns, byte-order mark, blanks, empty cells and lines, no last line end") {
  const TemporaryFolder folder;
  test::write_text(folder / "t.csv", "\xEF\xBB\xBF# note\r\na, \"b,c\" \r\n+1 , 2e3\r\n\r\n# more\r\n,-inf");
  const CsvTable table(folder / "t.csv");
  CHECK(table.comments() == std::vector<std::string>{"note"});
  CHECK(table.columns() == std::vector<std::string>{"a", "b,c"});
  REQUIRE(table.rows() == 2);
  CHECK(table.column("a")[0] == 1.0);
  CHECK(std::isnan(table.column("a")[1]));
  CHECK(table.column("b,c")[0] == 2000.0);
  CHECK(std::isinf(table.column("b,c")[1]));
}

TEST_CASE("a broken table is reported with file and line") {
  const TemporaryFolder folder;
  const fs::path path = folder / "t.csv";
  const auto message = [&](const std::string& text) {
    test::write_text(path, text);
    return message_of<InputError>([&] { CsvTable table(path); });
  };
  CHECK(message("# c\na,b\n1,2\n1,x2\n") == path.string() + ":4: b: 'x2' is not a number");
  CHECK(message("a,b\n1,2,3\n") == path.string() + ":2: 3 cells, the header has 2");
  CHECK(message("a,b\n1,2 3\n") == path.string() + ":2: b: '2 3' is not a number");
  CHECK(message("a,a\n1,2\n") == path.string() + ":1: a: two columns have this name");
  CHECK(message("a,,b\n") == path.string() + ":1: column 2 has no name");
  CHECK(message("") == path.string() + ":1: no header line with column names");
  CHECK(message("a\n1\n\"2\n3") == path.string() + ":3: a quote is not closed");
  CHECK(message_of<EnvironmentError>([&] { CsvTable table(folder / "none.csv"); }) ==
        (folder / "none.csv").string() + ": cannot be read: No such file or directory");
  test::write_text(path, "a,b\n1,2\n");
  const CsvTable table(path);
  CHECK(message_of<InputError>([&] { table.column("c"); }) ==
        path.string() + ": c: there is no such column of numbers; allowed: a, b");
}
