#include "bench/material_kernel.hpp"

namespace polder::bench {
namespace {

mpm::MaterialParameters sand() {
  mpm::MaterialParameters m;
  m.model = mpm::MaterialModel::mohr_coulomb;
  m.young = 2e7, m.poisson = 0.3;
  m.cohesion.value = {2e4};
  m.friction.value = {0.5235987755982988};  // 30 degrees
  m.dilation.value = {0.1};
  return m;
}

mpm::Mobilised exponential(double peak, double residual) {
  mpm::Mobilised c;
  c.kind = mpm::Mobilised::Kind::exponential;
  c.peak = peak, c.residual = residual, c.rate = 30;
  return c;
}

}  // namespace

std::vector<MaterialCase> material_cases() {
  std::vector<MaterialCase> cases;
  const auto add = [&](const std::string& name, const mpm::MaterialParameters& m,
                       std::vector<std::string> prototype = {}) {
    const char* kinds[] = {"elastic", "plane", "edges and apex"};
    for (int i = 0; i < 3; ++i)
      cases.push_back(
          {name + ", " + kinds[i], prototype.empty() ? "" : prototype[i], m, static_cast<Loading>(i)});
  };
  mpm::MaterialParameters elastic = sand();
  elastic.model = mpm::MaterialModel::linear_elastic;
  cases.push_back({"linear elastic", "", elastic, Loading::elastic});
  const std::vector<std::string> prototype = {"0.3 / 0.4", "2.2 / 7.4", "3.8 / 9.5"};
  add("Mohr-Coulomb, perfect", sand(), prototype);
  mpm::MaterialParameters softening = sand();
  softening.cohesion = exponential(2e4, 2e3);
  add("Mohr-Coulomb, exponential cohesion", softening, prototype);
  softening.friction = exponential(0.5235987755982988, 0.35);
  add("Mohr-Coulomb, exponential c and phi", softening);
  mpm::MaterialParameters levee = sand();
  levee.dilation.kind = mpm::Mobilised::Kind::piecewise_linear;
  levee.dilation.strain = {0.01, 0.2};
  levee.dilation.value = {0.05, 0.0};
  add("Mohr-Coulomb, piecewise linear dilation", levee);
  mpm::MaterialParameters clay = sand();
  clay.model = mpm::MaterialModel::tresca;
  clay.shear_strength = 2e4, clay.residual_strength = 5e3, clay.softening_modulus = -3e4;
  cases.push_back({"Tresca, linear softening, plane", "", clay, Loading::plane});
  clay.model = mpm::MaterialModel::von_mises;
  cases.push_back({"von Mises, linear softening", "", clay, Loading::plane});
  mpm::MaterialParameters rubber = sand();
  rubber.model = mpm::MaterialModel::neo_hookean;
  cases.push_back({"neo-Hookean", "", rubber, Loading::elastic});
  return cases;
}

}  // namespace polder::bench
