#include "fdm/suction_integrals.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace polder::fdm {
namespace {

constexpr double kSpacing = 0.02;  // of the nodes in ln(1 + h/h_0)
constexpr int kScaleNode = 480;    // the scale's node: h_0 is then 7e-5 of it

// Gauss-Legendre on [0, 1], four points.
constexpr std::array<double, 4> kPoint{0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                                       0.93056815579702629};
constexpr std::array<double, 4> kWeight{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                        0.17392742256872693};

// Cubic with the given values and slopes at 0 and `width`.
double cubic(double width, double y0, double y1, double d0, double d1, double at) {
  const double t = at / width, rise = y1 - y0;
  const double a = width * d0 - rise, b = rise - width * d1;
  return y0 + t * rise + t * (1 - t) * ((1 - t) * a + t * b);
}

}  // namespace

SuctionIntegrals::SuctionIntegrals(const std::function<std::pair<double, double>(double)>& curve,
                                   double scale, double driest)
    : first_(scale / std::expm1(kScaleNode * kSpacing)) {
  nodes_.push_back({0, 1, 1, 0, 0});
  std::vector<double> share;  // of the integral of k_r between a node and the next
  while (nodes_.back().head < driest) {
    const Node& last = nodes_.back();
    const double head = first_ * std::expm1(static_cast<double>(nodes_.size()) * kSpacing);
    const double width = head - last.head;
    double s = 0, k = 0;
    for (std::size_t g = 0; g < kPoint.size(); ++g) {
      const auto [sg, kg] = curve(last.head + kPoint[g] * width);
      s += kWeight[g] * sg;
      k += kWeight[g] * kg;
    }
    const auto [s_end, k_end] = curve(head);
    share.push_back(width * k);
    nodes_.push_back({head, s_end, k_end, last.sum_s + width * s, 0});
  }
  for (std::size_t i = share.size(); i > 0; --i) nodes_[i - 1].rest_k = nodes_[i].rest_k + share[i - 1];
}

const SuctionIntegrals::Node* SuctionIntegrals::node_below(double h) const {
  const auto i = static_cast<std::size_t>(std::log1p(h / first_) / kSpacing);
  const Node* node = &nodes_[std::min(i, nodes_.size() - 2)];
  while (node->head > h) --node;  // the logarithm rounds
  return node;
}

double SuctionIntegrals::saturation(double h) const {
  if (h <= 0) return h;
  if (h >= nodes_.back().head) return nodes_.back().sum_s + nodes_.back().s * (h - nodes_.back().head);
  const Node &a = *node_below(h), &b = *(&a + 1);
  return cubic(b.head - a.head, a.sum_s, b.sum_s, a.s, b.s, h - a.head);
}

double SuctionIntegrals::conductivity(double h) const {
  if (h <= 0) return nodes_.front().rest_k - h;
  if (h >= nodes_.back().head) return -nodes_.back().k * (h - nodes_.back().head);
  const Node &a = *node_below(h), &b = *(&a + 1);
  return cubic(b.head - a.head, a.rest_k, b.rest_k, -a.k, -b.k, h - a.head);
}

}  // namespace polder::fdm
