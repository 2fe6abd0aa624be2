#include "coupling/fluidisation.hpp"

#include "core/threads.hpp"

namespace polder::coupling {
namespace {

constexpr double kVanished = 1e-6;  // of Young's modulus: mean compression that counts as none

}  // namespace

template <int D>
void fluidise(World<D>& world) {
  if (!world.scene.fluidises()) return;
  std::vector<Reals>& fluid = world.pore_water->layer->fluidised;
  const bool dispersed = world.scene.dispersed();
  const auto& bodies = world.skeleton.bodies();
  fluid.resize(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    ParticleSet<D>& set = *bodies[b];
    const Material& material = world.scene.materials[set.material];
    const double threshold = material.fluidisation_porosity;
    if (threshold == 0) continue;
    fluid[b].resize(set.next_id(), 0.0);
    const double least = kVanished * material.young;
    parallel_for(set.slots(), [&](int p) {
      if (set.id[p] < 0) return;
      double& loose = fluid[b][set.id[p]];
      const double porosity = 1 - set.mass[p] / (set.density_solid * set.volume[p]);
      const double compression = -(set.stress[0][p] + set.stress[1][p] + set.stress[2][p]) / 3;
      if (porosity <= threshold)
        loose = 0;
      else if (dispersed || compression <= least)
        loose = 1;
      if (loose == 0) return;
      for (Reals& s : set.stress) s[p] = 0;
    });
  }
}

template <int D>
double fluidised_share(const World<D>& world) {
  const std::vector<Reals>& fluid = world.pore_water->layer->fluidised;
  const auto& bodies = world.skeleton.bodies();
  double loose = 0, all = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const ParticleSet<D>& set = *bodies[b];
    for (int p = 0; p < set.slots(); ++p) {
      if (set.id[p] < 0) continue;
      all += set.mass[p];
      if (b < fluid.size() && !fluid[b].empty()) loose += fluid[b][set.id[p]] * set.mass[p];
    }
  }
  return all > 0 ? loose / all : 0.0;
}

template void fluidise<2>(World<2>&);
template void fluidise<3>(World<3>&);
template double fluidised_share<2>(const World<2>&);
template double fluidised_share<3>(const World<3>&);

}  // namespace polder::coupling
