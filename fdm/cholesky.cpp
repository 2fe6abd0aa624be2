#include "fdm/cholesky.hpp"

#include <cholmod.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/error.hpp"

namespace polder::fdm {

struct Cholesky::Impl {
  cholmod_common common;
  cholmod_sparse* matrix = nullptr;  // permuted, upper triangle
  cholmod_factor* factor = nullptr;
  cholmod_dense* rhs = nullptr;
  cholmod_dense* x = nullptr;
  cholmod_dense* work_y = nullptr;
  cholmod_dense* work_e = nullptr;
  int n = 0;
  std::vector<int> permutation;  // permuted row -> unknown
  std::vector<int> diagonal_at;  // position of each unknown's diagonal in the values of `matrix`
  std::vector<int> pair_at;      // position of each pair

  CholeskyMethod method;
  bool factorised = false;  // with the values of `matrix`

  explicit Impl(CholeskyMethod m) : method(m) {
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = m.supernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    common.final_ll = 0;
    common.nmethods = 1;
    common.error_handler = nullptr;
  }
  ~Impl() {
    release();
    cholmod_finish(&common);
  }
  void release() {
    cholmod_free_sparse(&matrix, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_free_dense(&rhs, &common);
    cholmod_free_dense(&x, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
  }

  // Upper triangle with rows sorted in each column; fills the positions.
  cholmod_sparse* pattern(std::span<const Pair> pairs, const std::vector<int>& row_of) {
    struct Entry {
      int column, row, source;  // source: unknown, or n + pair
    };
    std::vector<Entry> entries;
    entries.reserve(n + pairs.size());
    for (int i = 0; i < n; ++i) entries.push_back({row_of[i], row_of[i], i});
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto [low, high] = std::minmax(row_of[pairs[k].first], row_of[pairs[k].second]);
      entries.push_back({high, low, n + static_cast<int>(k)});
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return a.column != b.column ? a.column < b.column : a.row < b.row;
    });
    cholmod_sparse* m = cholmod_allocate_sparse(n, n, entries.size(), 1, 1, 1, CHOLMOD_REAL, &common);
    if (!m) throw NumericalError("sparse Cholesky: out of memory for the matrix");
    int* const p = static_cast<int*>(m->p);
    int* const rows = static_cast<int*>(m->i);
    double* const values = static_cast<double*>(m->x);
    std::fill(p, p + n + 1, 0);
    for (std::size_t e = 0; e < entries.size(); ++e) {
      rows[e] = entries[e].row;
      values[e] = 0;
      ++p[entries[e].column + 1];
      (entries[e].source < n ? diagonal_at[entries[e].source] : pair_at[entries[e].source - n]) =
          static_cast<int>(e);
    }
    for (int c = 0; c < n; ++c) p[c + 1] += p[c];
    return m;
  }

  void check(const char* what) const {
    if (common.status < 0)
      throw NumericalError(std::string("sparse Cholesky: ") + what + " failed, status " +
                           std::to_string(common.status));
  }
};

Cholesky::Cholesky(CholeskyMethod method) : impl_(std::make_unique<Impl>(method)) {}
Cholesky::~Cholesky() = default;
Cholesky::Cholesky(Cholesky&&) noexcept = default;
Cholesky& Cholesky::operator=(Cholesky&&) noexcept = default;

int Cholesky::size() const {
  return impl_->n;
}
double Cholesky::factor_entries() const {
  return impl_->common.lnz;
}

void Cholesky::analyse(int n, std::span<const Pair> off_diagonal) {
  Impl& s = *impl_;
  s.release();
  s.factorised = false;
  s.n = n;
  s.diagonal_at.resize(n);
  s.pair_at.resize(off_diagonal.size());
  s.permutation.resize(n);
  std::vector<int> row_of(n);
  for (int i = 0; i < n; ++i) row_of[i] = i;

  s.matrix = s.pattern(off_diagonal, row_of);
  s.common.method[0].ordering =
      s.method.ordering == CholeskyMethod::Ordering::minimum_degree ? CHOLMOD_AMD : CHOLMOD_METIS;
  s.common.postorder = 1;
  s.factor = cholmod_analyze(s.matrix, &s.common);
  s.check("ordering");
  std::copy_n(static_cast<int*>(s.factor->Perm), n, s.permutation.begin());
  for (int i = 0; i < n; ++i) row_of[s.permutation[i]] = i;
  s.release();

  s.matrix = s.pattern(off_diagonal, row_of);
  s.common.method[0].ordering = CHOLMOD_NATURAL;
  s.common.postorder = 0;
  s.factor = cholmod_analyze(s.matrix, &s.common);
  s.check("analysis");
  s.rhs = cholmod_zeros(n, 1, CHOLMOD_REAL, &s.common);
  s.check("allocation");
}

bool Cholesky::factorise(std::span<const double> diagonal, std::span<const double> off_diagonal) {
  Impl& s = *impl_;
  double* const values = static_cast<double*>(s.matrix->x);
  bool same = s.factorised;
  const auto set = [&](int at, double value) {
    same = same && values[at] == value;
    values[at] = value;
  };
  for (int i = 0; i < s.n; ++i) set(s.diagonal_at[i], diagonal[i]);
  for (std::size_t k = 0; k < off_diagonal.size(); ++k) set(s.pair_at[k], off_diagonal[k]);
  if (same) return false;
  s.factorised = false;
  cholmod_factorize(s.matrix, s.factor, &s.common);
  s.check("factorisation");
  if (s.common.status == CHOLMOD_NOT_POSDEF || static_cast<int>(s.factor->minor) < s.n)
    throw NumericalError("sparse Cholesky: the matrix is not positive definite (pivot " +
                         std::to_string(s.factor->minor) + " of " + std::to_string(s.n) + ")");
  s.factorised = true;
  return true;
}

void Cholesky::solve(std::span<const double> rhs, std::span<double> x) {
  Impl& s = *impl_;
  double* const b = static_cast<double*>(s.rhs->x);
  for (int i = 0; i < s.n; ++i) b[i] = rhs[s.permutation[i]];
  cholmod_solve2(CHOLMOD_A, s.factor, s.rhs, nullptr, &s.x, nullptr, &s.work_y, &s.work_e, &s.common);
  s.check("solution");
  const double* const y = static_cast<double*>(s.x->x);
  for (int i = 0; i < s.n; ++i) x[s.permutation[i]] = y[i];
}

}  // namespace polder::fdm
