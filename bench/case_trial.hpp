// One run of a case inside a benchmark: its expectations give the errors. A reference is one that the case
// has, or a fine solution of the case computed here and kept in a file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/precision.hpp"
#include "coupling/scene.hpp"

namespace polder::bench {

// A case of the folder cases/ with settings "key=value" and whatever they cannot say.
struct CaseVariant {
  std::string file;  // "terzaghi/terzaghi.toml"
  std::vector<std::string> settings;
  std::function<void(coupling::Scene&)> change;

  std::filesystem::path path() const;
  // Read, checked and changed; with the expectations of a reference or a value only.
  coupling::Scene scene() const;
};

// Runs the scene in OUTPUT/run (replaced every time) in a process of its own.
Outcome run_trial(const CaseVariant& variant, const Place& place);

// Histories of a fine run of a case, each in a file that an expectation can name.
class FineSolution {
 public:
  // measures: names of those of the case (after its change) that are compared. from_stage: as of
  // expectations.
  FineSolution(std::string name, CaseVariant variant, std::vector<std::string> measures,
               std::string from_stage, Place place);

  // Unless the files are there and come from the same scene and commit.
  void compute() const;
  // Replaces the expectations of a scene: the measures, compared with the fine solution's over time.
  void expect(coupling::Scene& scene) const;

 private:
  std::filesystem::path file(const std::string& measure) const;

  std::string name_;
  CaseVariant variant_;
  std::vector<std::string> measures_;
  std::string from_stage_;
  Place place_;
};

}  // namespace polder::bench
