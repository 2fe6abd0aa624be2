#include "core/grid.hpp"

#include <algorithm>

namespace polder {

template <int D>
Grid<D>::Grid(Point<D> origin, Index<D> cells, double spacing)
    : origin_(origin), cells_(cells), spacing_(spacing) {
  for (int d = 0; d < D; ++d) block_count_[d] = cells[d] / kSide + 1;  // nodes run to cells[d] inclusive
  stored_.assign(block_numbers(), -1);
}

template <int D>
Point<D> Grid<D>::upper() const {
  Point<D> p;
  for (int d = 0; d < D; ++d) p[d] = origin_[d] + cells_[d] * spacing_;
  return p;
}

template <int D>
int Grid<D>::block_numbers() const {
  int n = 1;
  for (int d = 0; d < D; ++d) n *= block_count_[d];
  return n;
}

template <int D>
int Grid<D>::block_number(const Index<D>& cell) const {
  int n = 0;
  for (int d = D - 1; d >= 0; --d) n = n * block_count_[d] + cell[d] / kSide;
  return n;
}

template <int D>
bool Grid<D>::activate(std::vector<int> occupied) {
  std::sort(occupied.begin(), occupied.end());
  occupied.erase(std::unique(occupied.begin(), occupied.end()), occupied.end());

  const auto unpack = [&](int number) {
    Index<D> b;
    for (int d = 0; d < D; ++d) b[d] = number % block_count_[d], number /= block_count_[d];
    return b;
  };
  const auto neighbour_number = [&](const Index<D>& b, int k) {  // -1 outside the box
    int n = 0;
    Index<D> c;
    for (int d = 0; d < D; ++d) c[d] = b[d] + k % 3 - 1, k /= 3;
    for (int d = D - 1; d >= 0; --d) {
      if (c[d] < 0 || c[d] >= block_count_[d]) return -1;
      n = n * block_count_[d] + c[d];
    }
    return n;
  };

  std::vector<int> numbers = occupied;  // linear numbers of the new stored blocks
  {
    std::vector<char> seen(stored_.size(), 0);
    for (int n : occupied) seen[n] = 1;
    std::vector<int> halo;
    for (int n : occupied)
      for (int k = 0; k < kNeighbours; ++k) {
        const int m = neighbour_number(unpack(n), k);
        if (m >= 0 && !seen[m]) seen[m] = 1, halo.push_back(m);
      }
    std::sort(halo.begin(), halo.end());
    numbers.insert(numbers.end(), halo.begin(), halo.end());
  }

  bool same = static_cast<int>(numbers.size()) == blocks() && static_cast<int>(occupied.size()) == occupied_;
  for (int b = 0; same && b < blocks(); ++b) same = stored_[numbers[b]] == b;
  if (same) return false;

  previous_.assign(numbers.size(), -1);
  for (std::size_t b = 0; b < numbers.size(); ++b) previous_[b] = stored_[numbers[b]];
  std::fill(stored_.begin(), stored_.end(), -1);
  for (std::size_t b = 0; b < numbers.size(); ++b) stored_[numbers[b]] = static_cast<int>(b);
  occupied_ = static_cast<int>(occupied.size());
  block_index_.resize(numbers.size());
  neighbours_.resize(numbers.size());
  for (std::size_t b = 0; b < numbers.size(); ++b) {
    block_index_[b] = unpack(numbers[b]);
    for (int k = 0; k < kNeighbours; ++k) {
      const int m = neighbour_number(block_index_[b], k);
      neighbours_[b][k] = m < 0 ? -1 : stored_[m];
    }
  }
  ++revision_;
  return true;
}

template <int D>
Index<D> Grid<D>::block_origin(int block) const {
  Index<D> o = block_index_[block];
  for (int& x : o) x *= kSide;
  return o;
}

template <int D>
int Grid<D>::slot(const Index<D>& index) const {
  for (int d = 0; d < D; ++d)
    if (index[d] < 0 || index[d] > cells_[d]) return -1;
  const int block = stored_[block_number(index)];
  if (block < 0) return -1;
  int local = 0;
  for (int d = D - 1; d >= 0; --d) local = local * kSide + index[d] % kSide;
  return block * kCells + local;
}

template <int D>
Index<D> Grid<D>::index(int slot) const {
  Index<D> i = block_origin(slot / kCells);
  int local = slot % kCells;
  for (int d = 0; d < D; ++d) i[d] += local % kSide, local /= kSide;
  return i;
}

template <int D>
bool Grid<D>::is_cell(const Index<D>& index) const {
  for (int d = 0; d < D; ++d)
    if (index[d] < 0 || index[d] >= cells_[d]) return false;
  return true;
}

template <int D>
Point<D> Grid<D>::position(const Index<D>& node) const {
  Point<D> p;
  for (int d = 0; d < D; ++d) p[d] = origin_[d] + node[d] * spacing_;
  return p;
}

template <int D>
void Grid<D>::carry(Reals& field, int components, double fill) const {
  const std::size_t width = static_cast<std::size_t>(kCells) * components;
  Reals moved(blocks() * width, fill);
  for (int b = 0; b < blocks(); ++b)
    if (previous_[b] >= 0 && (previous_[b] + 1) * width <= field.size())
      std::copy_n(field.begin() + previous_[b] * width, width, moved.begin() + b * width);
  field = std::move(moved);
}

template class Grid<2>;
template class Grid<3>;

}  // namespace polder
