// Laws of this vector level behind an opaque handle.
#include "mpm/kernels/kernels.hpp"
#include "mpm/material/make_law.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

std::shared_ptr<const void> make_law_handle(int dimension, const mpm::MaterialParameters& material,
                                            bool plastic) {
  if (dimension == 2) return std::shared_ptr<const Law<2>>(make_law<2>(material, plastic));
  return std::shared_ptr<const Law<3>>(make_law<3>(material, plastic));
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
