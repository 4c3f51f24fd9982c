// Random walks through a slab.
#pragma once

namespace dermis {

/// The shares of the light which falls on one side of a slab that leave it.
struct SlabLight {
  double transmitted;  ///< on the other side
  double returned;     ///< on the same one
};

/// A slab of a medium that scatters alike in all directions. Light enters as a Lambertian surface lets it in, and no
/// surface reflects. `thickness` in mean free paths, 1e-3..100; `scattering_albedo` in 0..1: what a scattering leaves.
/// Off by 1e-3 at most up to ten mean free paths, by 5e-3 up to thirty, and by 2e-2 at a hundred.
SlabLight slab_light(double thickness, double scattering_albedo);

/// The light that a slab without an end returns.
double half_space_light(double scattering_albedo);

}  // namespace dermis
