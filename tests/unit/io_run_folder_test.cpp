// The folder of a run: refused, replaced or continued as asked.
#include <doctest/doctest.h>

#include "core/error.hpp"
#include "io/run_folder.hpp"
#include "tests/unit/io_support.hpp"

using namespace polder;
using polder::test::message_of;
using polder::test::TemporaryFolder;
namespace fs = std::filesystem;

TEST_CASE("a new folder is created with its parents") {
  const TemporaryFolder folder;
  const RunFolder run(folder / "a/b", RunFolder::Mode::fresh);
  CHECK(fs::is_directory(folder / "a/b"));
  CHECK(run.history() == folder / "a/b/history.csv");
  CHECK(run.checkpoint() == folder / "a/b/checkpoint.h5");
}

TEST_CASE("results are not overwritten unless asked, and only results are") {
  const TemporaryFolder folder;
  const std::vector<std::string> results = {"case.toml",           "summary.json",      "soil_000012.hdf",
                                            "soil.hdf.series",     "fluid_1000000.hdf", "checkpoint.h5.tmp",
                                            "soil_wall_000001.hdf"};
  const std::vector<std::string> others = {"notes.txt", "soil_photo.hdf", "soiled_000001.hdf", "levee.toml",
                                           "soil_00012.hdf"};
  for (const std::string& name : results) test::write_text(folder / name, "x");
  for (const std::string& name : others) test::write_text(folder / name, "x");

  CHECK(message_of<InputError>([&] { RunFolder run(folder.path(), RunFolder::Mode::fresh); }) ==
        folder.path().string() +
            ": holds results already (case.toml); use --overwrite to replace them, --restart to "
            "continue them, or -o for another folder");
  for (const std::string& name : results) CHECK(fs::exists(folder / name));
  const RunFolder run(folder.path(), RunFolder::Mode::overwrite);
  for (const std::string& name : results) CHECK_FALSE(fs::exists(folder / name));
  for (const std::string& name : others) CHECK(fs::exists(folder / name));
  const RunFolder again(folder.path(), RunFolder::Mode::fresh);
}

TEST_CASE("a restart needs a checkpoint and keeps everything") {
  const TemporaryFolder folder;
  test::write_text(folder / "history.csv", "x");
  CHECK(message_of<InputError>([&] { RunFolder run(folder.path(), RunFolder::Mode::restart); }) ==
        folder.path().string() + ": holds no checkpoint.h5 to restart from; run without --restart");
  CHECK_FALSE(fs::exists(folder / "other"));
  CHECK_THROWS_AS(RunFolder(folder / "other", RunFolder::Mode::restart), InputError);
  CHECK_FALSE(fs::exists(folder / "other"));
  test::write_text(folder / "checkpoint.h5", "x");
  const RunFolder run(folder.path(), RunFolder::Mode::restart);
  CHECK(fs::exists(run.history()));
}

TEST_CASE("a file in the way and a parent that is a file") {
  const TemporaryFolder folder;
  test::write_text(folder / "file", "x");
  CHECK(message_of<InputError>([&] { RunFolder run(folder / "file", RunFolder::Mode::overwrite); }) ==
        (folder / "file").string() + ": is a file; a folder for the results is wanted");
  CHECK(message_of<EnvironmentError>([&] { RunFolder run(folder / "file/below", RunFolder::Mode::fresh); }) ==
        (folder / "file/below").string() + ": the folder cannot be created: Not a directory");
}
