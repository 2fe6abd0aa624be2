// Pore-water pressure in the grid's cells where soil need not be saturated: Richards' equation in mixed form,
// through a rigid skeleton or together with the skeleton's motion (one-layer formulation).
//
// Volume balance of water over an active cell of volume V, of which soil fills vf V, over one implicit step:
//   n vf V [S(p) - S^n] / dt + vf V S (n / K_w + c_s) (p - p^n) / dt + S D v + sum_f A_f q_f = 0,
//   q = -(k k_r / gamma_w) (grad p - rho_w g),
// p = p^{n+1}, c_s the compressibility of the skeleton. The first term is the difference of stored volumes
// and not n dS/dp dp/dt, so that the balance holds to the tolerance of the iteration (Celia, Bouloutas &
// Zarba 1990, Water Resour. Res. 26, eq. 19). k at a face is the harmonic mean of the saturated values of its
// two cells, times the arithmetic mean of their k_r or the one upstream. Boundary faces:
// fdm/boundary_flow.hpp.
//
// With a moving skeleton only water in full cells pushes back within the step: the mechanics takes
// p+ = max(p, -p_f) as a gradient at the nodes, and the rest of the suction as a stress of the particles. p_f
// is the suction that leaves soil full but for a ten-thousandth of its pores, some ten to a hundred Pa:
// between it and p = 0 pores store next to nothing, and a cell there that did not push would let its pressure
// run away in the iteration. With v = v* - mobility grad (p+^{n+1} - p+^n) at the faces, as in
// fdm/pressure_field.hpp, S D v stands for
//   S_c (D v*)_c + S_c sum_f A_f/d_f Lam_f (1 + chi*) (dp+_c - dp+_e) - S_c chi sum_f A_f Lam_f [...],
// and in a saturated scene the step is that of PressureField. Soil whose retention is `saturated` counts as
// saturated under suction as well: p+ = p there.
//
// Iteration: fdm/unsaturated_field.cpp and unsaturated_newton.cpp. A step that does not converge changes
// nothing and says so. Explicit steps: fdm/explicit_step.cpp.
//
// Pressures [Pa], compression positive; zero in inactive cells. Discharges as in fdm/pressure_field.hpp.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/aligned.hpp"
#include "fdm/anderson.hpp"
#include "fdm/boundary_flow.hpp"
#include "fdm/cell_operators.hpp"
#include "fdm/flexible_gmres.hpp"
#include "fdm/linear_system.hpp"
#include "fdm/node_gradient.hpp"
#include "fdm/pressure_field.hpp"
#include "fdm/retention.hpp"
#include "fdm/water_cells.hpp"
#include "fdm/water_lines.hpp"

namespace polder::fdm {

template <int D>
struct Soil {
  Retention retention;
  std::array<double, D> anisotropy = unit();  // factors on the conductivity along the axes

  static constexpr std::array<double, D> unit() {
    std::array<double, D> a;
    a.fill(1);
    return a;
  }
};

// Spans over slots.
struct UnsaturatedStep {
  double dt = 0;                            // [s]
  std::span<const double> porosity;         // of the cells [-]
  std::span<const double> volume_fraction;  // soil counted to a cell / its volume, see soil_fraction()
  std::span<const double> darcy_mobility;   // of the cells, saturated k / gamma_w [m2 / (Pa s)]
  std::span<const int> soil;                // of the cells: number in the field's list of soils
  std::span<const double> skeleton_compressibility = {};  // of the cells [1/Pa]; empty: 0
  // Of the active cells: water that goes where no term below knows of, as into pores that have opened
  // [m3/s].
  std::span<const double> withdrawal = {};
  // A moving skeleton; empty: a rigid one.
  std::span<const double> velocity =
      {};  // predicted v* of the nodes, NodeGradient::kStride values a slot [m/s]
  std::span<const double> mobility = {};  // of the nodes, dt vol / m [m3 s/kg]; 0: no mass
  double rhie_chow = 0.05;                // chi [-]
  // node_gradient(positive_pressure(), present) before the step if the caller has it, else empty.
  std::span<const double> pressure_gradient = {};
};

struct StepReport {
  bool converged = false;
  bool lagged = false;        // relative conductivities are those of an earlier iteration
  int iterations = 0;         // linear systems solved
  int linear_iterations = 0;  // of all of them together
  double residual = 0;        // sum of the cells' residuals over the sum of the terms' magnitudes
  double largest_change = 0;  // of p in the last iteration [Pa]
  std::string failure;        // why it did not converge
};

enum class FaceWeighting {
  mean,      // arithmetic mean of k_r
  upstream,  // k_r of the cell (or boundary) the water comes from: no overshoot at dry fronts, first order
};

// Soil volume of each active cell over the cell's volume: its own fill, at most one, and that of the inactive
// cells beside it, which hand theirs over in equal parts to the active cells across their faces (across edges
// and corners where there is none).
template <int D>
void soil_fraction(const WaterCells<D>& cells, std::span<const double> fill, std::span<double> fraction);

template <int D>
class UnsaturatedField {
 public:
  static constexpr int kStride = NodeGradient<D>::kStride;
  static constexpr double kFromPressure = -1;  // saturation() of a cell whose S^n is S(p^n)

