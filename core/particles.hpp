// Material points of one body, as a structure of arrays in block and cell order.
//
// Every block's range is padded to whole packs with massless points at the block's centre (id -1), so kernels
// need no masks and no tails. sort() puts the points in order of (block, cell), stably, so the order is a
// function of the state alone. Points are re-sorted only when one of them may have left the skin of its
// block's tile (kSkin cells); between sorts the order stands, whatever the number of threads.
#pragma once

#include <string>
#include <vector>

#include "core/grid.hpp"

namespace polder {

inline constexpr int kPackPadding = 8;  // the widest pack of any vector level
inline constexpr double kSkin = 0.45;   // distance in cells that a point may travel between two sorts

// A named array of a particle set, for sorting, checkpoints and output.
struct ParticleField {
  std::string name;
  Reals* values;
  double padding;  // value of massless padding points; positions are padded with the block's centre
};

template <int D>
class ParticleSet {
 public:
  static constexpr int kStress = D == 2 ? 4 : 6;  // xx yy zz xy (yz zx)
  struct Range {
    int first = 0;
    int count = 0;  // a multiple of kPackPadding
  };

  std::string name;
  int material = 0;
  double density_solid = 0;        // of the grains [kg/m3]
  double reference_half_size = 0;  // half the side of a point's initial domain [m]

  std::array<Reals, D> position;          // [m]
  std::array<Reals, D> velocity;          // [m/s]
  std::array<Reals, D> half_size;         // tracked half sides of the domain [m]
  std::array<Reals, D> initial_position;  // [m], for displacements
  Reals mass;                             // of the solid [kg per m thickness, per radian, or kg]
  Reals volume;                           // [m2, m2 r, m3]
  std::array<Reals, kStress> stress;      // effective, tension positive [Pa]
  std::vector<Reals> state;               // of the material law
  std::vector<double> state_padding;      // harmless state of padding points
  // Present only where the scene needs them (otherwise empty):
  std::array<Reals, D * D> affine;         // C of the affine transfer [1/s]
  std::array<Reals, D> body_acceleration;  // besides gravity [m/s2]
  Reals pore_water;                        // degree of saturation times water density [kg per m3 of pores]
  Reals retained_water;        // where water has points of its own: what stays with the grains of it [kg]
  Reals suction_stress;        // degree of saturation times suction [Pa], isotropic part of the total stress
  Reals conductivity;          // hydraulic conductivity [m/s]
  bool group_by_cell = false;  // keep home_cell
  Reals home_cell;             // cell inside its block where the last sort found the point
  Reals wet;                   // 1 where the pores are full of water, 0 above the phreatic line

  // Where the points carry the pore water's state: its pressure [Pa], volume of water that has flowed out of
  // a unit of volume in the last step [-], and with the water's full inertia its velocity [m/s].
  Reals pore_pressure, expelled;
  std::array<Reals, D> water_velocity;

  std::vector<int> id;        // -1 = padding
  std::vector<Range> ranges;  // one for each occupied block of the grid

  int slots() const { return static_cast<int>(id.size()); }  // with padding
  int count() const { return count_; }                       // points with mass

  // Add points: give every array of fields() `n` more entries (zero); ids continue after all ids ever given.
  // They belong to no block before the next sort().
  void append(int n);
  // A new point in a padding entry of the block it lies in, which belongs to that block as sorted ones do;
  // returns its index, all arrays there zero, or -1 where the block has no entry to spare.
  int insert(int block);
  // Take a point away: until the next sort() its entry stays as one of padding, at the same place.
  void remove(int p);
  // All arrays in use.
  std::vector<ParticleField> fields();

  // Linear block numbers of all points. Throws NumericalError when a point is outside the grid's box.
  std::vector<int> occupied_block_numbers(const Grid<D>& grid) const;
  // Cell that holds a point; one on an upper side of the grid, or beyond one, counts to the last cell.
  Index<D> cell_of(const Grid<D>& grid, int p) const;
  // Put the points in order of the grid's blocks (grid.activate() has been called for all sets).
  void sort(const Grid<D>& grid);
  // Position of the point with this id in the arrays, -1 when it was taken away.
  int find(int id) const { return slot_of_id_[id]; }
  int next_id() const { return next_id_; }  // one beyond the last id ever given
  // After the arrays were filled from a checkpoint: rebuild what is derived from them.
  void restore(int next_id);

 private:
  void index_ids();
  int count_ = 0;
  int next_id_ = 0;
  std::vector<int> slot_of_id_;
};

extern template class ParticleSet<2>;
extern template class ParticleSet<3>;

}  // namespace polder
