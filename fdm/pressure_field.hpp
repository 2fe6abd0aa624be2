// Pore-water pressure in the grid's cells, one-layer formulation, saturated soil: incremental projection of
// the skeleton's velocity together with generalised Darcy flow, implicit in time.
//
// Mass balance of water and (incompressible) grains over an active cell of volume V, with the inertia of the
// water relative to the skeleton neglected:
//   (n / Kw) V dp/dt + integral of div v + sum_f A_f q_f = 0,   q = -(k / gamma_w) (grad p - rho_w g).
// Where the skeleton rests its compressibility may be added to n / Kw.
// With v = v* - mobility grad dp at the faces (incremental pressure correction: Van Kan 1986, SIAM J. Sci.
// Stat. Comput. 7), a step solves for dp = p^{n+1} - p^n
//   (n / Kw) V/dt dp_c + sum_f A_f/d_f [ Lam_f (1 + chi*) + kappa_f ] (dp_c - dp_e)
//     = - (D v*)_c + sum_f A_f kappa_f [ (p_e - p_c)/d_f - rho_w g.n_f ]
//       + chi sum_interior A_f Lam_f [ (p_e - p_c)/h - mean of the nodal gradients . n_f ],
// Lam_f the mean mobility dt vol/m of the face's nodes (nodes without mass left out), kappa = k / gamma_w the
// harmonic mean of the two cells (the cell's own at boundaries), d_f the distance between the two pressures
// (h, theta h, h/2), chi* = chi on interior faces, else 0. The last sum is the momentum interpolation of Rhie
// & Chow (1983, AIAA J. 21) on the total pressure; it removes the checkerboard which the compact operator
// cannot see, and is zero for linear p.
//
// Pressures [Pa], compression positive; zero in inactive cells. Discharges [m3/s] per metre of thickness
// (plane strain), per radian (axisymmetric) or total (3D), positive when water leaves the soil.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/aligned.hpp"
#include "fdm/cell_operators.hpp"
#include "fdm/explicit_pressure.hpp"
#include "fdm/linear_system.hpp"
#include "fdm/node_gradient.hpp"
#include "fdm/water_cells.hpp"

namespace polder::fdm {

template <int D>
struct WaterProperties {
  double density = 1000;                                          // [kg/m3]
  double bulk_modulus = std::numeric_limits<double>::infinity();  // [Pa]
  Point<D> gravity{};                                             // [m/s2]
};

// Spans over slots.
struct PressureStep {
  double dt = 0;                     // [s]
  std::span<const double> velocity;  // predicted v* of the nodes, NodeGradient::kStride values a slot [m/s]
  std::span<const double> mobility;  // of the nodes, dt vol / m [m3 s/kg]; 0: no mass
  std::span<const double> porosity;  // of the cells [-]
  std::span<const double> darcy_mobility;  // of the cells, k / gamma_w [m2 / (Pa s)]
  double rhie_chow = 0.05;                 // chi [-]
  // node_gradient(pressure(), present) before the step if the caller has it, else empty. Treatment of walls
  // does not matter: the faces inside need no normal gradient at one.
  std::span<const double> pressure_gradient = {};
  // Where the water has a velocity of its own (fdm/mixture_flow.hpp) these stand in place of `velocity` and
  // `mobility`: predicted volume flow out of each active cell [m3/s], and mobility of each face, interior
  // ones first [m3 s/kg].
  std::span<const double> divergence = {};
  std::span<const double> face_mobility = {};
  std::span<const double> skeleton_compressibility = {};  // of the cells [1/Pa]; empty: 0
};

// Water leaving the soil through ... [m3/s]
struct Discharge {
  double surface = 0;            // its free or submerged surface
  std::vector<double> boundary;  // each of WaterConditions::boundaries
  std::vector<double> well;      // each of WaterConditions::wells, empty where saturated soil has none
  std::vector<double> drain;     // each of WaterConditions::drains
  double total() const;
};

// Rates of change summed over all active cells [m3/s]; their sum is the defect. Interior fluxes cancel.
struct WaterBalance {
  double storage = 0;   // compression of the water and, where it is given, the skeleton, (n / Kw + c_s) dp/dt
  double skeleton = 0;  // volume change of the skeleton, D v
  double projection =
      0;  // volume passing surfaces and boundaries with the correction of v* (0 if v is corrected)
  double outflow = 0;     // Darcy discharge
  double withdrawal = 0;  // what the caller takes out of the cells (unsaturated flow)
  double magnitude = 0;   // sum of the absolute values of the cells' terms, to judge the defect by
  double defect() const { return storage + skeleton + projection + outflow + withdrawal; }
};

template <int D>
class PressureField {
 public:
  static constexpr int kStride = NodeGradient<D>::kStride;

  // `cells` must outlive the field.
  PressureField(const WaterCells<D>& cells, const WaterProperties<D>& water,
                SolverKind solver = SolverKind::automatic);
  ~PressureField();

