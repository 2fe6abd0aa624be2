// The constitutive law of a material at the vector level of the including source file.
#pragma once

#include <memory>

#include "mpm/material/law.hpp"
#include "mpm/material/parameters.hpp"

namespace polder::POLDER_SIMD_NAMESPACE {

// plastic = false: the same material with its plasticity switched off (a stage that builds up initial
// stress). The state variables stay where they are; see mpm::state_layout(). Throws InputError for parameters
// that check_parameters() refuses.
template <int D>
std::unique_ptr<Law<D>> make_law(const mpm::MaterialParameters& material, bool plastic = true);

extern template std::unique_ptr<Law<2>> make_law<2>(const mpm::MaterialParameters&, bool);
extern template std::unique_ptr<Law<3>> make_law<3>(const mpm::MaterialParameters&, bool);

}  // namespace polder::POLDER_SIMD_NAMESPACE
