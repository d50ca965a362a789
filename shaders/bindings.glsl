// The descriptor set, the push constants and the specialisation constants of every kernel.
#ifndef BINDINGS_GLSL
#define BINDINGS_GLSL

#include "gpu_layout.h"

layout(constant_id = LR_SPEC_TEXEL_LOADS) const bool texel_loads = true;
layout(constant_id = LR_SPEC_SPHERES) const bool has_spheres = true;
layout(constant_id = LR_SPEC_ELLIPSOIDS) const bool has_ellipsoids = true;
layout(constant_id = LR_SPEC_PLANES) const bool has_planes = true;
layout(constant_id = LR_SPEC_FLATS) const bool has_flats = true;
layout(constant_id = LR_SPEC_BOXES) const bool has_boxes = true;
layout(constant_id = LR_SPEC_CONES) const bool has_cones = true;
layout(constant_id = LR_SPEC_MEDIA) const bool has_media = true;
layout(constant_id = LR_SPEC_ABSORPTION) const bool has_absorption = true;
layout(constant_id = LR_SPEC_FOG) const bool has_fog = true;
layout(constant_id = LR_SPEC_SCATTER) const bool has_scatter = true;
layout(constant_id = LR_SPEC_FRESNEL) const bool has_fresnel = true;
layout(constant_id = LR_SPEC_TRANSPARENT) const bool has_transparent = true;
layout(constant_id = LR_SPEC_TRANSPARENT_PLANES) const bool has_transparent_planes = true;
layout(constant_id = LR_SPEC_SPECULAR) const bool has_specular = true;
layout(constant_id = LR_SPEC_PATTERNS) const bool has_patterns = true;
layout(constant_id = LR_SPEC_TEXTURES) const bool has_textures = true;
layout(constant_id = LR_SPEC_CUTOUTS) const bool has_cutouts = true;
layout(constant_id = LR_SPEC_SPOTS) const bool has_spots = true;
layout(constant_id = LR_SPEC_SHUFFLE) const bool has_shuffle = true;
layout(constant_id = LR_SPEC_TEXEL_QUEUES) const bool texel_queues = true;
layout(constant_id = LR_SPEC_TREES) const bool has_trees = true;
layout(constant_id = LR_SPEC_SPHERE_TREE) const bool has_sphere_tree = true;
layout(constant_id = LR_SPEC_FLAT_TREE) const bool has_flat_tree = true;
layout(constant_id = LR_SPEC_ELLIPSOID_TREE) const bool has_ellipsoid_tree = true;
layout(constant_id = LR_SPEC_BOX_TREE) const bool has_box_tree = true;
layout(constant_id = LR_SPEC_CONE_TREE) const bool has_cone_tree = true;
layout(constant_id = LR_SPEC_MESHES) const bool has_meshes = true;
layout(constant_id = LR_SPEC_FALLOFF) const bool has_falloff = true;
layout(constant_id = LR_SPEC_INSTANCES) const bool has_instances = true;
layout(constant_id = LR_SPEC_INSTANCE_TREE) const bool has_instance_tree = true;
layout(constant_id = LR_SPEC_ONE_SIDED) const bool has_one_sided = true;
layout(constant_id = LR_SPEC_CORNERS) const bool has_corners = true;
layout(constant_id = LR_SPEC_INSPECT) const bool has_inspect = true;
layout(constant_id = LR_SPEC_EXPLAIN) const bool explains = false;
layout(constant_id = LR_SPEC_FEW) const bool has_few = true;
layout(constant_id = LR_SPEC_PATH) const bool has_paths = true;
layout(constant_id = LR_SPEC_EMITTERS) const bool has_emitters = true;
layout(constant_id = LR_SPEC_DELTA_LIGHTS) const bool has_delta_lights = true;
layout(constant_id = LR_SPEC_SOFT_LIGHTS) const bool has_soft_lights = true;
layout(constant_id = LR_SPEC_FLAT_EMITTERS) const bool has_flat_emitters = true;
layout(constant_id = LR_SPEC_DISK_EMITTERS) const bool has_disk_emitters = true;
layout(constant_id = LR_SPEC_TRIANGLE_EMITTERS) const bool has_triangle_emitters = true;
layout(constant_id = LR_SPEC_SPHERE_EMITTERS) const bool has_sphere_emitters = true;
layout(constant_id = LR_SPEC_ENVIRONMENT) const bool has_environment = true;
layout(constant_id = LR_SPEC_SUN) const bool has_sun = true;
layout(constant_id = LR_SPEC_EMITS_FRONT) const bool has_emits_front = true;
layout(constant_id = LR_SPEC_CAMERA) const bool has_lens = true;
layout(constant_id = LR_SPEC_GLOSS) const bool has_gloss = true;
layout(constant_id = LR_SPEC_METALS) const bool has_metals = true;
layout(constant_id = LR_SPEC_ROUGH_GLASS) const bool has_rough_glass = true;
layout(constant_id = LR_SPEC_DELTA) const bool has_delta = true;
layout(constant_id = LR_SPEC_COAT) const bool has_coat = true;
layout(constant_id = LR_SPEC_SHEEN) const bool has_sheen = true;
layout(constant_id = LR_SPEC_HIGHLIGHT) const bool has_highlight = true;
layout(constant_id = LR_SPEC_OREN_NAYAR) const bool has_oren_nayar = true;
layout(constant_id = LR_SPEC_MODELS) const bool has_models = true;
layout(constant_id = LR_SPEC_MIX) const bool has_mixes = true;
layout(constant_id = LR_SPEC_SCATTERING) const bool has_scattering = true;
layout(constant_id = LR_SPEC_FEW_PLANES) const uint few_planes = LR_FEW_PLANES;
layout(constant_id = LR_SPEC_FEW_SPHERES) const uint few_spheres = LR_FEW_SPHERES;
layout(constant_id = LR_SPEC_FEW_FLATS) const uint few_flats = LR_FEW_FLATS;
layout(constant_id = LR_SPEC_FEW_SOLIDS) const uint few_solids = LR_FEW_SOLIDS;
layout(constant_id = LR_SPEC_NORMAL_MAPS) const bool has_normal_maps = true;
layout(constant_id = LR_SPEC_BUMP_MAPS) const bool has_bump_maps = true;
layout(constant_id = LR_SPEC_GLOSS_MAPS) const bool has_gloss_maps = true;
layout(constant_id = LR_SPEC_EMISSION_MAPS) const bool has_emission_maps = true;

