// Transfers between particles and grid: what the particle kernels read and write.
//
// Every occupied block of the grid owns a private tile: its nodes, the reach of the stencil and one half cell
// of skin (kTileSide nodes along each axis, from one node below the block). Particles write only into the
// tile of their block; then every node sums the tiles of the at most 3^D blocks around it in a fixed order.
// No atomics, no colours: the bits do not depend on the number of threads.
//
// Node sums are eight numbers a node: 2D {m, px, py, fx, fy, V, -, -}, 3D {m, px, py, pz, fx, fy, fz, V}:
// mass, momentum, force of stress and loads, volume that pore pressure acts on: of saturated soil, of its
// grains where the water has points of its own, 0 in dry scenes; of points of water their drag instead [N
// s/m]. Velocities are four numbers a node (padded).
#pragma once

#include <memory>
#include <vector>

#include "core/grid.hpp"
#include "core/particles.hpp"
#include "core/simd_level.hpp"
#include "mpm/material/parameters.hpp"
#include "mpm/shape_kind.hpp"

namespace polder::mpm {

enum class AffineKind { none, apic, tpic };

// One body as the kernels see it. law points to a polder::simd_*::Law<D> of the running vector level; points
// without one move, and keep their stress, volume and domain.
// bulk_modulus of laws that open freely (a cone's apex): where no compression is left, dry points change
// their volume only as much as their stress says; 0: volume follows the motion.
template <int D>
struct Body {
  ParticleSet<D>* particles = nullptr;
  const void* law = nullptr;
  double bulk_modulus = 0;  // [Pa]
};

// Where soil and water have points of their own the eighth number of a node is what the cell around each
// point makes of it: of_cell [slots] times the point's volume. Of soil that is the part of it which lies in
// water, of water the drag of the pores [Pa s/m2].
struct CellWeight {
  const Reals* of_cell = nullptr;
  // Of the volume only what grains, and the water that they retain, take up.
  bool grains_only = false;
  double retained_density = 0;  // of that water [kg/m3]
};

// A block whose points may sleep (mpm/sleep.hpp). Kernels leave the points of one that does alone, and take
// from here what they give to its tile of nodes and cells; it is kept when it is first computed.
struct Sleeper {
  bool asleep = false;
  Reals state, cells;
};

template <int D>
struct Transfer {
  static constexpr int kTileSide = Grid<D>::kSide + 4;
  static constexpr int kTileNodes = ipow(kTileSide, D);
  static constexpr int kSum = 8;                  // numbers a node in `sums`
  static constexpr int kVector = 4;               // numbers a node in a velocity array
  static constexpr int kVolume = D == 2 ? 5 : 7;  // where V sits in a sum
  static constexpr int kCellSum = 4;

  const Grid<D>* grid = nullptr;
  Space space = Space::plane_strain;
  ShapeKind shape = ShapeKind::gimp;
  std::vector<Body<D>> bodies;
  CellWeight weight;
  Reals tiles;                    // work space, kSum numbers a tile node
  std::vector<Sleeper> sleepers;  // occupied blocks; empty where none may sleep

  bool asleep(int block) const { return !sleepers.empty() && sleepers[block].asleep; }
  // Room for all tiles after grid->activate().
  void resize() { tiles.resize(static_cast<std::size_t>(grid->occupied_blocks()) * kTileNodes * kSum); }
};

// Particles to nodes: mass, momentum, internal force and loads, volume into sums [slots * kSum]; velocities
// of the nodes from their mass and momentum, zero where there is none [slots * kVector].
template <int D>
void scatter_state(Transfer<D>& transfer, AffineKind affine, Reals& sums, Reals& velocity);

// The same of points of a fluid, which carry no stress: mass, momentum and weight.
template <int D>
void scatter_fluid(Transfer<D>& transfer, AffineKind affine, Reals& sums, Reals& velocity);

// Particles to cells by the overlap of their domains: {V of wet soil, V of its solid, conductivity * V, mass
// of the water in all soil, or where some is retained that} into cells [slots * kCellSum].
template <int D>
void scatter_cells(Transfer<D>& transfer, Reals& cells);

// The same of points of a fluid: their volume alone [slots].
template <int D>
void scatter_volume(Transfer<D>& transfer, Reals& cells);

// Particle velocities from nodal ones,
//   v_p = flip (v_p + sum N (v_new - v_old)) + (1 - flip) sum N v_new,
// and the velocities of the nodes that their momenta give, with the mass in `sums` (MUSL).
template <int D>
void update_velocities(Transfer<D>& transfer, double flip, const Reals& v_old, const Reals& v_new,
                       const Reals& sums, Reals& mapped);

// Water in the pores of points that carry its pressure (and, with its full inertia, its velocity w) to nodes
// [slots * kSum], in the lanes of scatter_state(): mass of the water, momentum, force sum V p grad N of the
// pore pressure on soil and water together, volume of soil over conductivity [m2 s]. density: of water.
// kozeny_carman: conductivity is the points' times n^3 / (1 - n)^2. velocity: as there.
template <int D>
void scatter_pore_water(Transfer<D>& transfer, double density, bool kozeny_carman, Reals& sums,
                        Reals& velocity);

// update_velocities() for that water; mapped may be null.
template <int D>
void update_pore_velocities(Transfer<D>& transfer, double density, double flip, const Reals& w_old,
                            const Reals& w_new, const Reals& sums, Reals* mapped);

// Of the flow of water relative to the grains at the nodes, q [slots * kVector], dt div q at the points into
// ParticleSet::expelled; cell_average: as the volumetric strain in MoveOptions.
template <int D>
void gather_expelled(Transfer<D>& transfer, double dt, const Reals& flow, bool cell_average);

struct MoveOptions {
  double dt = 0;
  AffineKind affine = AffineKind::none;
  bool update_velocity = false;  // USL: blend velocities here too (v_old must be given)
  double flip = 0.99;
  // Locking cure: points of a body that the last sort found in one cell share their mean volumetric strain.
  bool cell_average = false;
};

struct MoveResult {
  double largest_displacement = 0;  // of any point and axis in this step [cells]
  double largest_speed = 0;         // [m/s]
  int fastest_body = -1, fastest_slot = -1;
  bool finite = true;
};

// Position and velocity gradient from v, stress by the law, volume and domain by the strain.
template <int D>
MoveResult update_stress_and_move(Transfer<D>& transfer, const MoveOptions& options, const Reals* v_old,
                                  const Reals& v);

// Moves the points by a displacement of the nodes [slots * kVector], which is linear in between, by at most
// `most` along an axis; returns the largest such move [m].
template <int D>
double shift_points(Transfer<D>& transfer, const Reals& displacement, double most);

// A law of the running vector level; keep the handle as long as kernels use it.
std::shared_ptr<const void> make_law_handle(int dimension, const MaterialParameters& material, bool plastic);

}  // namespace polder::mpm
