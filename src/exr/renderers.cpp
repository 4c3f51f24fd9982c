// The names that renderers give their passes. What is new is a row here, not code.
#include <algorithm>
#include <string>
#include <vector>

#include "dermis/exr.hpp"
#include "exr/any_renderer.hpp"

namespace dermis::exr {
namespace {

const std::vector<Renderer::OtherLight> redshift_others = {{{{"SubSurfaceScatter", "rsAov_SubSurfaceScatter"},
                                                             {"Refractions", "rsAov_Refractions"},
                                                             {"Emission", "rsAov_Emission"},
                                                             {"Caustics", "rsAov_Caustics"}}}};

const std::vector<Renderer::OtherLight> vray_others = {{{{"VRayReflection", "reflection", "reflect"},
                                                         {"VRayRefraction", "refraction", "refract"},
                                                         {"VRaySSS2", "VRaySSS", "SSS"},
                                                         {"VRaySelfIllumination", "selfIllumination", "selfIllum"},
                                                         {"VRayCaustics", "caustics"},
                                                         {"VRayAtmosphere", "atmosphere"},
                                                         {"VRayBackground", "background"}}}};

const std::vector<Renderer> table = {
    {.name = "blender",
     .lighting = Lighting::raw,
     .passes = {{Role::light, {"DiffDir", "Diffuse Direct"}},
                {Role::light, {"DiffInd", "Diffuse Indirect"}},
                {Role::albedo, {"DiffCol", "Diffuse Color"}},
                {Role::material, {"IndexMA", "Material Index"}},
                {Role::specular, {"GlossDir", "Glossy Direct"}},
                {Role::specular, {"GlossInd", "Glossy Indirect"}},
                {Role::beauty, {"Combined", "Image", ""}}},
     .specular_colour = {"GlossCol", "Glossy Color"},
     .others = {{{{"TransDir", "Transmission Direct"}, {"TransInd", "Transmission Indirect"}},
                 {"TransCol", "Transmission Color"}},
                {{{"SubsurfaceDir"}, {"SubsurfaceInd"}}, {"SubsurfaceCol"}},
                {{{"VolumeDir", "Volume Direct"},
                  {"VolumeInd", "Volume Indirect"},
                  {"Emit", "Emission"},
                  {"Env", "Environment"}}}}},
    {.name = "arnold",
     .lighting = Lighting::lit,
     .passes = {{Role::light, {"diffuse_direct"}},
                {Role::light, {"diffuse_indirect"}},
                {Role::albedo, {"diffuse_albedo"}},
                {Role::specular, {"specular_direct", "specular"}},
                {Role::specular, {"specular_indirect"}}},
     .others = {{{{"coat_direct", "coat"},
                  {"coat_indirect"},
                  {"sheen_direct", "sheen"},
                  {"sheen_indirect"},
                  {"transmission_direct", "transmission"},
                  {"transmission_indirect"},
                  {"sss_direct", "sss"},
                  {"sss_indirect"},
                  {"volume_direct", "volume"},
                  {"volume_indirect"},
                  {"emission"},
                  {"background"}}}}},
    {.name = "karma",
     .lighting = Lighting::lit,
     .passes = {{Role::light, {"diffuse_direct", "directdiffuse"}},
                {Role::light, {"diffuse_indirect", "indirectdiffuse"}},
                {Role::albedo, {"albedo"}},
                {Role::specular, {"combinedglossyreflection", "glossyreflection", "specular_direct", "specular"}},
                {Role::specular, {"indirectglossyreflection", "specular_indirect"}},
                {Role::beauty, {"C", "Beauty", ""}}},
     .others = {{{{"glossytransmission", "transmission"},
                  {"sss"},
                  {"combinedemission", "emission_direct", "emission"},
                  {"emission_indirect", "indirectemission"},
                  {"combinedvolume", "volume_direct", "volume"},
                  {"volume_indirect", "indirectvolume"},
                  {"visiblelights", "lightsources"}}}}},
    {.name = "redshift",
     .lighting = Lighting::raw,
     .passes = {{Role::light, {"DiffuseLightingRaw", "rsAov_DiffuseLightingRaw", "RS_DiffuseLightingRaw"}},
                {Role::light,
                 {"GlobalIlluminationRaw", "GIRaw", "rsAov_GlobalIlluminationRaw", "rsAov_GIRaw",
                  "RS_GlobalIlluminationRaw"}},
                {Role::albedo, {"DiffuseFilter", "rsAov_DiffuseFilter", "RS_DiffuseFilter"}},
                {Role::material, {"MaterialID", "ObjectID", "rsAov_ObjectID"}},
                {Role::specular, {"SpecularLighting", "rsAov_SpecularLighting"}},
                {Role::specular, {"Reflections", "rsAov_Reflections"}}},
     .others = redshift_others},
    {.name = "redshift-total",
     .lighting = Lighting::raw,
     .passes = {{Role::light, {"TotalDiffuseLightingRaw", "rsAov_TotalDiffuseLightingRaw"}},
                {Role::albedo, {"DiffuseFilter", "rsAov_DiffuseFilter"}},
                {Role::material, {"MaterialID", "ObjectID", "rsAov_ObjectID"}},
                {Role::specular, {"SpecularLighting", "rsAov_SpecularLighting"}},
                {Role::specular, {"Reflections", "rsAov_Reflections"}}},
     .others = redshift_others},
    {.name = "vray",
     .lighting = Lighting::raw,
     .passes = {{Role::light, {"VRayRawLighting", "rawLight", "rawLighting"}},
                {Role::light, {"VRayRawGlobalIllumination", "rawGI", "rawGlobalIllumination"}},
                {Role::albedo, {"VRayDiffuseFilter", "VRayRawDiffuseFilter", "diffuse", "diffuseFilter"}},
                {Role::depth, {"VRayZDepth", "zDepth"}},
                {Role::normal, {"VRayNormals", "normals", "VRayBumpNormals"}},
                {Role::material, {"VRayMtlID", "mtlID", "materialID"}},
                {Role::specular, {"VRaySpecular", "specular"}}},
     .others = vray_others},
    {.name = "vray-total",
     .lighting = Lighting::raw,
     .passes = {{Role::light, {"VRayRawTotalLighting", "rawTotalLight"}},
                {Role::albedo, {"VRayDiffuseFilter", "VRayRawDiffuseFilter", "diffuse", "diffuseFilter"}},
                {Role::depth, {"VRayZDepth", "zDepth"}},
                {Role::normal, {"VRayNormals", "normals"}},
                {Role::material, {"VRayMtlID", "mtlID", "materialID"}},
                {Role::specular, {"VRaySpecular", "specular"}}},
     .others = vray_others},
    {.name = "renderman",
     .lighting = Lighting::lit,
     .passes = {{Role::light, {"diffuse", "directDiffuse"}},
                {Role::light, {"indirectdiffuse"}},
                {Role::albedo, {"albedo"}},
                {Role::depth, {"z"}},
                {Role::normal, {"Nn", "normal"}},
                {Role::material, {"id"}},
                {Role::specular, {"specular", "directSpecular"}},
                {Role::specular, {"indirectspecular"}},
                {Role::beauty, {"Ci", ""}}},
     .others = {{{{"subsurface"}, {"transmissive"}, {"emissive"}}}}},
    {.name = "unreal",
     .lighting = Lighting::raw,
     .passes = {{Role::light, {"FinalImageMovieRenderQueue_DiffuseLighting", "DiffuseLighting"}},
                {Role::albedo, {"FinalImageMovieRenderQueue_BaseColor", "BaseColor"}},
                {Role::depth, {"FinalImageMovieRenderQueue_WorldDepth", "WorldDepth"}},
                {Role::position, {"FinalImageMovieRenderQueue_WorldPosition", "WorldPosition"}},
                {Role::normal, {"FinalImageMovieRenderQueue_WorldNormal", "WorldNormal"}},
                {Role::beauty, {"FinalImage", ""}}}},
    {.name = "mitsuba",
     .lighting = Lighting::lit,
     .passes = {{Role::light, {"path", "volpath", "direct", "ptracer", ""}},
                {Role::albedo, {"albedo"}},
                {Role::depth, {"dd", "depth"}},
                {Role::position, {"pos", "position"}},
                {Role::normal, {"nn", "sh_normal"}},
                {Role::material, {"mat", "shape_index"}},
                {Role::beauty, {"path", "volpath", "direct", "ptracer", ""}}},
     .marks = {"dd.T", "pos.X", "nn.X", "mat.I"}},
    {.name = "pbrt",
     .lighting = Lighting::lit,
     .passes = {{Role::light, {""}}, {Role::albedo, {"Albedo"}}, {Role::beauty, {""}}},
     .marks = {"dzdx"}},
};

}  // namespace

const Renderer any_renderer = {
    .name = "any renderer",
    .lighting = Lighting::raw,
    .passes = {{Role::depth, {"Depth", "Z", "depth_z"}},
               {Role::position, {"Position", "P", "WorldPosition", "pworld", "worldPos"}},
               {Role::normal, {"Normal", "Normals", "N", "WorldNormal"}},
               {Role::mask, {"Mask"}},
               {Role::beauty, {"Combined", "Image", "beauty", "rgba", "rgb", "Ci", "C", ""}},
               {Role::thickness, {"Thickness"}}},
};

std::span<const Renderer> renderers() { return table; }

const Renderer* find_renderer(std::string_view name) {
  const auto it = std::find_if(table.begin(), table.end(), [&](const Renderer& row) { return row.name == name; });
  return it == table.end() ? nullptr : &*it;
}

std::string renderer_names() {
  std::string out;
  for (const Renderer& renderer : table) out += (out.empty() ? "" : ", ") + renderer.name;
  return out;
}

}  // namespace dermis::exr
