#include "mpm/material/array_law.hpp"

#include "mpm/material/make_law.hpp"
#include "mpm/material/material.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {
namespace {

template <int D>
class PackedArrays final : public mpm::ArrayLaw {
 public:
  PackedArrays(const mpm::MaterialParameters& material, bool plastic)
      : law_(make_law<D>(material, plastic)), n_state_(mpm::state_layout(material, D).count()) {}

  void update(int count, double* stress, const double* strain, const double* gradient,
              double* state) const override {
    constexpr int kBatch = kBatchPacks * kLanes;
    for (int first = 0; first < count; first += kBatch) {
      const int n = count - first < kBatch ? count - first : kBatch;
      StressBatch<D> b;
      b.packs = (n + kLanes - 1) / kLanes;
      for (int i = 0; i < b.packs * kLanes; ++i) {
        // the last particle fills the lanes that are left over
        const int from = first + (i < n ? i : n - 1), pack = i / kLanes, lane = i % kLanes;
        for (int c = 0; c < kStress; ++c) {
          b.stress[pack][c][lane] = stress[c * count + from];
          b.strain[pack][c][lane] = strain[c * count + from];
        }
        for (int c = 0; c < D * D; ++c)
          b.gradient[pack][c][lane] =
              gradient != nullptr ? gradient[c * count + from] : strain[symmetric(c) * count + from];
        for (int c = 0; c < n_state_; ++c) b.state[pack][c][lane] = state[c * count + from];
      }
      law_->update(b);
      for (int i = 0; i < n; ++i) {
        const int to = first + i, pack = i / kLanes, lane = i % kLanes;
        for (int c = 0; c < kStress; ++c) stress[c * count + to] = b.stress[pack][c][lane];
        for (int c = 0; c < n_state_; ++c) state[c * count + to] = b.state[pack][c][lane];
      }
    }
  }

 private:
  static constexpr int kStress = StressBatch<D>::kStress;

  // strain component at the place c of a D x D matrix
  static int symmetric(int c) {
    constexpr int plane[] = {0, 3, 3, 1}, space[] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
    return D == 2 ? plane[c] : space[c];
  }

  std::unique_ptr<Law<D>> law_;
  int n_state_;
};

}  // namespace

std::unique_ptr<mpm::ArrayLaw> make_array_law(const mpm::MaterialParameters& material, int dimension,
                                              bool plastic) {
  if (dimension == 2) return std::make_unique<PackedArrays<2>>(material, plastic);
  return std::make_unique<PackedArrays<3>>(material, plastic);
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
