// A constitutive law applied to plain arrays, whatever the vector level: for drivers of single material
// points, tests and other programs. The particle kernels use Law<D> (mpm/material/law.hpp) directly.
#pragma once

#include <memory>

#include "core/simd_level.hpp"
#include "mpm/material/parameters.hpp"

namespace polder::mpm {

class ArrayLaw {
 public:
  virtual ~ArrayLaw() = default;

  // One increment for `count` particles. Arrays are component-major, entry (component c, particle i) at [c *
  // count + i]: stress and strain have 4 (2D) or 6 (3D) components, gradient 4 or 9, state
  // state_layout().count(). Stress is not rotated here. gradient may be null for laws in rate form; then the
  // gradient is taken as the symmetric strain.
  virtual void update(int count, double* stress, const double* strain, const double* gradient,
                      double* state) const = 0;
};

}  // namespace polder::mpm

namespace polder {
POLDER_SIMD_DECLARE(std::unique_ptr<mpm::ArrayLaw>, make_array_law, const mpm::MaterialParameters&, int, bool)

namespace mpm {
inline std::unique_ptr<ArrayLaw> make_array_law(const MaterialParameters& material, int dimension,
                                                bool plastic = true) {
  return POLDER_SIMD_CALL(make_array_law, material, dimension, plastic);
}
}  // namespace mpm
}  // namespace polder
