// One step of the material point method written as plain loops over all particles and all nodes, for
// comparison with the particle kernels. It shares nothing with them: textbook shape functions of the distance
// to each node, explicit ghost nodes outside the grid with the value 2 v_0 - v_1, dense nodal arrays, no
// blocks, no packs.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "mpm/skeleton.hpp"

namespace polder::oracle {

using mpm::AffineKind;
using mpm::ShapeKind;

// N and dN/dx (per cell) of the node at distance x = (x_p - x_i) / h; l = half size of the domain / h.
inline void shape(ShapeKind kind, double x, double l, double& value, double& slope) {
  const double r = std::abs(x), sign = x < 0 ? -1 : 1;
  value = slope = 0;
  switch (kind) {
    case ShapeKind::linear:
      if (r < 1) value = 1 - r, slope = -sign;
      break;
    case ShapeKind::gimp:
      if (r < l)
        value = 1 - (r * r + l * l) / (2 * l), slope = -x / l;
      else if (r <= 1 - l)
        value = 1 - r, slope = -sign;
      else if (r < 1 + l)
        value = (1 + l - r) * (1 + l - r) / (4 * l), slope = -sign * (1 + l - r) / (2 * l);
      break;
    case ShapeKind::quadratic_bspline:
      if (r < 0.5)
        value = 0.75 - r * r, slope = -2 * x;
      else if (r < 1.5)
        value = 0.5 * (1.5 - r) * (1.5 - r), slope = -sign * (1.5 - r);
      break;
  }
}

template <int D>
struct Particle {
  std::array<double, D> x{}, v{}, half{};
  double mass = 0, volume = 0;
  double stress[3][3] = {};
  double c[D][D] = {};  // affine velocity field
};

template <int D>
class Model {
 public:
  std::vector<Particle<D>> particles;
  ShapeKind kind = ShapeKind::gimp;
  bool musl = true, axisymmetric = false;
  AffineKind affine = AffineKind::none;
  double flip = 0.99, h = 1, lame = 0, shear = 0;
  std::array<double, D> origin{}, gravity{};
  std::array<int, D> cells{};

  void step(double dt) {
    const int n = node_count();
    std::vector<double> m(n, 0.0);
    std::vector<std::array<double, D>> momentum(n), force(n), v_old(n), v_new(n);
    for (auto* a : {&momentum, &force})
      for (auto& x : *a) x = {};
    for (const Particle<D>& p : particles)
      for (const Node& k : stencil(p)) {
        m[k.index] += k.weight * p.mass;
        for (int i = 0; i < D; ++i) {
          double v = p.v[i];
          if (affine != AffineKind::none)
            for (int j = 0; j < D; ++j) v += p.c[i][j] * k.offset[j];
          momentum[k.index][i] += k.weight * p.mass * v;
          for (int j = 0; j < D; ++j) force[k.index][i] -= p.volume * p.stress[i][j] * k.slope[j];
        }
        if (axisymmetric) force[k.index][0] -= k.weight * p.volume * p.stress[2][2] / p.x[0];
      }
    for (int i = 0; i < n; ++i)
      for (int d = 0; d < D; ++d) {
        v_old[i][d] = m[i] > 0 ? momentum[i][d] / m[i] : 0;
        v_new[i][d] = m[i] > 0 ? v_old[i][d] + dt * (force[i][d] / m[i] + gravity[d]) : 0;
      }
    hold_sides(v_new);

    std::vector<std::array<double, D>> v_gradient = v_new;
    if (affine == AffineKind::none)
      for (Particle<D>& p : particles) {
        std::array<double, D> change{}, pic{};
        for (const Node& k : stencil(p))
          for (int d = 0; d < D; ++d)
            change[d] += k.weight * (v_new[k.index][d] - v_old[k.index][d]),
                pic[d] += k.weight * v_new[k.index][d];
        for (int d = 0; d < D; ++d) p.v[d] = flip * (p.v[d] + change[d]) + (1 - flip) * pic[d];
      }
    if (musl) {
      for (auto& v : v_gradient) v = {};
      for (const Particle<D>& p : particles)
        for (const Node& k : stencil(p))
          for (int d = 0; d < D; ++d) v_gradient[k.index][d] += k.weight * p.mass * p.v[d] / m[k.index];
      hold_sides(v_gradient);
    }
    for (Particle<D>& p : particles)
      move(p, musl ? v_gradient : v_new, v_gradient, dt);  // v_gradient under MUSL
  }

 private:
  struct Node {
    int index;
    double weight;
    std::array<double, D> slope, offset;  // offset: node minus particle [m]
  };

  int node_count() const {
    int n = 1;
    for (int d = 0; d < D; ++d) n *= cells[d] + 1;
    return n;
  }