  // `cells` must outlive the field.
  UnsaturatedField(const WaterCells<D>& cells, const WaterProperties<D>& water, std::vector<Soil<D>> soils,
                   SolverKind solver = SolverKind::automatic);
  ~UnsaturatedField();

  // After Grid::activate returned true: moves pressure and saturation to the new numbering.
  void carry();
  // After WaterCells::update (cheap where nothing changed): new lists; pressure zero in inactive cells. A
  // cell that has just become active takes the mean hydraulic head of its neighbours and the saturation that
  // goes with it, unless the caller writes another.
  void refresh();
  const std::vector<int>& pressure_cells() const { return pressure_cells_; }  // as PressureField's
  // Takes up pressure and saturation of an earlier run, and the cells they belong to.
  void restore(const Reals& pressure, const Reals& saturation, const std::vector<int>& pressure_cells);

  void set_weighting(FaceWeighting weighting) { weighting_ = weighting; }
  // Relative to the sum of the magnitudes of the balance's terms.
  void set_tolerance(double tolerance) { tolerance_ = tolerance; }
  void set_max_iterations(int n) { max_iterations_ = n; }
  // Curves and flows through upright faces as means over the height of a cell in which water hangs at rest
  // (fdm/suction_integrals.hpp): a free surface then passes evenly through cells that are larger than the
  // capillary fringe. Needs a resting skeleton.
  void set_averages(bool over_cells);

  Reals& pressure() { return p_; }  // [Pa], slots
  const Reals& pressure() const { return p_; }
  // S^n [-], slots; kFromPressure where it follows from the pressure. The caller may write it.
  Reals& saturation() { return saturation_; }
  const Reals& saturation() const { return saturation_; }
  const Reals& positive_pressure() const { return positive_; }  // p+ after the last step [Pa], slots
  const Reals& increment() const { return increment_; }  // p+^{n+1} - p+^n of the last step [Pa], slots
  const RetentionCurve& curve(int soil) const { return curves_[soil]; }
  // Suction up to which a soil counts as full [Pa], infinite where retention is `saturated`.
  double full_suction(int soil) const { return full_suction_[soil]; }

  StepReport solve(const UnsaturatedStep& step);
  // An explicit step with a moving skeleton (fdm/explicit_step.cpp), without a linear system; the velocity is
  // final and needs no correction. Returns the longest stable step of the state before it. specific_volume:
  // of the mixture in the cells, 1 / rho [m3/kg].
  ExplicitLimit advance_explicitly(const UnsaturatedStep& step, std::span<const double> specific_volume);
  ExplicitLimit explicit_limit(const UnsaturatedStep& step, std::span<const double> specific_volume);
  // Steady flow through a resting skeleton from the present state, by implicit steps of growing length
  // (step.dt is the first one) until storage takes no part; a closed basin keeps its water.
  StepReport steady(const UnsaturatedStep& step);

  // Gradient at the nodes, out: slots * kStride; see NodeGradient. Pressures at the boundaries are their
  // positive parts.
  void node_gradient(std::span<const double> field, BoundaryValues values, WallNormal walls,
                     std::span<double> out);

  // Darcy flow of the last step through the faces: interior ones against the axis (into the low cell), then
  // boundary faces, into the soil [m3/s].
  const Reals& face_flow() const { return flow_; }
  // Outflow at the present pressure, as in the balance of the last step.
  const Discharge& discharge() const { return discharge_; }
  const WaterBalance& balance() const { return balance_; }  // of the last step
  const char* solver_name() const;
  SolverCounts solver_counts() const { return solver_->counts(); }

 private:
  StepReport steady_steps(UnsaturatedStep step);
  StepReport steady_homotopy(const UnsaturatedStep& step);
  double passage(const UnsaturatedStep& step) const;
  struct Cell {         // what a step holds for an active cell
    double pores;       // n vf V / dt [m3/s]
    double elastic;     // vf V (n / K_w + c_s) / dt [m3/(Pa s)]
    double source;      // (D v*)_c [m3/s]
    double withdrawal;  // [m3/s]
  };
  // A well or drain in one cell: takes conductance * (p - pressure), not less than `least`, not more than
  // `most` [m3/s].
  struct LineSink {
    int cell;
    double share;
    int owner;  // number of the well or drain
    bool drain;
    double pressure = 0, conductance = 0, least = 0, most = 0;
    double flow = 0;  // at the present pressure
  };
  struct Residual {
    double sum = 0, scale = 0, rounding = 0;
    bool small(double tolerance) const { return sum <= tolerance * scale + rounding; }
    double relative() const { return scale > 0 ? sum / scale : sum > 0 ? 1 : 0; }
  };

