// One-dimensional consolidation of loaded columns, drained at their tops, against reference solutions. SI
// units.
#pragma once

#include <string>
#include <vector>

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

// Terzaghi (1943), a layer drained at depth 0 and closed at depth 1: excess pressure over the load, and
// settlement over the final one.
double terzaghi_pressure(double time_factor, double depth);
double terzaghi_degree(double time_factor);

struct Consolidation {
  std::vector<double> pressure_error;  // L2 norm over the load at each of the times [-]
  double settlement_ratio = 0;         // settlement over the reference's at the last time [-]
  long steps = 0;
  double step = 0;  // largest [s]
  double seconds = 0;
};

// Terzaghi's column, H = 1 m, M = 11.1 MPa, under a load [Pa]; errors at the given time factors, ascending.
Consolidation terzaghi(const Choice& choice, const std::vector<double>& time_factors, double load = 1e4);

// A soft layer over a stiff one or the other way round on a closed base (Gray 1945; Schiffman & Stein 1970),
// tests/reference/two_layer_NAME_isochrones.csv. Errors at 0.1, 0.4 and 1 times the time of 90 % settlement.
// Time runs `faster` times as fast as in the table, with conductivities as many times as large. The load is
// 1e-4 of the table's, whose strains of 1 % are no longer small and move the layers' boundary off the cells'.
Consolidation two_layer(const Choice& choice, const std::string& name, double faster = 50);

// Finite strain, to 16 % settlement, under a load and self weight (Gibson, England & Hussey 1967) of soil
// with Cauchy stress M ln J and constant conductivity, tests/reference/large_strain_logcauchy_kconst_*.csv:
// excess pressure over the initial depth. Errors at 146, 583 and 1457 s of the table.
Consolidation large_strain(const Choice& choice, double faster = 20);

}  // namespace polder::verify