// Some surface's normals are not those of its shape.
const bool has_relief = has_normal_maps || has_bump_maps;

layout(std140, set = 0, binding = LR_BIND_FRAME) uniform FrameBlock { gpu_frame frame_block; };
layout(set = 0, binding = LR_BIND_SCENE_TEXEL) uniform usamplerBuffer scene_texels;
layout(std430, set = 0, binding = LR_BIND_SCENE_ROWS) readonly buffer SceneBlock
{
    uvec4 scene_rows[];
};
layout(std430, set = 0, binding = LR_BIND_FILM) buffer FilmBlock { uint film[]; };
layout(std430, set = 0, binding = LR_BIND_COUNTERS) buffer CounterBlock { uint counters[]; }; // gpu_counters
// Queues of gpu_ray and gpu_hit; see queue.glsl.
layout(std430, set = 0, binding = LR_BIND_RAYS_IN) readonly buffer RaysInBlock { uvec4 rays_in[]; };
layout(std430, set = 0, binding = LR_BIND_RAYS_OUT) buffer RaysOutBlock { uvec4 rays_out[]; };
layout(std430, set = 0, binding = LR_BIND_HITS) buffer HitBlock { uvec4 hits[]; };

layout(set = 0, binding = LR_BIND_RAYS_TEXEL) uniform usamplerBuffer ray_texels;
layout(set = 0, binding = LR_BIND_HITS_TEXEL) uniform usamplerBuffer hit_texels;
layout(std430, set = 0, binding = LR_BIND_FOUND) buffer FoundBlock { uvec4 found_rows[]; };
layout(set = 0, binding = LR_BIND_FOUND_TEXEL) uniform usamplerBuffer found_texels;
layout(std430, set = 0, binding = LR_BIND_SHADOWS) buffer ShadowBlock { uvec4 shadow_rays_queue[]; };
layout(set = 0, binding = LR_BIND_SHADOWS_TEXEL) uniform usamplerBuffer shadow_texels;

layout(std430, set = 0, binding = LR_BIND_CELLS) buffer CellBlock { uint cells[]; };
layout(std430, set = 0, binding = LR_BIND_ORDER) buffer OrderBlock { uint shadow_order[]; };
layout(std430, set = 0, binding = LR_BIND_NOTES) buffer NoteBlock { gpu_notes notes; };

layout(push_constant) uniform WorkBlock { gpu_work work_block; };

// Copies of the two, made by the first statement of every main: outside all branches and loops lavapipe
// loads a uniform once for all invocations, elsewhere once for each (docs/drivers.md).
gpu_frame frame;
gpu_work work;

void load_uniforms()
{
    frame = frame_block;
    work = work_block;
}

// Drivers give each thread a contiguous part of a dispatch's workgroups, so a picture with an empty
// half would leave a thread idle. Even workgroups take the first half of the work, odd ones the
// second.
uint spread_group(uint group, uint groups)
{
    uint half_count = (groups + 1u) >> 1;
    return group < half_count ? 2u * group : 2u * (group - half_count) + 1u;
}

// lavapipe compiles a kernel anew whenever a uniform changes that alone decides a branch or the length
// of a loop, which here is every pass (docs/drivers.md). This addition of 0 hides the uniform from it.
uint hidden(uint uniform_value)
{
    return uniform_value + (gl_NumWorkGroups.z >> 31);
}

uint queue_index()
{
    return spread_group(gl_WorkGroupID.x, gl_NumWorkGroups.x) * uint(LR_GROUP_SIZE) +
           gl_LocalInvocationIndex;
}

#endif