  void prepare(const UnsaturatedStep& step);
  void prepare_soils(const UnsaturatedStep& step);
  void prepare_faces(const UnsaturatedStep& step);
  void prepare_lines();
  void find_lines();
  void find_steps();
  // Not yet on the way to a steady state, where the flow is a rough one.
  bool runs_off() const { return averages_ && kr_floor_ < 1e-4; }
  void run_off();
  void add_run_off(std::span<const double> v, std::span<double> flow) const;
  void assemble();
  void assemble_lines();
  Residual gather();
  void pin_closed_basins();
  double changed_pressure_moving(int cell, double change) const;
  double changed_pressure(int c, double d) const;
  double advance();
  void find_slopes();
  void multiply(std::span<const double> v, std::span<double> out);
  bool newton_step(Residual& residual, double reduction, StepReport& report);
  void accept();
  ExplicitLimit limit_of_assembled(const UnsaturatedStep& step, std::span<const double> specific_volume);
  double stored_pressure(int c, double inflow, double drawn) const;
  void update_gradient_faces();
  bool wet(int cell) const { return p_now_[cell] > -fringe_[cell]; }
  // The momentum interpolation acts between cells that were full at the start of the step: it must not come
  // and go in the iteration.
  double chi_factor(int a, int b) const { return was_wet_[a] && was_wet_[b] ? 1 + chi_ : 1; }
  double positive(int cell) const { return wet(cell) ? p_now_[cell] : -fringe_[cell]; }
  void require_current(std::size_t slots) const;

  const WaterCells<D>& cells_;
  WaterProperties<D> water_;
  double unit_weight_ = 0;  // [N/m3]
  std::vector<Soil<D>> soils_;
  std::vector<RetentionCurve> curves_;
  std::vector<double> full_suction_;
  std::unique_ptr<LinearSolver<D>> solver_;
  NodeGradient<D> gradient_;
  FaceWeighting weighting_ = FaceWeighting::mean;
  bool averages_ = false;
  double tolerance_ = 1e-7;
  int max_iterations_ = 40;
  bool may_lag_ = true, lags_ = false;  // k_r; see solve()
  Reals lagged_kr_;
  double kr_floor_ = 0;  // least k_r, on the way to a steady state
  std::uint64_t grid_revision_ = 0, cells_revision_ = 0;

  Reals p_, saturation_, positive_, increment_;  // slots
  std::vector<int> pressure_cells_;              // slots
  int known_slots_ = 0;                          // of the numbering they belong to
  Reals node_grad_;                              // slots * kStride

  // Active cells.
  std::vector<int> soil_;  // of each cell
  std::vector<std::vector<int>> cells_of_soil_;
  Reals fringe_;                        // suction up to which a cell counts as full [Pa], see full_suction()
  std::vector<unsigned char> was_wet_;  // at the start of the step
  Reals motion_;                        // links of motion of a wet cell, in its diagonal
  std::vector<unsigned char> saturated_;  // retention `saturated`
  std::vector<Cell> cell_;
  Reals p_now_, p_old_, s_now_, s_old_, capacity_, kr_;
  Reals positive_old_, plus_change_;  // p+^n, p+ - p+^n
  Reals projection_;                  // inflow with the correction of v*, times S [m3/s]
  Reals sink_, rhs_, diagonal_, change_, image_;
  Anderson acceleration_;
  FlexibleGmres gmres_;
  Reals kr_slope_;                             // dk_r/dp [1/Pa]
  Reals slope_low_, slope_high_, slope_flow_;  // of the faces, see find_slopes() [m3/(Pa s)]
  double relaxation_ = 1;
  Basins basins_;
  std::vector<double> basin_sink_, basin_scale_;
  Reals rounding_;            // what rounding may leave of each cell's residual [m3/s]
  double rounding_norm_ = 0;  // of the conductances alone, in the norm of Accuracy

  // Faces.
  Reals kappa_;        // k A / (gamma_w d) saturated [m3/(Pa s)], interior then boundary
  Reals lambda_;       // inertial mobility Lam A / d [m3/(Pa s)], interior then boundary
  Reals correction_;   // Rhie-Chow, interior: chi Lam A (grad p+ - mean nodal gradient) [m3/s]
  Reals flow_;         // Darcy, interior: along the axis, into the low cell; boundary: into the soil [m3/s]
  Reals conductance_;  // derivative of flow_ [m3/(Pa s)]
  double chi_ = 0;
  bool inertia_ = false;
  std::vector<BoundaryLaw> laws_;       // of the boundary faces
  std::vector<unsigned char> blocked_;  // interior faces that a sheet closes; empty: none

  // Where a cut surface descends in a step, see fdm/unsaturated_steps.cpp.
  struct Step {
    std::vector<int> above, below;  // boundary faces: upright ones, and level ones at their foot
    std::vector<double> potential;  // what each level face could take [m3/s]
    double demand = 0, part = 0;    // sum of that, and the part of it that they get
  };
  std::vector<Step> steps_;
  std::vector<LineSink> lines_;
  Reals line_flow_, line_conductance_;  // of the cells; empty without wells and drains

  Discharge discharge_;
  WaterBalance balance_;
  std::vector<BoundaryFace<D>> gradient_faces_;        // with the positive part of the pressure
  Reals limit_storage_, limit_darcy_, limit_inertia_;  // see ExplicitRates; only in explicit steps
};

extern template class UnsaturatedField<2>;
extern template class UnsaturatedField<3>;

}  // namespace polder::fdm
