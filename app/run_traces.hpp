// What a run has measured, as traces that can be compared with those of other runs: its tables, read once.
//
// A history is a curve over time for each stage that is no search for equilibrium, whose pseudo-time means
// nothing; in a case without others it is what it ends with. A profile is a curve over its coordinate for
// each of some times. A factor of safety is one number.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/curve_family.hpp"
#include "app/run_record.hpp"
#include "io/csv.hpp"

namespace polder::app {

class RunTraces {
 public:
  explicit RunTraces(const RunRecord& run);  // which must live as long

  // Of the times compared: the start of the first stage that is no search for equilibrium [s].
  double start() const;

  // Times of a profile since then.
  std::vector<double> profile_times(const coupling::Measure& measure) const;

  // Empty if the run has no such measure. profile_times: at which a profile is wanted; what the run has not
  // recorded then is an empty curve.
  Trace trace(const coupling::Measure& measure, const std::vector<double>& profile_times) const;
  // All it has been, also where only its end is compared.
  Extremes extremes(const coupling::Measure& measure, const std::vector<double>& profile_times) const;
  double last(const coupling::Measure& measure) const;       // NaN: it has none, or is a profile
  std::string unit(const coupling::Measure& measure) const;  // empty if the run has none

 private:
  double same_time() const;  // by which times that mean the same may differ [s]
  const CsvTable* table(const coupling::Measure& measure) const;
  std::string column(const coupling::Measure& measure) const;
  std::optional<double> factor_of_safety(const coupling::Measure& measure) const;
  Trace histories(const coupling::Measure& measure) const;
  Trace profiles(const coupling::Measure& measure, const std::vector<double>& times) const;

  const RunRecord* run_;
  RunFolder folder_;
  std::vector<std::size_t> stages_;  // that are compared
  std::optional<CsvTable> history_, probes_;
};

}  // namespace polder::app
