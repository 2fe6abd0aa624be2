#include "core/particles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.hpp"

namespace polder {

template <int D>
std::vector<ParticleField> ParticleSet<D>::fields() {
  static const char axis[] = "xyz";
  static const char* const component[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  std::vector<ParticleField> all;
  const auto add = [&](const std::string& n, Reals& r, double padding = 0) {
    all.push_back({n, &r, padding});
  };
  for (int d = 0; d < D; ++d) {
    add(std::string("position_") + axis[d], position[d]);
    add(std::string("velocity_") + axis[d], velocity[d]);
    add(std::string("half_size_") + axis[d], half_size[d], reference_half_size);
    add(std::string("initial_position_") + axis[d], initial_position[d]);
    if (!body_acceleration[d].empty()) add(std::string("body_acceleration_") + axis[d], body_acceleration[d]);
  }
  add("mass", mass);
  add("volume", volume);
  for (int k = 0; k < kStress; ++k) add(std::string("effective_stress_") + component[k], stress[k]);
  for (std::size_t k = 0; k < state.size(); ++k)
    add("state_" + std::to_string(k), state[k], k < state_padding.size() ? state_padding[k] : 0);
  for (int k = 0; k < D * D; ++k)
    if (!affine[k].empty()) add("affine_" + std::to_string(k), affine[k]);
  if (!pore_water.empty()) add("pore_water", pore_water);
  if (!retained_water.empty()) add("retained_water", retained_water);
  if (!suction_stress.empty()) add("suction_stress", suction_stress);
  if (!conductivity.empty()) add("conductivity", conductivity);
  if (!wet.empty()) add("wet", wet);
  if (!pore_pressure.empty()) add("pore_pressure", pore_pressure);
  if (!expelled.empty()) add("expelled", expelled);
  for (int d = 0; d < D; ++d)
    if (!water_velocity[d].empty()) add(std::string("water_velocity_") + axis[d], water_velocity[d]);
  if (group_by_cell) add("home_cell", home_cell);
  return all;
}

template <int D>
void ParticleSet<D>::append(int n) {
  const int before = slots();
  for (ParticleField& f : fields()) f.values->resize(before + n, 0.0);
  for (int i = 0; i < n; ++i) id.push_back(next_id_ + i);
  next_id_ += n;
  count_ += n;
  index_ids();
}

template <int D>
int ParticleSet<D>::insert(int block) {
  const Range range = block < static_cast<int>(ranges.size()) ? ranges[block] : Range{};
  int p = range.first;
  while (p < range.first + range.count && id[p] >= 0) ++p;
  if (p == range.first + range.count) return -1;
  for (ParticleField& f : fields()) (*f.values)[p] = 0;
  id[p] = next_id_++;
  slot_of_id_.push_back(p);
  ++count_;
  return p;
}

template <int D>
void ParticleSet<D>::remove(int p) {
  slot_of_id_[id[p]] = -1;
  id[p] = -1;
  mass[p] = volume[p] = 0;
  for (int d = 0; d < D; ++d) velocity[d][p] = 0;
  --count_;
}

// A point this far beyond a side of the grid lies on it but for rounding [cells].
constexpr double kOnSide = 1e-9;

template <int D>
std::vector<int> ParticleSet<D>::occupied_block_numbers(const Grid<D>& grid) const {
  std::vector<char> seen(grid.block_numbers(), 0);
  for (int p = 0; p < slots(); ++p) {
    if (id[p] < 0) continue;
    Index<D> cell;
    for (int d = 0; d < D; ++d) {
      const double xi = (position[d][p] - grid.origin()[d]) / grid.spacing();
      if (!(xi >= -kOnSide && xi <= grid.cells()[d] + kOnSide)) {
        char text[256];
        std::snprintf(
            text, sizeof text,
            "point %d of body '%s' left the grid at (%.6g, %.6g%s%.6g) with velocity (%.4g, %.4g) m/s", id[p],
            name.c_str(), position[0][p], position[1][p], D == 3 ? ", " : " ; mass ",
            D == 3 ? position[D - 1][p] : mass[p], velocity[0][p], velocity[1][p]);
        throw NumericalError(text);
      }
      cell[d] = std::clamp(static_cast<int>(xi), 0, grid.cells()[d] - 1);
    }
    seen[grid.block_number(cell)] = 1;
  }
  std::vector<int> numbers;
  for (int b = 0; b < grid.block_numbers(); ++b)
    if (seen[b]) numbers.push_back(b);
  return numbers;
}

template <int D>
Index<D> ParticleSet<D>::cell_of(const Grid<D>& grid, int p) const {
  Index<D> cell;
  for (int d = 0; d < D; ++d)
    cell[d] = std::clamp(static_cast<int>((position[d][p] - grid.origin()[d]) / grid.spacing()), 0,
                         grid.cells()[d] - 1);
  return cell;
}

template <int D>
void ParticleSet<D>::sort(const Grid<D>& grid) {
  constexpr int kCells = Grid<D>::kCells;
  // Key of a point: stored block, then cell inside it. Counting sort, stable: the order is unique.
  const int blocks = grid.occupied_blocks();
  std::vector<int> key(slots(), -1), start(static_cast<std::size_t>(blocks) * kCells + 1, 0);
  for (int p = 0; p < slots(); ++p) {
    if (id[p] < 0) continue;
    key[p] = grid.slot(cell_of(grid, p));
    ++start[key[p] + 1];
  }
  // First slot of each block (padded), then of each cell.
  ranges.assign(blocks, Range{});
  int next = 0;
  for (int b = 0; b < blocks; ++b) {
    ranges[b].first = next;
    int in_block = 0;
    for (int c = 0; c < kCells; ++c) {
      const int n = start[b * kCells + c + 1];
      start[b * kCells + c + 1] = next + in_block;  // becomes the first slot of cell c
      in_block += n;
    }
    ranges[b].count = (in_block + kPackPadding - 1) / kPackPadding * kPackPadding;
    next += ranges[b].count;
  }
  std::vector<int> source(next, -1);
  for (int p = 0; p < slots(); ++p)
    if (key[p] >= 0) source[start[key[p] + 1]++] = p;

  Reals moved;
  for (ParticleField& f : fields()) {
    moved.assign(next, f.padding);
    for (int i = 0; i < next; ++i)
      if (source[i] >= 0) moved[i] = (*f.values)[source[i]];
    f.values->swap(moved);
  }
  if (group_by_cell)
    for (int i = 0; i < next; ++i)
      if (source[i] >= 0) home_cell[i] = key[source[i]] % kCells;
  std::vector<int> moved_id(next, -1);
  for (int i = 0; i < next; ++i)
    if (source[i] >= 0) moved_id[i] = id[source[i]];
  id.swap(moved_id);
  for (int b = 0; b < blocks; ++b) {  // padding points sit at their block's centre
    const Index<D> o = grid.block_origin(b);
    for (int i = ranges[b].first; i < ranges[b].first + ranges[b].count; ++i)
      if (id[i] < 0)
        for (int d = 0; d < D; ++d)
          position[d][i] = grid.origin()[d] + (o[d] + 0.5 * Grid<D>::kSide) * grid.spacing();
  }
  index_ids();
}

template <int D>
void ParticleSet<D>::restore(int next_id) {
  next_id_ = next_id;
  count_ = static_cast<int>(std::count_if(id.begin(), id.end(), [](int i) { return i >= 0; }));
  index_ids();
}

template <int D>
void ParticleSet<D>::index_ids() {
  slot_of_id_.assign(next_id_, -1);
  for (int p = 0; p < slots(); ++p)
    if (id[p] >= 0) slot_of_id_[id[p]] = p;
}

template class ParticleSet<2>;
template class ParticleSet<3>;

}  // namespace polder