  std::vector<Node> stencil(const Particle<D>& p) const {
    std::array<std::vector<std::array<double, 2>>, D> axis;  // per node of the axis: N, dN/dx
    for (int d = 0; d < D; ++d) {
      axis[d].assign(cells[d] + 1, {0.0, 0.0});
      for (int i = -1; i <= cells[d] + 1; ++i) {
        double v, s;
        shape(kind, (p.x[d] - origin[d]) / h - i, p.half[d] / h, v, s);
        const auto add = [&](int node, double f) {
          axis[d][node][0] += f * v, axis[d][node][1] += f * s / h;
        };
        if (i < 0)
          add(0, 2), add(1, -1);
        else if (i > cells[d])
          add(cells[d], 2), add(cells[d] - 1, -1);
        else
          add(i, 1);
      }
    }
    std::vector<Node> nodes;
    for (int index = 0; index < node_count(); ++index) {
      Node k{index, 1, {}, {}};
      for (int d = 0; d < D; ++d) k.slope[d] = 1;
      bool touched = false;
      int rest = index;
      bool far = false;
      for (int d = 0; d < D; ++d) {
        const int i = rest % (cells[d] + 1);
        rest /= cells[d] + 1;
        const auto& a = axis[d][i];
        far |= a[0] == 0 && a[1] == 0;
        k.weight *= a[0];
        for (int e = 0; e < D; ++e) k.slope[e] *= e == d ? a[1] : a[0];
        k.offset[d] = origin[d] + i * h - p.x[d];
      }
      touched = !far;
      if (touched) nodes.push_back(k);
    }
    return nodes;
  }

  // Rollers on every side.
  void hold_sides(std::vector<std::array<double, D>>& v) const {
    for (int index = 0; index < node_count(); ++index) {
      int rest = index;
      for (int d = 0; d < D; ++d) {
        const int i = rest % (cells[d] + 1);
        rest /= cells[d] + 1;
        if (i == 0 || i == cells[d]) v[index][d] = 0;
      }
    }
  }

  void move(Particle<D>& p, const std::vector<std::array<double, D>>& v_new,
            const std::vector<std::array<double, D>>& v_gradient, double dt) const {
    std::array<double, D> carried{}, radial{};
    double g[3][3] = {}, moment[D][D] = {}, second[D] = {};
    for (const Node& k : stencil(p))
      for (int i = 0; i < D; ++i) {
        carried[i] += k.weight * v_new[k.index][i];
        radial[i] += k.weight * v_gradient[k.index][i];
        second[i] += k.weight * k.offset[i] * k.offset[i];
        for (int j = 0; j < D; ++j) {
          g[i][j] += dt * v_gradient[k.index][i] * k.slope[j];
          moment[i][j] += k.weight * v_new[k.index][i] * k.offset[j];
        }
      }
    if (affine != AffineKind::none)
      for (int i = 0; i < D; ++i) {
        p.v[i] = carried[i];
        for (int j = 0; j < D; ++j)
          p.c[i][j] = affine == AffineKind::apic ? moment[i][j] / second[j] : g[i][j] / dt;
      }
    const double hoop = axisymmetric ? dt * radial[0] / p.x[0] : 0;
    update_stress(p, g, hoop);
    for (int d = 0; d < D; ++d) p.x[d] += dt * carried[d];
  }

  // Displacement gradient of the step, referred to its start, to stress, volume and domain: the gradient is
  // referred to the midpoint, H = G (I + G/2)^-1; its skew part turns the stress by the Cayley transform, its
  // symmetric part strains.
  void update_stress(Particle<D>& p, const double (&g)[3][3], double hoop) const {
    double a[3][3], inverse[3][3], mid[3][3] = {}, w[3][3], q[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) a[i][j] = (i == j) + 0.5 * g[i][j];
    invert(a, inverse);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) mid[i][j] += g[i][k] * inverse[k][j];
    double left[3][3], right[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        w[i][j] = 0.5 * (mid[i][j] - mid[j][i]);
        left[i][j] = (i == j) - 0.5 * w[i][j], right[i][j] = (i == j) + 0.5 * w[i][j];
      }
    invert(left, inverse);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        q[i][j] = 0;
        for (int k = 0; k < 3; ++k) q[i][j] += inverse[i][k] * right[k][j];
      }
    const double hoop_mid = hoop / (1 + 0.5 * hoop);
    const double trace = mid[0][0] + mid[1][1] + (axisymmetric ? hoop_mid : mid[2][2]);
    double turned[3][3] = {};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l) turned[i][j] += q[i][k] * p.stress[k][l] * q[j][l];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        double strain = 0.5 * (mid[i][j] + mid[j][i]);
        if (axisymmetric && i == 2 && j == 2) strain = hoop_mid;
        p.stress[i][j] = turned[i][j] + 2 * shear * strain + (i == j ? lame * trace : 0);
      }
    double f[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) f[i][j] = (i == j) + g[i][j];
    p.volume *= determinant(f) * (1 + hoop);
    for (int d = 0; d < D; ++d) p.half[d] *= 1 + g[d][d];
  }

  static double determinant(const double (&a)[3][3]) {
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
           a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
  }
  static void invert(const double (&a)[3][3], double (&b)[3][3]) {
    const double det = determinant(a);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int r = (j + 1) % 3, s = (j + 2) % 3, t = (i + 1) % 3, u = (i + 2) % 3;
        b[i][j] = (a[r][t] * a[s][u] - a[r][u] * a[s][t]) / det;
      }
  }
};

}  // namespace polder::oracle
