// What a run has measured, read back from its tables: values over time or over a coordinate, and their norms.
#pragma once

#include <string>
#include <vector>

#include "coupling/scene.hpp"
#include "io/csv.hpp"
#include "io/run_folder.hpp"

namespace polder::app {

struct Curve {
  std::vector<double> x, value;  // x: time [s], or the coordinate of a profile [m]
};

// A measure from `start` to `end`, times counted from start; of a profile the last one in that time.
// InputError if the run has no such column.
Curve read_measure(const coupling::Measure& measure, const RunFolder& folder, double start, double end);

// The columns of history.csv that hold words.
std::vector<std::string> history_words();

// A measure that is no profile over all times of the table that holds it, history.csv or probes.csv;
// InputError if it has no such column.
Curve measured_curve(const coupling::Measure& measure, const CsvTable& table);

// The column of a reference over its column of times (`time`, `t`, else the first); of a profile over the
// first.
Curve read_reference(const CsvTable& table, const std::string& column, bool profile);

// Linear between the points, constant beyond the ends; x rises.
double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at);

// The points from `start` to `end`, times counted from start.
Curve part(const Curve& curve, double start, double end);

// The curve up to `end`, with the value between two points there.
Curve cut(const Curve& curve, double end);

// largest, smallest, magnitude, mean (over time by the trapezoidal rule, of a profile over its points),
// change (last minus first), else the last.
double number_of(const std::string& norm, const Curve& curve, bool profile);

// Error of a curve against a reference at the reference's times, the curve linear between its points.
//   l2:  sqrt(integral (m - r)^2 dt / integral r^2 dt), trapezoidal rule; the denominator is the time where r
//   is 0 max: max |m - r| / max |r|; the denominator is 1 where r is 0
// NaN with fewer than two common times, or if the curve ends before the reference.
double curve_error(const std::string& norm, const std::vector<double>& time, const std::vector<double>& value,
                   const std::vector<double>& reference_time, const std::vector<double>& reference);

// Error of a profile at its own points, the reference linear between its points; sums instead of integrals.
// NaN if a point lies outside the reference.
double profile_error(const std::string& norm, const Curve& profile, const Curve& reference);

}  // namespace polder::app
