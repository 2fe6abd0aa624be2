// Retention curve of a soil and its relative conductivity, as functions of the pore pressure.
//
// Degree of saturation S = S_r + (S_max - S_r) S_e(h) and relative conductivity k_r(h) of the suction head
// h = -p / gamma_w [m]; for p >= 0 S = S_max and k_r = 1. With S_e between 0 and 1:
//   van Genuchten (1980, Soil Sci. Soc. Am. J. 44, eq. 3 and 8; Mualem's integral, closed for m = 1 - 1/n and
//     used with any other m as it stands)
//                  S_e = (1 + (alpha h)^n)^-m,   k_r = S_e^l (1 - (1 - S_e^(1/m))^m)^2
//   Brooks & Corey (1964, Hydrology Paper 3, Colorado State)
//                  S_e = (h / h_b)^-lambda for h > h_b, else 1,   k_r = S_e^(2/lambda + 2 + l);
//                  l = 1/2 after Mualem (1976), l = 1 after Burdine (1953)
//   Gardner (1958, Soil Sci. 85) with the exponential storage that goes with it
//                  S_e = k_r = exp(-alpha h)
//   Haverkamp et al. (1977, Soil Sci. Soc. Am. J. 41)
//                  S_e = a / (a + h^b),   k_r = A / (A + h^B)
//   tabulated      S and ln k_r through points (h, S, k_r), monotone cubic (Fritsch & Butland 1984, SIAM J.
//                  Sci. Stat. Comput. 5) over ln(1 + h / h_1), h_1 the first suction head above zero;
//                  constant beyond the last point
//   saturated      S = S_max and k_r = 1 at any pressure
//
// On request the curve of a cell: means over its height of a hydrostatic distribution with the given pressure
// at the centre (fdm/suction_integrals.hpp).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace polder::fdm {

class SuctionIntegrals;

struct Retention {
  enum class Model { saturated, van_genuchten, brooks_corey, gardner, haverkamp, tabulated };
  Model model = Model::saturated;
  double alpha = 0;           // van Genuchten, Gardner: of suction head [1/m]
  double n = 0;               // van Genuchten
  double m = 0;               // van Genuchten; 1 - 1/n where 0
  double connectivity = 0.5;  // l of van Genuchten and Brooks-Corey
  double entry_head = 0;      // Brooks-Corey: suction head h_b at which air enters [m]
  double lambda = 0;          // Brooks-Corey: pore-size index
  double residual = 0;        // degree of saturation S_r
  double maximum = 1;         // degree of saturation at zero suction, S_max
  struct Haverkamp {
    double saturation_factor = 0, saturation_exponent = 0;      // a [m^b], b
    double conductivity_factor = 0, conductivity_exponent = 0;  // A [m^B], B
    bool operator==(const Haverkamp&) const = default;
  } haverkamp;
  // Tabulated: suction heads ascending [m], the others not rising. A point at zero suction (maximum, 1) is
  // added if there is none.
  std::vector<double> suction_head, saturation, relative_conductivity;
  bool operator==(const Retention&) const = default;
};

// What is wrong with the parameters, one sentence each; empty if nothing is.
std::vector<std::string> faults(const Retention& retention);

class RetentionCurve {
 public:
  // unit_weight: of water [N/m3]. Throws InputError with the faults of the parameters.
  RetentionCurve(const Retention& retention, double unit_weight);

  const Retention& parameters() const { return r_; }
  bool always_saturated() const { return r_.model == Retention::Model::saturated; }

  // Of the pore pressure p [Pa].
  double saturation(double p) const;
  double capacity(double p) const;  // dS/dp [1/Pa]
  double relative_conductivity(double p) const;
  // Pore pressure [Pa] at which the soil has this degree of saturation: 0 at the maximum or above. At the
  // residual saturation, which no finite suction reaches, and below it: that of kDriestSuction.
  double pressure(double saturation) const;

  // From here on saturation(), capacity(), evaluate() and conductivity_slope() are means over this height
  // [m]; 0: values at a point.
  void average_over(double height);
  // Pressure from which on the soil is full.
  double full_pressure() const { return full_pressure_; }

  // dk_r/dp at p[i] for all i in `which`.
  void conductivity_slope(std::span<const int> which, std::span<const double> p,
                          std::span<double> slope) const;
  // The first three at p[i] for all i in `which`, with one choice of the model for all of them.
  void evaluate(std::span<const int> which, std::span<const double> p, std::span<double> saturation,
                std::span<double> capacity, std::span<double> relative_conductivity) const;

  static constexpr double kDriestSuction = 1e6;  // suction head [m]: oven dry

 private:
  struct Curve {
    double s = 1, c = 0, k = 1;  // S_e, dS_e/dh [1/m], k_r
  };
  Curve van_genuchten(double h) const;
  Curve brooks_corey(double h) const;
  Curve gardner(double h) const;
  Curve haverkamp(double h) const;
  Curve tabulated(double h) const;
  Curve at(double h) const;
  Curve mean(double h) const;
  double suction_head(double effective) const;
  void prepare_table();

  Retention r_;
  double per_weight_;  // 1 / gamma_w [m/Pa]
  double span_;        // S_max - S_r
  double m_ = 0;
  double height_ = 0, full_pressure_ = 0;
  std::shared_ptr<const SuctionIntegrals> integrals_;
  // Table over x = ln(1 + h / h_1): values and slopes of S_e and ln k_r.
  double first_head_ = 1;
  std::vector<double> x_, s_, s_slope_, k_, k_slope_;
};

}  // namespace polder::fdm
