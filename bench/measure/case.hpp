// A case: one way of filtering one scene.
#pragma once

#include <array>
#include <string>

#include "dermis/plan.hpp"
#include "dermis/taps.hpp"
#include "dermis/words.hpp"
#include "measure/scene.hpp"

namespace dermis::bench {

/// Who filters.
enum class Family {
  dermis,             ///< the separable method
  dermis_exact,       ///< the surface integral by brute force
  dermis_disc,        ///< samples of the surface integral on discs
  texture_gaussians,  ///< dermis in texture space, by a chain of six Gaussians; the scene is the texture
  texture_recursive,  ///< dermis in texture space, by recursion
  naive,              ///< an OpenCL kernel, one work-item per pixel and pass
  rule_2012,          ///< the rules of the 2012 shader, in such a kernel
  simd,               ///< C++ with vectors, constant offsets, no depth
  simd_depth,         ///< C++ with vectors, and weights that fall with the difference of depth
  opencv_separable,   ///< sepFilter2D with a dense kernel per channel
  opencv_bilateral,   ///< bilateralFilter, 15 x 15
  fft,                ///< the exact convolution by FFTW in float
  start_up,           ///< the first plan of a process
};

/// The layout of a caller's images in memory.
enum class Memory { planar_f32, interleaved_f16 };

/// The part of the table that a case stands in.
enum class Group { methods, coverage, width, pixels, threads, flat, texture, start_up, picture };

}  // namespace dermis::bench

namespace dermis {

template <>
inline constexpr std::array<Named<bench::Family>, 13> word_table<bench::Family> = {
    {{bench::Family::dermis, "dermis"},
     {bench::Family::dermis_exact, "dermis-exact"},
     {bench::Family::dermis_disc, "dermis-disc"},
     {bench::Family::texture_gaussians, "texture-gaussians"},
     {bench::Family::texture_recursive, "texture-recursive"},
     {bench::Family::naive, "naive"},
     {bench::Family::rule_2012, "rule-2012"},
     {bench::Family::simd, "simd"},
     {bench::Family::simd_depth, "simd-depth"},
     {bench::Family::opencv_separable, "opencv-separable"},
     {bench::Family::opencv_bilateral, "opencv-bilateral"},
     {bench::Family::fft, "fft"},
     {bench::Family::start_up, "start-up"}}};

template <>
inline constexpr std::array<Named<bench::Group>, 9> word_table<bench::Group> = {
    {{bench::Group::methods, "methods"},
     {bench::Group::coverage, "coverage"},
     {bench::Group::width, "kernel width"},
     {bench::Group::pixels, "pixels"},
     {bench::Group::threads, "threads and memory"},
     {bench::Group::flat, "flat, against exact convolution"},
     {bench::Group::texture, "texture space, against exact convolution"},
     {bench::Group::start_up, "start-up"},
     {bench::Group::picture, "picture"}}};

}  // namespace dermis

namespace dermis::bench {

struct Case {
  Family family = Family::dermis;
  Group group = Group::methods;
  SceneSpec scene = {};
  TapsDesign design = {.rank = 2};  ///< of dermis; opponents have only its `count`
  double tolerance = 0;             ///< > 0: in place of the design, the cheapest that is predicted to be as good
  DiscOptions disc = {};            ///< of dermis_disc
  bool sheared = true;              ///< of dermis, as Options::sheared
  double jitter = 0;                ///< of dermis, as Options::jitter
  int threads = 0;                  ///< of dermis; 0: as many as the program was told
  Memory memory = Memory::planar_f32;
  bool cache_is_filled = false;  ///< of a start-up: kernels were compiled by an earlier process

  bool is_on_picture() const { return scene.geometry == Geometry::picture; }
  std::string model() const;   ///< empty where there is none
  std::string method() const;  ///< the name up to the scene
  /// "dermis/optimised/r2/t17/spheres/1920x1080/w16/c100"; on a picture "optimised, rank 2, 17 taps".
  std::string name() const;
};

}  // namespace dermis::bench
