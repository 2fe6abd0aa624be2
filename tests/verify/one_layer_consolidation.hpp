// One-dimensional consolidation of loaded columns, drained at their tops, against reference solutions. SI
// units.
#pragma once

#include <functional>
#include <vector>

#include "tests/verify/one_layer_scenes.hpp"

namespace polder::verify {

struct Consolidation {
  std::vector<double> pressure_error;  // L2 norm over the load at each of the given times [-]
  double settlement_ratio = 0;         // settlement over the reference's at the last time [-]
  long steps = 0;
  double step = 0;  // largest [s]
  double seconds = 0;
};

// Terzaghi's column, H = 1 m, M = 11.1 MPa, under a load [Pa]; errors at the given time factors, ascending.
Consolidation terzaghi(const Choice& choice, const std::vector<double>& time_factors, double load = 1e4);

// Layer 1 over layer 2 on a closed base (Gray 1945; Schiffman & Stein 1970), compared with columns of a table
// of p [Pa] over depth z [m]: value(i, z) for the i-th of the times. Time runs `faster` times as fast as in
// the table, with conductivities as many times as large.
struct TwoLayer {
  double thickness[2], modulus[2], conductivity[2];
  double load = 0;
};
Consolidation two_layer(const Choice& choice, const TwoLayer& soil, const std::vector<double>& times,
                        const std::function<double(int, double)>& pressure, double settlement, double faster);

// Finite strain under a load and self weight (Gibson, England & Hussey 1967) with Cauchy stress M ln J; the
// excess pressure u over the initial depth a.
struct LargeStrain {
  double height, young, poisson, porosity, conductivity, load, buoyant_weight;
};
Consolidation large_strain(const Choice& choice, const LargeStrain& soil, const std::vector<double>& times,
                           const std::function<double(int, double)>& excess, double settlement,
                           double faster);

}  // namespace polder::verify