  // After Grid::activate returned true: moves the pressure to the new numbering.
  void carry();
  // After WaterCells::update returned true (harmless otherwise): new lists, pressure zero in inactive cells.
  // A cell that has just become active starts between its neighbours and the prescribed pressures around it.
  void refresh();
  // Slots of the cells that were active in the last refresh(). They are part of the state: cells follow the
  // points at the start of a step, so the pressure belongs to cells from before the last motion.
  const std::vector<int>& pressure_cells() const { return pressure_cells_; }
  // Takes up the pressure of an earlier run. If the present cells are not those it belongs to, the next
  // refresh() brings it to them, as it would have in that run.
  void restore(const Reals& pressure, const std::vector<int>& pressure_cells);
  void set_tolerance(double tolerance) { accuracy_.tolerance = tolerance; }

  Reals& pressure() { return p_; }  // [Pa], slots
  const Reals& pressure() const { return p_; }
  const Reals& increment() const { return dp_; }  // dp of the last step [Pa], slots

  // Solves the step's equation and adds the increment to the pressure. The caller then corrects its nodal
  // velocities, v = v* - mobility grad dp with node_gradient(increment(), homogeneous). A closed basin of
  // incompressible water determines pressure up to a constant only: the increment of the first cell of such a
  // basin is held at zero.
  SolveReport solve(const PressureStep& step);

  // The same balance without a linear system (fdm/explicit_pressure.hpp): the flow is that of the pressure
  // before the step, the velocity is final and needs no correction. For steps up to explicit_limit().
  void advance(const PressureStep& step);
  // Longest stable step of advance() with these properties of the cells. specific_volume: of the mixture, 1 /
  // rho [m3/kg].
  ExplicitLimit explicit_limit(const PressureStep& step, std::span<const double> specific_volume);
  // The same with that of the faces, interior ones first, where the water has a velocity of its own: the
  // acceleration of the mixture's volume flow by a unit pressure gradient.
  ExplicitLimit explicit_limit_of_faces(const PressureStep& step, std::span<const double> specific_volume);

  // Steady Darcy flow through a resting skeleton under the present conditions; sets the pressure. A basin
  // without any prescribed pressure gets the pressure zero in its first cell.
  SolveReport steady(std::span<const double> darcy_mobility);

  // Gradient at the nodes, out: slots * kStride; see NodeGradient.
  void node_gradient(std::span<const double> field, BoundaryValues values, WallNormal walls,
                     std::span<double> out);

  // Rate of volume change of the skeleton in each active cell, (D v)_c / V [1/s]; zero elsewhere.
  void cell_divergence(std::span<const double> velocity, std::span<double> out) const;

  // Darcy discharge at the present pressure with the conductivities of the last solution.
  const Discharge& discharge();
  // Darcy flow through the faces at the present pressure, in the order and with the signs of
  // UnsaturatedField::face_flow(): interior ones against the axis, then boundary faces into the soil [m3/s].
  Reals darcy_flow(std::span<const double> darcy_mobility) const;
  // Balance of the last step as solved: v* plus its correction at the faces. Defect: what the solver left.
  const WaterBalance& balance() const { return balance_; }
  // Balance of the last step with the corrected nodal velocities. Defect: what the approximate projection
  // left.
  WaterBalance balance(std::span<const double> velocity) const;

  // What refresh() has found, for other fields in the same cells.
  NodeGradient<D>& gradient() { return gradient_; }
  const Basins& basins() const { return basins_; }
  LinearSolver<D>& solver() { return *solver_; }

  const char* solver_name() const;
  SolverCounts solver_counts() const { return solver_->counts(); }
  int pinned_basins() const { return pinned_; }  // in the last solution

 private:
  double darcy_outflow(const BoundaryFace<D>& face, double darcy_mobility) const;
  void face_terms(const PressureStep& step, bool inertia);
  void gather_sinks();
  void pin_closed_basins();
  SolveReport solve_increment();
  void fill_new_cells();
  void require_current(std::size_t slots) const;
  void require_mixture(const PressureStep& step) const;
  bool require_step(const PressureStep& step) const;  // whether its motion is that of a mixture
  ExplicitLimit limit_of_inertia(const PressureStep& step);

  const WaterCells<D>& cells_;
  WaterProperties<D> water_;
  std::unique_ptr<LinearSolver<D>> solver_;
  const char* solved_by_ = nullptr;
  Accuracy accuracy_;
  NodeGradient<D> gradient_;
  std::uint64_t grid_revision_ = 0;
  std::uint64_t cells_revision_ = 0;

  Reals p_, dp_;                     // slots
  std::vector<int> pressure_cells_;  // slots that p_ belongs to
  Reals node_grad_;                  // slots * kStride
  // Faces, interior then boundary; explicit volume flow along the axis (interior) or outwards (boundary)
  // [m3/s].
  Reals flow_;
  Reals conductance_;                        // [m3 / (Pa s)]
  Reals boundary_inertia_, boundary_darcy_;  // parts of the boundary faces: Lam A/d [m3/(Pa s)], kappa
  // Active cells.
  Reals storage_;  // (n / Kw) V / dt [m3 / (Pa s)]
  Reals sink_, rhs_, x_;
  std::vector<double> divergence_;  // (D v*)_c [m3/s]
  Basins basins_;
  std::vector<double> basin_sink_, basin_scale_;
  int pinned_ = 0;
  Discharge discharge_;
  WaterBalance balance_;
  Reals limit_storage_, limit_darcy_, limit_inertia_;  // see ExplicitRates; only where it is asked for
};

extern template class PressureField<2>;
extern template class PressureField<3>;

}  // namespace polder::fdm
