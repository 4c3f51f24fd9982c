// Writes the programs that plans build, on GPUs and on CPUs, for offline.py: FOLDER/N.cl, and on standard output a line
// for each: its number, the type of device, the plan that it is of and its build options, separated by tabs.
#include <cstdio>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "dermis/dermis.hpp"
#include "opencl/device.hpp"
#include "opencl/program.hpp"

namespace {

using dermis::Device;
using dermis::FrameDescription;
using dermis::Lighting;
using dermis::Material;
using dermis::Method;
using dermis::Options;
using dermis::Profile;

/// Something that builds programs on a device.
struct Case {
  std::string name;
  std::function<void(const Device&)> build;
};

const FrameDescription only_depth{.depth = true};
const FrameDescription all_images{
    .depth = true, .material = true, .mask = true, .albedo = true, .matte = true, .normal = true, .views = true};

std::vector<Material> materials(std::size_t count, const Profile& profile) {
  std::vector<Material> result(count, Material{.profile = profile});
  for (std::size_t i = 0; i < count; ++i) result[i].id = static_cast<int>(i) + 1;
  return result;
}

Case plan(const std::string& name, const std::vector<Material>& its_materials, const FrameDescription& frames,
          const Options& options) {
  return {name, [=](const Device& device) { dermis::Plan(device, its_materials, frames, options); }};
}

std::vector<Case> all_cases() {
  const Profile skin = dermis::preset("skin").profile;
  const Profile walk = Profile::random_walk_cycles({20, 12, 8}, {0.8, 0.6, 0.4});
  const std::vector<Material> one = materials(1, skin);
  const auto taps_of_rank = [](int rank) { return Options{.taps = {.rank = rank, .count = 17}}; };
  std::vector<Case> cases;
  for (const int rank : {1, 2, 3}) {
    const Options options = taps_of_rank(rank);
    const std::string of_rank = ", rank " + std::to_string(rank);
    cases.push_back(plan("separable, light only" + of_rank, one, {}, options));
    cases.push_back(plan("separable, depth" + of_rank, one, only_depth, options));
    cases.push_back(plan("separable, depth and 3 materials" + of_rank, materials(3, skin),
                         {.depth = true, .material = true}, options));
  }
  Options lit = taps_of_rank(2);
  lit.lighting = Lighting::lit;
  lit.albedo_mix = 0.5;
  cases.push_back(plan("separable, all images", materials(2, walk), all_images, lit));
  Options turned = taps_of_rank(2);
  turned.jitter = 0.5;
  cases.push_back(plan("separable, jitter", one, only_depth, turned));
  for (const Method method : {Method::exact, Method::disc}) {
    const std::string name{dermis::name_of(method)};
    cases.push_back(plan(name + ", depth", one, only_depth, {.method = method}));
    Options with_all = lit;
    with_all.method = method;
    with_all.disc.prefiltered = true;
    cases.push_back(plan(name + ", all images", materials(2, skin), all_images, with_all));
  }
  for (const auto texture_method : {dermis::TextureMethod::gaussians, dermis::TextureMethod::recursive}) {
    for (const bool has_all : {false, true}) {
      const std::string name = "texture, " + std::string(dermis::name_of(texture_method));
      cases.push_back({name + (has_all ? ", all images" : ""), [=](const Device& device) {
                         dermis::TexturePlan(device, skin, {.albedo = has_all, .mask = has_all, .stretch = has_all},
                                             {.method = texture_method});
                       }});
    }
  }
  cases.push_back({"translucency", [=](const Device& device) {
                     dermis::Translucency(device, materials(2, skin),
                                          {.albedo = true, .material = true, .mask = true, .thickness = true});
                   }});
  cases.push_back({"shading", [](const Device& device) { dermis::Shading(device, dermis::ShadingOptions{}); }});
  return cases;
}

/// The text of a program and its build options, from its key in the cache of a device.
std::pair<std::string, std::string> text_of(const std::string& key) {
  std::istringstream words(key);
  std::vector<std::string> files;
  std::string options;
  for (std::string word; words >> word;) {
    if (word.ends_with(".cl")) {
      files.push_back(word);
    } else {
      options += (options.empty() ? "" : " ") + word;
    }
  }
  return {dermis::assemble_source(files), options};
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: kernel_programs FOLDER\n");
    return 2;
  }
  const std::string folder = argv[1];
  int number = 0;
  for (const auto& [type, vector_width] : {std::pair{"GPU", 1}, {"CPU", 16}}) {
    std::set<std::string> seen;
    for (const Case& its : all_cases()) {
      const Device device = dermis::with_kernel_shape(Device::open(), vector_width, type);
      its.build(device);
      for (const std::string& key : dermis::cache_of(device).programs.keys()) {
        if (!seen.insert(key).second) continue;
        const auto [source, options] = text_of(key);
        std::ofstream(folder + "/" + std::to_string(number) + ".cl") << source;
        std::printf("%d\t%s\t%s\t%s\n", number++, type, its.name.c_str(), options.c_str());
      }
    }
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
