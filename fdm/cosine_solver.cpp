#include "fdm/cosine_solver.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/threads.hpp"

namespace polder::fdm {
namespace {

constexpr double kSame = 1e-12;        // relative difference of values that count as equal
constexpr int kParallelCells = 16384;  // fewer are done before the other threads have started
constexpr int kColumns = 256;          // wave numbers swept together: a few lines of L1 for each layer
constexpr double kUnset = -1;          // no link or sink is negative

bool same(double a, double b, double scale) {
  return std::abs(a - b) <= kSame * scale;  // false for NaN
}

template <class F>
void for_chunks(int cells, int chunks, const F& f) {
  if (cells < kParallelCells)
    for (int i = 0; i < chunks; ++i) f(i);
  else
    parallel_for(chunks, f);
}

}  // namespace

template <int D>
void CosineSolver<D>::analyse(const Connectivity<D>& connectivity) {
  ++this->counts_.structures;
  connectivity_ = connectivity;
  full_box_ = false;
  arranged_axis_ = -1;
  transform_axes_.clear();
  const auto& cells = connectivity.cells;
  if (cells.empty()) return;
  lower_ = cells[0];
  Index<D> upper = cells[0];
  for (const Index<D>& c : cells)
    for (int d = 0; d < D; ++d) {
      lower_[d] = std::min(lower_[d], c[d]);
      upper[d] = std::max(upper[d], c[d]);
    }
  std::size_t box = 1, links = 0;
  for (int d = 0; d < D; ++d) box *= size_[d] = upper[d] - lower_[d] + 1;
  for (int d = 0; d < D; ++d) links += box / size_[d] * (size_[d] - 1);
  if (box != cells.size() || links != connectivity.links.size()) return;
  full_box_ = true;
  defect_.analyse(connectivity);
  number_.resize(box);
  for (std::size_t i = 0; i < box; ++i) {
    std::size_t place = 0;
    for (int d = D - 1; d >= 0; --d) place = place * size_[d] + cells[i][d] - lower_[d];
    number_[place] = static_cast<int>(i);
  }
}

template <int D>
int CosineSolver<D>::cell_at(const Index<D>& place) const {
  std::size_t n = 0;
  for (int d = D - 1; d >= 0; --d) n = n * size_[d] + place[d];
  return number_[n];
}

template <int D>
bool CosineSolver<D>::find_links(const SystemValues& system, Layers& layers) const {
  const int a = layers.axis;
  for (auto& link : layers.link) link.assign(size_[a], kUnset);
  const auto& links = connectivity_.links;
  for (std::size_t k = 0; k < links.size(); ++k) {
    double& link = layers.link[links[k].axis][connectivity_.cells[links[k].low][a] - lower_[a]];
    if (link == kUnset && system.link[k] >= 0) link = system.link[k];
    if (!same(system.link[k], link, link)) return false;
  }
  for (auto& along : layers.link)
    for (double& link : along)
      if (link == kUnset) link = 0;  // beyond the end, or an axis of one cell
  return true;
}

template <int D>
bool CosineSolver<D>::find_sinks(const SystemValues& system, Layers& layers) const {
  const int a = layers.axis, last = size_[a] - 1;
  // Cells away from the sides tell the sink of their layer. An axis of one or two cells has none: there all
  // sinks of a layer must be equal, as they are between walls.
  Index<D> inside{};
  for (int d = 0; d < D; ++d) inside[d] = size_[d] > 2 ? 1 : 0;
  layers.sink.resize(size_[a]);
  bool closed = true;
  for (int j = 0; j <= last; ++j) {
    inside[a] = j;
    layers.sink[j] = system.sink[cell_at(inside)];
    closed = closed && layers.sink[j] == 0;
  }
  for (int d = 0; d < D; ++d) {
    layers.ends[d] = {Parity::even, Parity::even};
    if (d == a || size_[d] <= 2) continue;
    const double face = 2 * layers.link[d][last];
    for (int end = 0; end < 2; ++end) {
      Index<D> side = inside;  // in the last layer; the pin of a closed box is usually in the first
      side[d] = end == 0 ? 0 : size_[d] - 1;
      const double excess = system.sink[cell_at(side)] - layers.sink[last];
      if (same(excess, face, face)) layers.ends[d][end] = Parity::odd;
      closed = closed && layers.ends[d][end] == Parity::even;
    }
  }
  layers.pinned.reset();
  for (std::size_t i = 0; i < connectivity_.cells.size(); ++i) {
    const Index<D>& cell = connectivity_.cells[i];
    const int j = cell[a] - lower_[a];
    double expected = layers.sink[j], scale = expected;
    for (int d = 0; d < D; ++d) {
      const double face = 2 * layers.link[d][j];
      scale += face;
      if (d == a || size_[d] <= 2) continue;
      if (cell[d] == lower_[d] && layers.ends[d][0] == Parity::odd) expected += face;
      if (cell[d] == lower_[d] + size_[d] - 1 && layers.ends[d][1] == Parity::odd) expected += face;
    }
    if (same(system.sink[i], expected, scale)) continue;
    if (!closed || layers.pinned || !(system.sink[i] > 0)) return false;
    layers.pinned = {i, system.sink[i]};
  }
  return !closed || layers.pinned;
}

template <int D>
bool CosineSolver<D>::find_layers(const SystemValues& system, int axis, Layers& layers) const {
  layers.axis = axis;
  return find_links(system, layers) && find_sinks(system, layers);
}

template <int D>
bool CosineSolver<D>::applies(const SystemValues& system) {
  if (!full_box_) return false;
  for (int axis = D - 1; axis >= 0; --axis)  // layers are level more often than not
    if (find_layers(system, axis, layers_)) return true;
  return false;
}

// Places of the cells and transforms for the axis and ends of the layers found.
template <int D>
void CosineSolver<D>::arrange() {
  const int a = layers_.axis;
  std::vector<CellTransform::Axis> axes;
  for (int d = D - 1; d >= 0; --d)
    if (d != a) axes.push_back({size_[d], layers_.ends[d][0], layers_.ends[d][1]});
  if (arranged_axis_ == a && transform_axes_ == axes) return;
  arranged_axis_ = a;
  transform_axes_ = axes;
  transform_.emplace(axes);
  count_ = size_[a];
  layer_cells_ = static_cast<int>(number_.size()) / count_;
  stride_ = (layer_cells_ + 7) / 8 * 8;
  position_.resize(number_.size());
  for (std::size_t i = 0; i < position_.size(); ++i) {
    int column = 0;
    for (int d = D - 1; d >= 0; --d)
      if (d != a) column = column * size_[d] + connectivity_.cells[i][d] - lower_[d];
    position_[i] = (connectivity_.cells[i][a] - lower_[a]) * stride_ + column;
  }
  int repeat = 1;  // columns after which the wave number along the axis changes
  for (int d = 0; d < D; ++d) {
    if (d == a) continue;
    const std::vector<double> values =
        CellTransform::eigenvalues({size_[d], layers_.ends[d][0], layers_.ends[d][1]});
    eigenvalue_[d].resize(layer_cells_);
    for (int c = 0; c < layer_cells_; ++c) eigenvalue_[d][c] = values[c / repeat % size_[d]];
    repeat *= size_[d];
  }
  work_.assign(static_cast<std::size_t>(count_) * stride_, 0);
  pivot_.assign(work_.size(), 0);
}

// Pivots of the tridiagonal matrices as excess over the next link, pivot_j = excess_j + link_j with
//   excess_j = own_j + link_{j-1} excess_{j-1} / pivot_{j-1},
// a sum of positive numbers: exact to rounding also where the sinks are tiny beside the links.
template <int D>
void CosineSolver<D>::factorise() {
  const int a = layers_.axis;
  for_chunks(static_cast<int>(number_.size()), (layer_cells_ + kColumns - 1) / kColumns, [&](int chunk) {
    const int begin = chunk * kColumns, n = std::min(kColumns, layer_cells_ - begin);
    double excess[kColumns] = {};
    for (int j = 0; j < count_; ++j) {
      double* __restrict inverse = pivot_.data() + static_cast<std::size_t>(j) * stride_ + begin;
      const double next = layers_.link[a][j], sink = layers_.sink[j];
      if (j > 0) {
        const double before = layers_.link[a][j - 1];
        const double* __restrict above = inverse - stride_;
        for (int c = 0; c < n; ++c) excess[c] = sink + before * excess[c] * above[c];
      } else {
        std::fill_n(excess, n, sink);
      }
      for (int d = 0; d < D; ++d) {
        if (d == a) continue;
        const double link = layers_.link[d][j];
        const double* __restrict eigenvalue = eigenvalue_[d].data() + begin;
        for (int c = 0; c < n; ++c) excess[c] += link * eigenvalue[c];
      }
      for (int c = 0; c < n; ++c) inverse[c] = 1 / (excess[c] + next);
    }
  });
  // A closed box determines its mean up to a constant: the last value of the mean column is set to zero.
  if (layers_.pinned) pivot_[static_cast<std::size_t>(count_ - 1) * stride_] = 0;
}

template <int D>
void CosineSolver<D>::solve_layers(std::span<const double> rhs, std::span<double> x) {
  const int cells = static_cast<int>(number_.size());
  const auto& pinned = layers_.pinned;
  for (int i = 0; i < cells; ++i) work_[position_[i]] = rhs[i];
  double total = 0;  // of a closed box: all that the pin takes
  if (pinned) {
    for (double b : rhs) total += b;
    work_[position_[pinned->first]] -= total;
  }
  for_chunks(cells, count_,
             [&](int j) { transform_->forward(work_.data() + static_cast<std::size_t>(j) * stride_); });
  const auto& link = layers_.link[layers_.axis];
  for_chunks(cells, (layer_cells_ + kColumns - 1) / kColumns, [&](int chunk) {
    const int begin = chunk * kColumns, n = std::min(kColumns, layer_cells_ - begin);
    for (int j = 1; j < count_; ++j) {
      double* __restrict w = work_.data() + static_cast<std::size_t>(j) * stride_ + begin;
      const double* __restrict before = w - stride_;
      const double* __restrict inverse = pivot_.data() + static_cast<std::size_t>(j - 1) * stride_ + begin;
      for (int c = 0; c < n; ++c) w[c] += link[j - 1] * inverse[c] * before[c];
    }
    for (int j = count_ - 1; j >= 0; --j) {
      double* __restrict w = work_.data() + static_cast<std::size_t>(j) * stride_ + begin;
      const double* __restrict inverse = pivot_.data() + static_cast<std::size_t>(j) * stride_ + begin;
      if (j + 1 < count_) {
        const double* __restrict next = w + stride_;
        for (int c = 0; c < n; ++c) w[c] = (w[c] + link[j] * next[c]) * inverse[c];
      } else {
        for (int c = 0; c < n; ++c) w[c] *= inverse[c];
      }
    }
  });
  for_chunks(cells, count_,
             [&](int j) { transform_->backward(work_.data() + static_cast<std::size_t>(j) * stride_); });
  const double scale = 1 / transform_->scale();
  const double shift = pinned ? total / pinned->second - scale * work_[position_[pinned->first]] : 0;
  for (int i = 0; i < cells; ++i) x[i] = scale * work_[position_[i]] + shift;
}

template <int D>
SolveReport CosineSolver<D>::solve(const SystemValues& system, const Accuracy& accuracy,
                                   std::span<double> x) {
  ++this->counts_.systems;
  std::fill(x.begin(), x.end(), 0.0);
  if (x.empty()) return {};
  if (!applies(system))
    throw NumericalError(
        "pressure equation: the cosine transform needs a full box of cells whose coefficients vary along one "
        "axis at most, with walls or faces of prescribed pressure across the others");
  const double b = defect_.start(system);
  if (!std::isfinite(b)) throw NumericalError("pressure equation: the right-hand side is not finite");
  if (b <= accuracy.floor) return {};
  arrange();
  factorise();
  return defect_.refine(
      system, accuracy, b, name(), x,
      [&](std::span<const double> rhs, std::span<double> solution) { solve_layers(rhs, solution); });
}

template class CosineSolver<2>;
template class CosineSolver<3>;

}  // namespace polder::fdm
