// Files that are wrong end as one clear line, whatever is wrong with them.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/load.h"
#include "scene/message.h"

namespace vitrail::tool {
namespace {

namespace fs = std::filesystem;

fs::path corpus() { return VITRAIL_TEST_CORPUS; }

// The message of the failure; empty where the file loads.
std::string failureOf(const fs::path& path) {
  try {
    loadModel(path);
    return {};
  } catch (const LoadError& error) {
    return error.what();
  }
}

// What each file of the corpus is refused with, or the part of it that is ours.
const std::map<std::string, std::string>& expectedMessages() {
  static const std::map<std::string, std::string> messages{
      {"accessor_bufferview_range.gltf", "accessor 0: bufferView is 1, but bufferViews has 1 element"},
      {"accessor_component_type.gltf", "accessor 0: componentType is 5130, not a component type"},
      {"accessor_count_2_32.gltf",
       "accessor 0: 4294967296 elements of 12 bytes at offset 0, 12 bytes apart, reach past the end of buffer view 0, "
       "which has 36 bytes"},
      {"accessor_count_fraction.gltf", "accessor 0: count is 2.5, not a whole number"},
      {"accessor_count_negative.gltf", "accessor 0: count is -3, below zero"},
      {"accessor_count_string.gltf", "accessor 0: count is not a number"},
      {"accessor_count_too_many.gltf",
       "accessor 0: 4 elements of 12 bytes at offset 0, 12 bytes apart, reach past the end of buffer view 0, which has "
       "36 bytes"},
      {"accessor_offset_2_53.gltf",
       "accessor 0: 3 elements of 12 bytes at offset 9007199254740992, 12 bytes apart, reach past the end of buffer "
       "view 0, which has 36 bytes"},
      {"accessor_offset_2_64.gltf", "accessor 0: byteOffset is 18446744073709551612, more than 9007199254740992"},
      {"accessor_type.gltf", "accessor 0: type is \"VEC5\", not an accessor type"},
      {"attribute_counts.gltf", "mesh 0 primitive 0: has 3 positions, but 2 of NORMAL"},
      {"bin_first.glb", "the first GLB chunk is not JSON"},
      {"bin_length.glb", "GLB chunk 1 states 2147483644 bytes, but only 36 are left"},
      {"bin_short.glb", "buffer 0: byteLength is 360, but it has 36 bytes"},
      {"buffer_absolute_file.gltf", "buffer 0: /dev/zero: is not relative to the model"},
      {"buffer_garbage_uri.gltf", "buffer 0: its data URI holds a character that is not base64"},
      {"buffer_longer_than_data.gltf", "buffer 0: byteLength is 37, but it has 36 bytes"},
      {"buffer_missing_file.gltf", "buffer 0: not-there.bin: no such file"},
      {"buffer_remote.gltf", "buffer 0: https://example.org/data.bin is not a local file"},
      {"bufferview_buffer_range.gltf", "buffer view 0: buffer is 9, but buffers has 1 element"},
      {"bufferview_length_2_32.gltf",
       "buffer view 0: 4294967332 bytes at offset 0 reach past the end of buffer 0, which has 36"},
      {"bufferview_offset_2_53.gltf",
       "buffer view 0: 36 bytes at offset 9007199254740956 reach past the end of buffer 0, which has 36"},
      {"bufferview_stride_odd.gltf", "buffer view 0: byteStride is 13, not a multiple of 4 up to 252"},
      {"bufferview_stride_small.gltf", "accessor 0: its elements have 12 bytes, but the stride of buffer view 0 is 8"},
      {"comma.stl", "line 6: 0,5 is not a number: decimals follow a point, not a comma"},
      {"draco_attribute.gltf", "mesh 0 primitive 0: KHR_draco_mesh_compression: NORMAL: the data have no attribute 9"},
      {"draco_attribute_type.gltf",
       "mesh 0 primitive 0: KHR_draco_mesh_compression: attributes.NORMAL is not a whole number from 0"},
      {"draco_counts.gltf", "mesh 0 primitive 0: KHR_draco_mesh_compression: the data are damaged"},
      {"draco_counts_edgebreaker.gltf", "mesh 0 primitive 0: KHR_draco_mesh_compression: the data are damaged"},
      {"draco_cut_off.gltf", "mesh 0 primitive 0: KHR_draco_mesh_compression: the data are damaged"},
      {"draco_garbage.gltf", "mesh 0 primitive 0: KHR_draco_mesh_compression: the data are not Draco's"},
      {"draco_point_cloud.gltf", "mesh 0 primitive 0: KHR_draco_mesh_compression: the data hold no mesh"},
      {"empty.gltf", "is empty"},
      {"extension_required.gltf", "it requires the extension KHR_accessor_float64, which Vitrail does not implement"},
      {"face_before_start.obj", "line 4: a face names vertex -9, but there are 3"},
      {"face_index_negative.ply", "face 0: names vertex -1, but there are 3"},
      {"face_index_range.ply", "face 0: names vertex 3, but there are 3"},
      {"face_list_length.ply", "the file ends in face 1 of 1"},
      {"face_word.obj", "line 5: \"x\" is not the number of a texture coordinate"},
      {"face_range.obj", "line 4: a face names vertex 4, but there are 3"},
      {"facet_count.stl", "the STL header states 4294967295 facets, but the file has room for 1"},
      {"facet_in_loop.stl", "line 6: a facet begins inside a loop"},
      {"four_corners.stl", "line 7: a loop has more than 3 vertices"},
      {"header_only.glb", "the GLB file ends after 12 bytes, in its header"},
      {"header_short.stl", "the file ends after 60 bytes, in the STL header"},
      {"header_unfinished.ply", "the PLY header does not end"},
      {"index_floats.gltf", "accessor 1: is used as indices, but does not hold unsigned integers"},
      {"index_range.gltf", "mesh 0 primitive 0: index 2 is 3, but there are 3 vertices"},
      {"index_restart.gltf", "mesh 0 primitive 0: index 2 is 65535, but there are 3 vertices"},
      {"index_vectors.gltf", "accessor 1: is used as indices, but does not hold unsigned integers"},
      {"joint_matrices.gltf", "skin 0: has 2 joints, but 1 inverse bind matrices"},
      {"joint_range.gltf", "mesh 0 primitive 0: vertex 0 follows joint 2, but the skin has 2 joints"},
      {"json_1e999.gltf", "the JSON is not valid: "},
      {"json_control_bytes.gltf", "the JSON is not valid: "},
      {"json_array.gltf", "the JSON is not an object, so it is not glTF"},
      {"json_length.glb", "GLB chunk 0 states 4294967280 bytes, but only 388 are left"},
      {"json_nan.gltf", "the JSON is not valid: "},
      {"json_nested.gltf", "the JSON is nested more than 100 levels deep"},
      {"json_truncated.gltf", "the JSON is not valid: "},
      {"material_factor_range.gltf",
       "material 0: pbrMetallicRoughness.metallicFactor is 1e+39, which a 32-bit float cannot hold"},
      {"material_factor_type.gltf", "material 0: pbrMetallicRoughness.baseColorFactor has 3 numbers where 4 belong"},
      {"material_range.gltf", "mesh 0: primitives[0].material is 0, but materials has 0 elements"},
      {"material_texture_range.gltf",
       "material 0: pbrMetallicRoughness.baseColorTexture.index is 1, but textures has 1 element"},
      {"material_extension_factor_type.gltf",
       "material 0: extensions.KHR_materials_clearcoat.clearcoatFactor is not a number"},
      {"material_extension_texture_range.gltf",
       "material 0: extensions.KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture.index is 1, but textures "
       "has 1 element"},
      {"material_volume_color.gltf",
       "material 0: extensions.KHR_materials_volume.attenuationColor has 2 numbers where 3 belong"},
      {"material_transmission_range.gltf",
       "material 0: extensions.KHR_materials_transmission.transmissionTexture.index is 1, but textures has 1 element"},
      {"meshopt_count.gltf",
       "buffer view 0: EXT_meshopt_compression: 2147483647 elements of 12 bytes are stated, but 74 bytes cannot hold "
       "more than 5856"},
      {"meshopt_count_triangles.gltf",
       "buffer view 1: EXT_meshopt_compression: 30000 elements of 2 bytes are stated, but 19 bytes cannot hold more "
       "than 57"},
      {"meshopt_damaged.gltf", "buffer view 0: EXT_meshopt_compression: the stream is damaged"},
      {"meshopt_fallback_alone.gltf",
       "buffer view 0: 36 bytes at offset 0 reach past the end of buffer 1, which has 0"},
      {"meshopt_filter.gltf",
       "buffer view 0: EXT_meshopt_compression: filter is \"COLOR\", none of NONE, OCTAHEDRAL, QUATERNION and "
       "EXPONENTIAL"},
      {"meshopt_filter_indices.gltf",
       "buffer view 1: EXT_meshopt_compression: has a filter, which indices do not have"},
      {"meshopt_mode.gltf",
       "buffer view 0: EXT_meshopt_compression: mode is \"POINTS\", none of ATTRIBUTES, TRIANGLES and INDICES"},
      {"meshopt_not_whole.gltf", "buffer view 1: EXT_meshopt_compression: count is 5, not a multiple of 3"},
      {"meshopt_quaternion.gltf", "buffer view 0: EXT_meshopt_compression: byteStride is 12, but QUATERNION has 8"},
      {"meshopt_range.gltf",
       "buffer view 0: EXT_meshopt_compression: 74 bytes at offset 10000 reach past the end of buffer 0, which has"},
      {"meshopt_stride.gltf",
       "buffer view 0: EXT_meshopt_compression: byteStride is 10, but attributes have a multiple of 4 bytes up to 256"},
      {"meshopt_stride_indices.gltf",
       "buffer view 1: EXT_meshopt_compression: byteStride is 3, but indices have 2 or 4 bytes"},
      {"meshopt_version.gltf",
       "buffer view 0: EXT_meshopt_compression: the stream is of version 1; meshoptimizer 0.18 reads version 0 only"},
      {"mesh_mode.gltf", "mesh 0 primitive 0: mode is 7, which is none"},
      {"no_asset.gltf", "the JSON has no asset, so it is not glTF"},
      {"no_bin.glb", "buffer 0: has no uri, and the file has no binary chunk for it"},
      {"no_facets.stl", "the file holds no triangles"},
      {"no_format.ply", "the PLY header states no format"},
      {"node_child_range.gltf", "node 0: children[0] is 5, but nodes has 1 element"},
      {"node_cycle.gltf", "node 1 is its own ancestor"},
      {"node_far_away.gltf", "the model reaches to 1e+30, farther than 1e+15"},
      {"node_matrix_short.gltf", "node 0: matrix has 15 numbers where 16 belong"},
      {"node_mesh_range.gltf", "node 0: mesh is 1, but meshes has 1 element"},
      {"node_copies.gltf", "nodes with several parents make more than 1000000 copies of others"},
      {"node_light_range.gltf", "node 0: extensions.KHR_lights_punctual.light is 2, but lights has 0 elements"},
      {"instancing_range.gltf",
       "node 0: extensions.EXT_mesh_gpu_instancing.attributes.TRANSLATION is 7, but accessors has 1 element"},
      {"instancing_counts.gltf", "node 0: has 3 instances, but 1 values of SCALE"},
      {"animation_accessor_range.gltf", "animation 0: samplers[0].output is 1, but accessors has 1 element"},
      {"light_type.gltf", "extensions.KHR_lights_punctual.lights[0].type is missing"},
      {"extension_unreadable.gltf",
       "it has no mesh that can be read without the extension KHR_gaussian_splatting_compression_spz_2"},
      {"not_glb.glb",
       "begins neither with \"glTF\", as a .glb file does, nor with {, as a .gltf file does: it is damaged or of "
       "another kind"},
      {"not_json.gltf", "begins neither with \"glTF\", as a .glb file does, nor with {"},
      {"not_a_number.stl", "line 6: one is not a number"},
      {"not_finite.stl", "every facet has a corner that is not finite"},
      {"not_ply.ply", "the file does not begin with \"ply\""},
      {"nothing.obj", "the file holds no triangles"},
      {"packed_splats.ply", "its vertices are compressed Gaussian splats (packed_position), which cannot be read"},
      {"position_1e999.obj", "everything in it has a vertex that is not finite"},
      {"position_infinite.gltf", "mesh 0 primitive 0: position 2 of accessor 0 is not finite"},
      {"position_nan.gltf", "mesh 0 primitive 0: position 1 of accessor 0 is not finite"},
      {"position_nan.obj", "everything in it has a vertex that is not finite"},
      {"positions_equal.gltf", "the file holds no triangles"},
      {"scene_range.gltf", "scene is 1, but scenes has 1 element"},
      {"scene_string.gltf", "scene is not a number"},
      {"sparse_component_type.gltf", "accessor 0: sparse.indices have component type 5126, not an unsigned one"},
      {"sparse_count.gltf", "accessor 0: sparse.count is 4, more than the 3 elements that there are"},
      {"sparse_index_range.gltf", "accessor 0: sparse index 0 is 3, but there are 3 elements"},
      {"sparse_values_short.gltf",
       "accessor 0: sparse.values: 2 elements of 12 bytes at offset 0, 12 bytes apart, reach past the end of buffer "
       "view 2, which has 12 bytes"},
      {"truncated.glb", "the GLB file is cut off: it states 408 bytes and has 400"},
      {"truncated.obj", "the file holds no triangles"},
      {"truncated_binary.stl", "the file holds no triangles"},
      {"truncated_text.stl", "line 5: the file ends inside a loop"},
      {"two_corners.stl", "line 6: a loop ends without 3 vertices"},
      {"type_unknown.ply", "line 4: \"real\" is not a PLY type"},
      {"unknown.fbx", "has the unknown extension .fbx; .gltf, .glb, .obj, .ply and .stl can be read"},
      {"version_1.glb", "it is GLB version 1, but only version 2 can be read"},
      {"version_1.gltf", "it is glTF 1.0, but only glTF 2.0 can be read"},
      {"vertex_1e999.ply", "everything in it has a vertex that is not finite"},
      {"vertex_count_2_64.ply", "18446744073709551615 vertices are too many"},
      {"vertex_count_large.ply", "the file ends in vertex 4 of 4000000000"},
      {"vertex_count_negative.ply", "line 3: \"-3\" is not a count of elements"},
      {"vertex_nan.ply", "everything in it has a vertex that is not finite"},
      {"vertex_no_z.ply", "the PLY vertices have no x, y and z"},
      {"vertex_truncated.ply", "the file ends in vertex 3 of 3"},
      {"zero_filled_count.gltf", "accessor 0: counts 2147483648 elements without a buffer view, more than 1000000"},
  };
  return messages;
}

TEST(LoadBadFiles, EachIsRefusedWithOneLineThatSaysWhatIsWrong) {
  std::set<std::string> seen;
  for (const fs::directory_entry& entry : fs::directory_iterator(corpus() / "bad")) {
    const std::string name = entry.path().filename();
    SCOPED_TRACE(name);
    seen.insert(name);
    const std::string message = failureOf(entry.path());
    const auto expected = expectedMessages().find(name);
    ASSERT_NE(expected, expectedMessages().end()) << "the file has no entry in this test; it says: " << message;
    EXPECT_NE(message.find(expected->second), std::string::npos) << "it says: " << message;
    EXPECT_FALSE(message.empty());
    EXPECT_EQ(message, printable(message)) << "bytes that a terminal may take for orders";
    EXPECT_LT(message.size(), 300U);
  }
  EXPECT_EQ(seen.size(), expectedMessages().size()) << "a file of this test is gone";
}

// Whatever a file holds, a terminal is given characters alone.
TEST(Message, PrintableTextIsUtf8WithoutControlCharacters) {
  EXPECT_EQ(printable("a\x1b[31mred\x1b[0m"), "a [31mred [0m");
  EXPECT_EQ(printable("two\r\nlines\n"), "two lines");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m, \xe2\x80\xae"
                      "turned, \x7f"),
            "31m, turned,")
      << "C1, direction, DEL";
  EXPECT_EQ(printable("\xc3\xa9, \xe2\x82\xac, \xf0\x9f\x98\x80"), "\xc3\xa9, \xe2\x82\xac, \xf0\x9f\x98\x80");
  EXPECT_EQ(printable("\xff\xfe, \xc0\xaf, \xe0\x80\xaf, \xed\xa0\x80, \xf5"), "??, ??, ???, ???, ?") << "no UTF-8";
  EXPECT_EQ(printable("cut \xe2\x82"), "cut ??") << "a character that is cut off";
  EXPECT_EQ(printable(std::string_view("\0\0", 2)), "");
  EXPECT_EQ(oneLine(std::string(159, 'a') + "\xe2\x82\xac\xe2\x82\xac"), std::string(159, 'a') + "...");
  EXPECT_EQ(oneLine(std::string(158, 'a') + "\xc3\xa9"), std::string(158, 'a') + "\xc3\xa9");
}

