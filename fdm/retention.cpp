#include "fdm/retention.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "fdm/suction_integrals.hpp"

namespace polder::fdm {
namespace {

using Model = Retention::Model;

// Slopes of the monotone cubic through (x, y): weighted harmonic mean of the neighbouring secants, zero where
// these change sign.
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> slope(n, 0);
  const auto secant = [&](std::size_t i) { return (y[i + 1] - y[i]) / (x[i + 1] - x[i]); };
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double a = secant(i - 1), b = secant(i);
    if (a * b <= 0) continue;
    const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
    const double wa = (before + 2 * after) / (3 * (before + after)), wb = 1 - wa;
    slope[i] = 1 / (wa / a + wb / b);
  }
  slope.front() = secant(0), slope.back() = 0;  // constant beyond the last point
  return slope;
}

// Value and derivative of the cubic through two points.
struct Hermite {
  double value, slope;
};
Hermite hermite(double x0, double x1, double y0, double y1, double d0, double d1, double x) {
  const double w = x1 - x0, t = (x - x0) / w, secant = (y1 - y0) / w;
  const double c = 3 * secant - 2 * d0 - d1, d = d0 + d1 - 2 * secant;
  return {y0 + w * t * (d0 + t * (c + t * d)), d0 + t * (2 * c + 3 * t * d)};
}

void require(std::vector<std::string>& list, bool right, const char* sentence) {
  if (!right) list.emplace_back(sentence);
}

void check_table(const Retention& r, std::vector<std::string>& list) {
  const std::size_t n = r.suction_head.size();
  if (n < 2 || r.saturation.size() != n || r.relative_conductivity.size() != n) {
    list.emplace_back("a tabulated retention curve needs at least two points, each with three values");
    return;
  }
  require(list, r.suction_head.front() >= 0, "tabulated suction heads must not be negative");
  for (std::size_t i = 0; i < n; ++i) {
    const bool ends = i + 1 == n;
    require(list, ends || r.suction_head[i + 1] > r.suction_head[i], "tabulated suction heads must ascend");
    require(list, ends || r.saturation[i + 1] <= r.saturation[i], "tabulated saturation must not rise");
    require(list, r.saturation[i] > 0 && r.saturation[i] <= r.maximum,
            "tabulated saturation must lie above zero and not above the maximum");
    require(list, ends || r.relative_conductivity[i + 1] <= r.relative_conductivity[i],
            "tabulated relative conductivity must not rise");
    require(list, r.relative_conductivity[i] > 0 && r.relative_conductivity[i] <= 1,
            "tabulated relative conductivity must lie above zero and not above one");
  }
}

}  // namespace

