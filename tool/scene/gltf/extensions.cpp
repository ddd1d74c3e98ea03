// The table of glTF's extensions.
#include "extensions.h"

#include <algorithm>

#include <fmt/format.h>

#include "../message.h"

namespace vitrail::tool {
namespace {

using enum GltfSupport;

// One line each. Who implements an extension makes it Drawn, or Partly with what is still lost.
// clang-format off
constexpr GltfExtension kExtensions[] = {
    // The scene.
    {"EXT_mesh_gpu_instancing", Drawn, ""},
    {"KHR_animation_pointer", Left, "what an animation pointer moves, nodes too, stands still"},
    {"KHR_lights_punctual", Drawn, ""},
    {"KHR_materials_variants", Drawn, ""},
    {"KHR_node_visibility", Drawn, ""},
    {"EXT_lights_image_based", Left, "the file's surroundings do not light it"},
    {"EXT_lights_ies", Left, "lights shine the same in all directions"},
    {"MSFT_lod", Left, "only the most detailed level is drawn"},
    {"KHR_gaussian_splatting", Left, "splats are drawn as points"},
    {"KHR_gaussian_splatting_compression_spz_2", Unreadable, "the splats cannot be read"},

    // Meshes.
    {"KHR_mesh_quantization", Drawn, ""},
    {"KHR_draco_mesh_compression", Drawn, ""},
    {"EXT_meshopt_compression", Drawn, ""},
    {"KHR_meshopt_compression", Named, "data of its version 1 and its colour filter are refused"},
    {"EXT_mesh_manifold", Nothing, ""},
    {"KHR_mesh_primitive_restart", Left, "indices that restart a strip are not understood"},
    {"CESIUM_primitive_outline", Left, "outlines of faces are not drawn"},
    {"EXT_mesh_polygon", Nothing, ""},

    // Textures.
    {"KHR_texture_transform", Drawn, ""},
    {"KHR_texture_basisu", Named, "textures of Basis Universal (ETC1S, UASTC) are missing where the file has no others"},
    {"EXT_texture_webp", Drawn, ""},
    {"EXT_texture_avif", Named, "AVIF textures are missing where the file has no others"},
    {"MSFT_texture_dds", Named, "DDS textures are missing where the file has no others"},
    {"EXT_texture_video", Left, "videos are missing"},

    // Materials.
    {"KHR_materials_emissive_strength", Drawn, ""},
    {"KHR_materials_transmission", Drawn, ""},
    {"KHR_materials_unlit", Drawn, ""},
    {"KHR_materials_pbrSpecularGlossiness", Drawn, ""},
    {"KHR_materials_volume", Drawn, ""},
    {"KHR_materials_volume_scatter", Left, "light is not scattered inside objects"},
    {"KHR_materials_ior", Drawn, ""},
    {"KHR_materials_specular", Drawn, ""},
    {"KHR_materials_clearcoat", Drawn, ""},
    {"KHR_materials_sheen", Drawn, ""},
    {"KHR_materials_anisotropy", Drawn, ""},
    {"KHR_materials_iridescence", Drawn, ""},
    {"KHR_materials_diffuse_transmission", Drawn, ""},
    {"KHR_materials_dispersion", Left, "glass does not split light into colours"},
    {"KHR_materials_subsurface", Left, "light is not scattered inside objects"},
    {"ADOBE_materials_clearcoat_specular", Left, "coats have the strength of plain varnish"},
    {"ADOBE_materials_clearcoat_tint", Left, "coats have no colour"},
    {"ADOBE_materials_thin_transparency", Left, "thin glass is drawn as its material without the extension"},
    {"EXT_materials_bump", Left, "bumps are missing"},
    {"MSFT_packing_normalRoughnessMetallic", Nothing, ""},
    {"MSFT_packing_occlusionRoughnessMetallic", Nothing, ""},
    {"FB_geometry_metadata", Nothing, ""},
    {"BENTLEY_materials_line_style", Left, "lines are plain"},
    {"BENTLEY_materials_point_style", Left, "points have the size of all others"},
    {"BENTLEY_materials_planar_fill", Left, "fills of planes are plain"},
    {"MPEG_media", Left, "videos are missing"},
    {"VRM", Left, "an avatar's toon materials, expressions and springs are not drawn"},
    {"VRMC_materials_mtoon", Left, "toon materials are shaded as plain ones"},
    {"VRMC_vrm", Left, "an avatar's expressions are not drawn"},
    {"VRMC_springBone", Left, "hair and cloth hang as they are in the file"},
    {"VRMC_node_constraint", Left, "constrained nodes stay where they are in the file"},
    {"AGI_articulations", Left, "articulated parts are in their rest position"},
    {"AGI_stk_metadata", Nothing, ""},

    // What surrounds a model and what it means.
    {"CESIUM_RTC", Nothing, ""},
    {"CESIUM_tile_edges", Left, "edges are not drawn"},
    {"EXT_feature_metadata", Nothing, ""},
    {"EXT_instance_features", Nothing, ""},
    {"EXT_mesh_features", Nothing, ""},
    {"EXT_structural_metadata", Nothing, ""},
    {"EXT_meshopt_simplify", Nothing, ""},
    {"EXT_accessor_additional_types", Nothing, ""},
    {"KHR_accessor_float64", Unreadable, "numbers in double precision cannot be read"},
    {"KHR_audio_emitter", Nothing, ""},
    {"KHR_audio", Nothing, ""},
    {"KHR_interactivity", Nothing, ""},
    {"KHR_node_hoverability", Nothing, ""},
    {"KHR_node_selectability", Nothing, ""},
    {"KHR_physics_rigid_bodies", Nothing, ""},
    {"KHR_implicit_shapes", Nothing, ""},
    {"KHR_xmp", Nothing, ""},
    {"KHR_xmp_json_ld", Nothing, ""},
    {"MSFT_physics", Nothing, ""},
    {"MSFT_audio_emitter", Nothing, ""},
    {"MSFT_lightmap", Left, "baked light is missing"},
    {"EXT_lightmap", Left, "baked light is missing"},
    {"MOZ_lightmap", Left, "baked light is missing"},
    {"MOZ_hubs_components", Nothing, ""},
    {"OMI_collider", Nothing, ""},
    {"OMI_physics_body", Nothing, ""},
    {"OMI_physics_shape", Nothing, ""},
    {"GODOT_single_root", Nothing, ""},
    {"KHR_techniques_webgl", Left, "the file's own shaders are not run: its materials are plain"},
    {"KHR_blend", Left, "blending is the usual one"},
    {"KHR_materials_common", Left, "materials are plain"},
};
// clang-format on

} // namespace

std::span<const GltfExtension> gltfExtensions() { return kExtensions; }

GltfExtension gltfExtension(std::string_view name) {
  const auto row = std::ranges::find(kExtensions, name, &GltfExtension::name);
  if (row != std::ranges::end(kExtensions)) return *row;
  return {name, Left, "what it adds to the picture is missing", false};
}

std::string extensionWarning(std::string_view name) {
  const GltfExtension extension = gltfExtension(name);
  switch (extension.support) {
    case Drawn:
    case Nothing:
    case Named:
      return {};
    case Partly:
      return fmt::format("the extension {} is drawn in part: {}", oneLine(name), extension.lost);
    case Left:
    case Unreadable:
      break;
  }
  return fmt::format("the extension {} is not drawn: {}", oneLine(name), extension.lost);
}

} // namespace vitrail::tool