TEST(LoadBadFiles, WhatIsNoFileIsRefused) {
  EXPECT_EQ(failureOf(corpus() / "not-there.glb"), "no such file");
  EXPECT_EQ(failureOf(corpus()), "is a directory, not a file");
  EXPECT_EQ(failureOf("/dev/zero"), "is not a regular file");
  EXPECT_EQ(failureOf(corpus() / "make_corpus.py"),
            "has the unknown extension .py; .gltf, .glb, .obj, .ply and .stl can be read");
}

// Every prefix of a good file either loads or is refused: none crashes.
TEST(LoadBadFiles, CutOffFilesAreHandledAtEveryByte) {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(corpus() / "good")) {
    if (!entry.is_regular_file()) continue;
    const std::string extension = entry.path().extension();
    std::vector<std::byte> file(fs::file_size(entry.path()));
    FILE* stream = std::fopen(entry.path().c_str(), "rb");
    ASSERT_NE(stream, nullptr);
    ASSERT_EQ(std::fread(file.data(), 1, file.size(), stream), file.size());
    std::fclose(stream);
    const std::size_t step = std::max<std::size_t>(file.size() / 200, 1);
    for (std::size_t size = 0; size < file.size(); size += step) {
      const std::span<const std::byte> part = std::span(file).first(size);
      try {
        if (extension == ".gltf" || extension == ".glb") loadGltf(part, {});
        if (extension == ".obj") loadObj(part, {});
        if (extension == ".ply") loadPly(part, {});
        if (extension == ".stl") loadStl(part);
      } catch (const LoadError& error) {
        EXPECT_NE(std::string(error.what()), "") << entry.path() << " cut to " << size;
      }
    }
  }
}

// assimp's own test models hold odd and broken files of many writers.
TEST(LoadBadFiles, AssimpsTestModelsLoadOrAreRefused) {
  const fs::path folder = "/usr/share/assimp/models";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not installed";
  std::size_t loaded = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    std::string extension = entry.path().extension();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (!std::set<std::string>{".gltf", ".glb", ".obj", ".ply", ".stl"}.contains(extension)) continue;
    try {
      const Scene scene = loadModel(entry.path());
      EXPECT_FALSE(scene.draws.empty()) << entry.path();
      ++loaded;
    } catch (const LoadError& error) {
      EXPECT_NE(std::string(error.what()), "") << entry.path();
    }
  }
  EXPECT_GT(loaded, 50U);
}

} // namespace
} // namespace vitrail::tool
