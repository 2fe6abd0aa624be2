// Elastic bodies in motion: a free spinning disk, a vibrating bar, a manufactured large deformation.
#pragma once

#include <string>

#include "tests/verify/mpm_scene.hpp"

namespace polder::verify {

// How a step is made.
struct Scheme {
  const char* name;
  ShapeKind shape = ShapeKind::gimp;
  bool musl = true;
  double flip = 1;
  AffineKind affine = AffineKind::none;

  SkeletonOptions options() const {
    SkeletonOptions o;
    o.shape = shape, o.musl = musl, o.flip = flip, o.affine = affine, o.cell_average = false;
    return o;
  }
};

// Free rotation of an elastic disk by 360 degrees, started with the velocities of a rigid spin.
struct SpinResult {
  double energy = 0;   // change of kinetic plus elastic energy, relative
  double angular = 0;  // change of angular momentum of the points, relative
  double shape = 0;    // RMS distance to the best rotated start, as a share of the radius
  double area = 0;     // mean stretch of that fit minus one
  double angle = 0;    // turned by, minus 360 [degrees]
  long steps = 0;
};
SpinResult spin_disk(const Scheme& scheme, int cells_in_radius, double courant);

// A free block of nearly incompressible solid (nu = 0.49), its points off the places where cells would be
// filled evenly, starts with a wave: largest energy ever reached over the energy at the start.
double energy_growth(const Scheme& scheme, bool cell_average, double offset, int steps);

// Errors of a motion with a known solution: RMS of the displacement over all points, largest over all steps,
// relative to the largest exact displacement; and the share of its energy that the motion lost.
struct MotionError {
  double displacement = 0;
  double energy = 0;
  long steps = 0;
  double seconds = 0;  // processor time of the steps, of manufactured() only [s]
};

// Bar fixed at x = 0, free at x = L, released with v = v0 sin(pi x / 2L): u = v0/w sin(wt) sin(pi x/2L), one
// period. The linear problem of reference/vibrating_bar.csv at an amplitude where it is linear.
MotionError vibrate_bar(const Scheme& scheme, int cells, double courant);

// Unit square of neo-Hookean solid, u = A sin(2 pi X) sin(wt), v = A sin(2 pi Y) sin(wt + pi), by body forces
// (Wallstedt & Guilkey 2008; Kamojjala et al. 2015), one period; A, E, nu of reference/mms_axis_aligned.csv.
MotionError manufactured(const Scheme& scheme, int cells, double courant, double amplitude = 0.05,
                         int per_axis = 2);

// The exact solution of manufactured() along one axis: displacement, velocity and body force at reference
// position X (and Y across, for the other axis' stretch).
struct Manufactured {
  double lame, shear, density, speed, amplitude, phase;
  double displacement(double x, double t) const;
  double velocity(double x, double t) const;
  double body_force(double x, double t, double stretch_across) const;
  double stretch(double x, double t) const;
};
Manufactured manufactured_axis(int axis, double amplitude);

}  // namespace polder::verify