std::vector<std::string> faults(const Retention& r) {
  std::vector<std::string> list;
  require(list, r.residual >= 0, "the residual saturation must not be negative");
  require(list, r.maximum > r.residual && r.maximum <= 1,
          "the maximum saturation must lie above the residual and not above one");
  switch (r.model) {
    case Model::saturated:
      break;
    case Model::van_genuchten:
      require(list, r.alpha > 0, "van Genuchten's alpha must be positive");
      require(list, r.n > 1, "van Genuchten's n must be greater than one");
      require(list, r.m >= 0 && r.m < 1, "van Genuchten's m must lie between zero and one");
      break;
    case Model::brooks_corey:
      require(list, r.entry_head > 0, "the air-entry head must be positive");
      require(list, r.lambda > 0, "the pore-size index must be positive");
      break;
    case Model::gardner:
      require(list, r.alpha > 0, "Gardner's alpha must be positive");
      break;
    case Model::haverkamp:
      require(list, r.haverkamp.saturation_factor > 0 && r.haverkamp.saturation_exponent > 0,
              "Haverkamp's factor and exponent of saturation must be positive");
      require(list, r.haverkamp.conductivity_factor > 0 && r.haverkamp.conductivity_exponent > 0,
              "Haverkamp's factor and exponent of conductivity must be positive");
      break;
    case Model::tabulated:
      check_table(r, list);
  }
  if (r.model == Model::van_genuchten || r.model == Model::brooks_corey)
    require(list, r.connectivity > -2, "the connectivity must be greater than -2");
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

RetentionCurve::RetentionCurve(const Retention& retention, double unit_weight)
    : r_(retention), per_weight_(1 / unit_weight), span_(retention.maximum - retention.residual) {
  std::string text;
  for (const std::string& f : faults(retention)) text += (text.empty() ? "" : "; ") + f;
  if (!(unit_weight > 0)) text += "the unit weight of water must be positive";
  if (!text.empty()) throw InputError("retention curve: " + text);
  m_ = r_.m > 0 ? r_.m : 1 - 1 / std::max(r_.n, 1.0);
  if (r_.model == Model::tabulated) prepare_table();
}

void RetentionCurve::prepare_table() {
  std::vector<double> head = r_.suction_head;
  s_ = r_.saturation, k_ = r_.relative_conductivity;
  if (head.front() > 0) {
    head.insert(head.begin(), 0.0);
    s_.insert(s_.begin(), r_.maximum);
    k_.insert(k_.begin(), 1.0);
  }
  s_.front() = r_.maximum, k_.front() = 1;  // what holds for p >= 0
  first_head_ = head[1];
  for (std::size_t i = 0; i < head.size(); ++i) {
    x_.push_back(std::log1p(head[i] / first_head_));
    s_[i] = (s_[i] - r_.residual) / span_;
    k_[i] = std::log(k_[i]);
  }
  s_slope_ = monotone_slopes(x_, s_);
  k_slope_ = monotone_slopes(x_, k_);
}

// ---- the curves, h > 0

inline RetentionCurve::Curve RetentionCurve::van_genuchten(double h) const {
  const double x = r_.alpha * h, u = std::pow(x, r_.n), log1 = std::log1p(u);
  const double s = std::exp(-m_ * log1);
  // 1 - (u / (1 + u))^m without cancellation in dry soil.
  const double bracket = u > 0 ? -std::expm1(m_ * (std::log(u) - log1)) : 1;
  const double l = r_.connectivity == 0.5 ? std::sqrt(s) : std::pow(s, r_.connectivity);
  return {s, -m_ * r_.n * r_.alpha * (u / x) * s / (1 + u), l * bracket * bracket};
}

inline RetentionCurve::Curve RetentionCurve::brooks_corey(double h) const {
  if (h <= r_.entry_head) return {};
  const double log_s = -r_.lambda * std::log(h / r_.entry_head), s = std::exp(log_s);
  return {s, -r_.lambda * s / h, std::exp(log_s * (2 / r_.lambda + 2 + r_.connectivity))};
}

inline RetentionCurve::Curve RetentionCurve::gardner(double h) const {
  const double s = std::exp(-r_.alpha * h);
  return {s, -r_.alpha * s, s};
}

inline RetentionCurve::Curve RetentionCurve::haverkamp(double h) const {
  const Retention::Haverkamp& p = r_.haverkamp;
  const double hb = std::pow(h, p.saturation_exponent), sum = p.saturation_factor + hb;
  const double s = p.saturation_factor / sum;
  return {s, -s * p.saturation_exponent * hb / (h * sum),
          p.conductivity_factor / (p.conductivity_factor + std::pow(h, p.conductivity_exponent))};
}

inline RetentionCurve::Curve RetentionCurve::tabulated(double h) const {
  const double x = std::log1p(h / first_head_);
  if (x >= x_.back()) return {s_.back(), 0, std::exp(k_.back())};
  const std::size_t i = std::upper_bound(x_.begin(), x_.end(), x) - x_.begin() - 1;
  const Hermite s = hermite(x_[i], x_[i + 1], s_[i], s_[i + 1], s_slope_[i], s_slope_[i + 1], x);
  const Hermite k = hermite(x_[i], x_[i + 1], k_[i], k_[i + 1], k_slope_[i], k_slope_[i + 1], x);
  return {s.value, s.slope / (first_head_ + h), std::exp(k.value)};
}

RetentionCurve::Curve RetentionCurve::at(double h) const {
  if (h <= 0) return {};
  switch (r_.model) {
    case Model::van_genuchten:
      return van_genuchten(h);
    case Model::brooks_corey:
      return brooks_corey(h);
    case Model::gardner:
      return gardner(h);
    case Model::haverkamp:
      return haverkamp(h);
    case Model::tabulated:
      return tabulated(h);
    case Model::saturated:
      break;
  }
  return {};
}

// Over the height of a cell with suction head h at its centre.
RetentionCurve::Curve RetentionCurve::mean(double h) const {
  const double low = h - 0.5 * height_, high = h + 0.5 * height_;
  if (high <= 0) return {};
  const double per_height = 1 / height_;
  return {(integrals_->saturation(high) - integrals_->saturation(low)) * per_height,
          (at(high).s - at(low).s) * per_height,
          (integrals_->conductivity(low) - integrals_->conductivity(high)) * per_height};
}

void RetentionCurve::average_over(double height) {
  height_ = always_saturated() ? 0 : height;
  full_pressure_ = 0.5 * height_ / per_weight_;
  if (height_ == 0 || integrals_) return;
  const double scale = r_.model == Model::brooks_corey ? r_.entry_head
                       : r_.model == Model::tabulated  ? first_head_
                       : r_.alpha > 0                  ? 1 / r_.alpha
                                                       : suction_head(0.5);
  integrals_ = std::make_shared<const SuctionIntegrals>(
      [this](double h) {
        const Curve c = at(h);
        return std::pair{c.s, c.k};
      },
      scale, 2 * kDriestSuction);
}

double RetentionCurve::saturation(double p) const {
  const double h = -p * per_weight_;
  return r_.residual + span_ * (height_ > 0 ? mean(h) : at(h)).s;
}

double RetentionCurve::capacity(double p) const {
  const double h = -p * per_weight_;
  return -span_ * per_weight_ * (height_ > 0 ? mean(h) : at(h)).c;
}

double RetentionCurve::relative_conductivity(double p) const {
  return at(-p * per_weight_).k;
}

void RetentionCurve::conductivity_slope(std::span<const int> which, std::span<const double> p,
                                        std::span<double> slope) const {
  constexpr double kStep = 1e-4;  // of h, for the difference quotient of the curve at a point
  for (const int i : which) {
    const double h = -p[i] * per_weight_;
    const double low = height_ > 0 ? h - 0.5 * height_ : h * (1 - kStep);
    const double high = height_ > 0 ? h + 0.5 * height_ : h * (1 + kStep);
    slope[i] = high > 0 ? per_weight_ * (at(low).k - at(high).k) / (high - low) : 0;
  }
}

void RetentionCurve::evaluate(std::span<const int> which, std::span<const double> p,
                              std::span<double> saturation, std::span<double> capacity,
                              std::span<double> relative_conductivity) const {
  const auto run = [&](const auto& curve) {
    for (const int i : which) {
      const Curve v = p[i] < 0 ? curve(-p[i] * per_weight_) : Curve{};
      saturation[i] = r_.residual + span_ * v.s;
      capacity[i] = -span_ * per_weight_ * v.c;
      relative_conductivity[i] = v.k;
    }
  };
  if (height_ > 0) {
    for (const int i : which) {
      const Curve v = mean(-p[i] * per_weight_);
      saturation[i] = r_.residual + span_ * v.s;
      capacity[i] = -span_ * per_weight_ * v.c;
      relative_conductivity[i] = v.k;
    }
    return;
  }
  switch (r_.model) {
    case Model::van_genuchten:
      return run([this](double h) { return van_genuchten(h); });
    case Model::brooks_corey:
      return run([this](double h) { return brooks_corey(h); });
    case Model::gardner:
      return run([this](double h) { return gardner(h); });
    case Model::haverkamp:
      return run([this](double h) { return haverkamp(h); });
    case Model::tabulated:
      return run([this](double h) { return tabulated(h); });
    case Model::saturated:
      return run([](double) { return Curve{}; });
  }
}

// ---- the inverse

double RetentionCurve::suction_head(double s) const {
  switch (r_.model) {
    case Model::van_genuchten:
      return std::pow(std::expm1(-std::log(s) / m_), 1 / r_.n) / r_.alpha;
    case Model::brooks_corey:
      return r_.entry_head * std::pow(s, -1 / r_.lambda);
    case Model::gardner:
      return -std::log(s) / r_.alpha;
    case Model::haverkamp:
      return std::pow(r_.haverkamp.saturation_factor * (1 - s) / s, 1 / r_.haverkamp.saturation_exponent);
    case Model::tabulated: {
      if (s <= s_.back()) return kDriestSuction;
      double low = 0, high = first_head_ * std::expm1(x_.back());
      for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
        const double middle = 0.5 * (low + high);
        (tabulated(middle).s > s ? low : high) = middle;
      }
      return 0.5 * (low + high);
    }
    case Model::saturated:
      break;
  }
  return 0;
}

double RetentionCurve::pressure(double saturation) const {
  const double s = (saturation - r_.residual) / span_;
  if (s >= 1 || r_.model == Model::saturated) return 0;
  const double head = s > 0 ? std::min(suction_head(s), kDriestSuction) : kDriestSuction;
  return -head / per_weight_;
}

}  // namespace polder::fdm
