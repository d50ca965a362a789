/* What the host and the kernels share: structs, bindings, ids, constants. Included by C and GLSL;
 * nothing in here is written a second time anywhere.
 *
 * Structs hold only uint, float, vec4, and vec3 on a 16-byte boundary followed by a scalar, so that
 * C, std430 and std140 agree; tests/gpu/test_layout.c compares the offsets with those in the
 * SPIR-V. Records of the scene are whole rows of 16 bytes in one buffer of rows, which the kernels
 * read through a texel or a storage buffer (scene_data.glsl). */
#ifndef LR_GPU_LAYOUT_H
#define LR_GPU_LAYOUT_H

#ifdef __STDC__
#include <assert.h>
#include <stddef.h>
#include <stdint.h>
typedef uint32_t uint;
typedef struct vec3 {
    float x, y, z;
} vec3;
typedef struct vec4 {
    float x, y, z, w;
} vec4;
#define LR_ROWS(type, rows) static_assert(sizeof(struct type) == 16 * (rows), #type);
#define LR_WORD(type, member, word)                                                                \
    static_assert(offsetof(struct type, member) == 4 * (word), #type "." #member);
#else
#define LR_ROWS(type, rows)
#define LR_WORD(type, member, word)
#endif

/* ---- Bindings of the one descriptor set, the same for all kernels ---- */
#define LR_BIND_FRAME 0       /* uniform buffer: gpu_frame */
#define LR_BIND_SCENE_TEXEL 1 /* the scene's rows as a uniform texel buffer, RGBA32UI */
#define LR_BIND_SCENE_ROWS 2  /* the same buffer as a storage buffer */
#define LR_BIND_FILM 3        /* LR_FILM_WORDS words a pixel of the tile */
#define LR_BIND_COUNTERS 4    /* gpu_counters */
#define LR_BIND_RAYS_IN 5     /* gpu_ray[] to trace */
#define LR_BIND_RAYS_OUT 6    /* gpu_ray[] of the next generation */
#define LR_BIND_HITS 7        /* gpu_hit[] */
#define LR_BIND_RAYS_TEXEL 8  /* the same buffers as uniform texel buffers, RGBA32UI */
#define LR_BIND_HITS_TEXEL 9
#define LR_BIND_FOUND 10 /* gpu_hit[]: what each ray of a pass met, in scenes with trees */
#define LR_BIND_FOUND_TEXEL 11
#define LR_BIND_SHADOWS 12 /* gpu_shadow_ray[], LR_SHADOW_LIGHTS segments of them */
#define LR_BIND_SHADOWS_TEXEL 13
#define LR_BIND_CELLS 14 /* how many shadow rays end in each cell, segment by segment */
#define LR_BIND_ORDER 15 /* the shadow rays of each segment in the order of their cells */
#define LR_BIND_COUNT 16
/* gpu_notes, in place of the order: what explains does not sort, so that no device needs one
 * binding more. */
#define LR_BIND_NOTES LR_BIND_ORDER

/* ---- Specialisation constants: what a scene does not use is not compiled ---- */
#define LR_SPEC_TEXEL_LOADS 0
#define LR_SPEC_SPHERES 1
#define LR_SPEC_FLATS 2
#define LR_SPEC_ELLIPSOIDS 3
#define LR_SPEC_BOXES 4
#define LR_SPEC_CONES 5
#define LR_SPEC_PLANES 6
#define LR_SPEC_MEDIA 7      /* some object encloses a medium that rays enter */
#define LR_SPEC_ABSORPTION 8 /* some medium absorbs */
#define LR_SPEC_FOG 9
#define LR_SPEC_SCATTER 10 /* some material reflects, transmits or has holes */
#define LR_SPEC_FRESNEL 11
#define LR_SPEC_TRANSPARENT 12 /* some shadow caster transmits light */
#define LR_SPEC_SPECULAR 13
#define LR_SPEC_PATTERNS 14
#define LR_SPEC_SPOTS 15
#define LR_SPEC_SHUFFLE 16            /* share loads within a subgroup */
#define LR_SPEC_TEXEL_QUEUES 17       /* as LR_SPEC_TEXEL_LOADS, for the queues */
#define LR_SPEC_TRANSPARENT_PLANES 18 /* ... that is a plane; or one has holes */
#define LR_SPEC_TREES 19       /* nearest and shadow hits are found by kernels of their own */
#define LR_SPEC_SPHERE_TREE 20 /* a kind that has many members is found by its tree */
#define LR_SPEC_FLAT_TREE 21   /* in the order of the kinds above */
#define LR_SPEC_ELLIPSOID_TREE 22
#define LR_SPEC_BOX_TREE 23
#define LR_SPEC_CONE_TREE 24
#define LR_SPEC_INSTANCES 25 /* meshes stand in instances: some are shown several times */
#define LR_SPEC_INSTANCE_TREE 26
#define LR_SPEC_ONE_SIDED 27 /* some surface is there from its front only */
#define LR_SPEC_CORNERS 28   /* some mesh has normals, texture coordinates or colours */
#define LR_SPEC_TEXTURES 29
#define LR_SPEC_CUTOUTS 30 /* some surface has holes where its picture is transparent */
#define LR_SPEC_MESHES 31
#define LR_SPEC_FALLOFF 32 /* some light fades with distance */
#define LR_SPEC_INSPECT 33 /* the film gets frame.inspect instead of light */
#define LR_SPEC_EXPLAIN 34 /* every ray and light is noted: gpu_notes */
#define LR_SPEC_PATH 35    /* paths instead of ray trees: path.comp, path_loop.comp */
#define LR_SPEC_FEW 36     /* ... whose rays are to test all primitives: */
#define LR_SPEC_EMITTERS 37          /* paths have some light source to choose */
#define LR_SPEC_DELTA_LIGHTS 38      /* ... from scene.lights; */
#define LR_SPEC_SOFT_LIGHTS 39       /* some of these have an extent */
#define LR_SPEC_FLAT_EMITTERS 40     /* flat surfaces that shine: */
#define LR_SPEC_DISK_EMITTERS 41     /* some are disks, */
#define LR_SPEC_TRIANGLE_EMITTERS 42 /* or triangles */
#define LR_SPEC_SPHERE_EMITTERS 43
#define LR_SPEC_EMITS_FRONT 44 /* some surface shines on one side alone */
#define LR_SPEC_CAMERA 45 /* some camera is more than a pinhole, or the filter than a box */
#define LR_SPEC_ENVIRONMENT 46 /* the background is a picture or the sky, */
#define LR_SPEC_SUN 47         /* with a sun */
#define LR_SPEC_GLOSS 48       /* paths: some material has a rough reflection, */
#define LR_SPEC_METALS 49      /* ... or any, with eta and k, */
#define LR_SPEC_ROUGH_GLASS 50 /* ... or lets light through a rough surface, */
#define LR_SPEC_DELTA 51       /* ... or mirrors or refracts as a smooth one, */
#define LR_SPEC_COAT 52
#define LR_SPEC_SHEEN 53
#define LR_SPEC_HIGHLIGHT 54 /* ... or has the classic highlight, */
#define LR_SPEC_OREN_NAYAR 55
#define LR_SPEC_MODELS 56 /* ... or is not classic */
#define LR_SPEC_FEW_PLANES 57 /* LR_SPEC_FEW: how many of each kind */
#define LR_SPEC_FEW_SPHERES 58
#define LR_SPEC_FEW_FLATS 59
#define LR_SPEC_FEW_SOLIDS 60
#define LR_SPEC_NORMAL_MAPS 61 /* some surface has a picture of its normals, */
#define LR_SPEC_BUMP_MAPS 62   /* ... of its heights, */
#define LR_SPEC_GLOSS_MAPS 63  /* ... paths: of its roughness or metal, */
#define LR_SPEC_EMISSION_MAPS 64 /* ... of the light that it sends out */
#define LR_SPEC_MIX 65        /* paths: some material is a mix of others */
#define LR_SPEC_SCATTERING 66 /* paths: some medium scatters light, or there is air */
#define LR_SPEC_COUNT 67

#define LR_FEW_PLANES 4 /* and the most that there may be: held.glsl */
#define LR_FEW_SPHERES 8
#define LR_FEW_FLATS 16
#define LR_FEW_SOLIDS 8

#define LR_GROUP_SIZE 64 /* invocations a workgroup: 8 x 8 pixels, or 64 queue entries */
#define LR_TILE_GROUP 8
#define LR_BATCH 8 /* primitives that a subgroup shares at a time */

/* ---- The film: exact sums in 64-bit fixed point ----
 * Word 2c and 2c + 1 of a pixel are the low and high half of channel c in steps of
 * 2^-LR_FILM_STEP_BITS, so a sum reaches 2^28; word 6 has bit c set once channel c overflowed, and
 * the channel then reads as 2^28; word 7 counts finished samples. A contribution is truncated to
 * the step, and clipped below 2^28. */
#define LR_FILM_WORDS 8
#define LR_FILM_FLAGS 6
#define LR_FILM_SAMPLES 7
#define LR_FILM_STEP_BITS 36
#define LR_FILM_MAX 268435456.0
#define LR_FILM_STEP 1.4551915228366852e-11

/* ---- Numbers the kernels and the host agree on ---- */
#define LR_T_MAX 1.0e15                     /* nothing is hit farther away */
#define LR_BEYOND 2.0e15                    /* a distance that no ray reaches */
#define LR_OFFSET 3.814697265625e-6         /* 2^-18: how far secondary rays start off, relative */
#define LR_SHORT_OF 0.999996185302734375    /* 1 - LR_OFFSET: shadow rays stop before the light */
#define LR_WEIGHT_MIN 9.094947017729282e-13 /* 2^-40: a weight below it is 0 */
#define LR_COSINE_MIN 1.0e-7                /* a cosine below it is 0 */
#define LR_ATTENUATION_MIN -80.0            /* 1 / distance^falloff is clamped to 2^-80 .. 2^40 */
#define LR_ATTENUATION_MAX 40.0
#define LR_SHADOW_UNIT 1048576.0           /* optical depth in shadows: log2 units of 2^-20 */
#define LR_SHADOW_BITS -9.5367431640625e-7 /* -1 / LR_SHADOW_UNIT */
#define LR_SHADOW_OPAQUE 41943040u         /* 40 of them: nothing gets through */
#define LR_MEDIA_MAX 8                     /* media that may be nested at one point */
#define LR_PASSES_MAX 255                  /* hidden surfaces that one ray may pass */
#define LR_CULL_SLACK 0.9999961853027344   /* 1 - 2^-18: bounding balls against rounding */
#define LR_CHECKER_SNAP 1.0e-4             /* in cells; see pattern.glsl */

/* ---- A primitive's and object's flags ---- */
#define LR_FLAG_SOLID 1u       /* encloses a medium */
#define LR_FLAG_TRANSPARENT 2u /* its material transmits */
#define LR_FLAG_OPEN 4u        /* cone without end caps */
#define LR_FLAG_DISK 8u        /* flat: u^2 + v^2 <= 1 */
#define LR_FLAG_TRIANGLE 16u   /* flat: u, v >= 0, u + v <= 1; neither: |u|, |v| <= 1 */
#define LR_FLAG_SHADOW 32u     /* casts shadows */
#define LR_FLAG_ONE_SIDED 64u  /* flats, triangles, open cones: not there as seen from behind */
#define LR_FLAG_SMOOTH 128u    /* triangle: its corners have normals, */
#define LR_FLAG_UV 256u        /* texture coordinates, */
#define LR_FLAG_COLORS 512u    /* colours */
#define LR_FLAG_INWARD 1024u   /* spheres, open cones: not there as seen from outside */

#define LR_PRIMITIVE_NONE 0xFFFFFFFFu

/* ---- Rows of the scene buffer ---- */
struct gpu_sphere {
    vec3 center;
    float inv_radius;
    float radius;
    uint object;
    uint flags;
    uint unused;
};
LR_ROWS(gpu_sphere, 2)

/* A triangle of a mesh, in the mesh's space. */
struct gpu_triangle {
    vec3 a;
    uint object; /* of a mesh that one object shows: that object; else 0 */
    vec3 b;
    uint order; /* its number in the mesh */
    vec3 c;
    uint flags;
};
LR_ROWS(gpu_triangle, 3)

/* The vertices of a triangle, by the row of each. */
struct gpu_corners {
    uint a;
    uint b;
    uint c;
    uint unused;
};
LR_ROWS(gpu_corners, 1)

/* What belongs to a vertex. */
struct gpu_vertex {
    uint normal; /* two 16-bit coordinates in the octahedron's square */
    float u;
    float v;
    uint color; /* the square roots of red, green and blue, 10 bits each */
};
LR_ROWS(gpu_vertex, 1)

/* A mesh somewhere in the world. */
struct gpu_instance {
    vec4 row0; /* world to mesh space */
    vec4 row1;
    vec4 row2;
    uint nodes;  /* the root of the mesh's tree, a row */
    uint object; /* added to its triangles' */
    float reach; /* the greatest coordinate of the mesh */
    uint flags;
};
LR_ROWS(gpu_instance, 4)

/* An inner node of a tree: the boxes around its two children, and who they are. A leaf is
 * LR_NODE_LEAF + (its primitives - 1 << LR_NODE_COUNT_SHIFT) + the number of the first; anything
 * else is the row of an inner node. */
struct gpu_node {
    vec3 min0;
    uint child0;
    vec3 max0;
    uint child1;
    vec3 min1;
    uint unused0;
    vec3 max1;
    uint unused1;
};
LR_ROWS(gpu_node, 4)
#define LR_NODE_LEAF 0x80000000u
#define LR_NODE_COUNT_SHIFT 28
#define LR_NODE_FIRST 0x0FFFFFFFu
#define LR_NODE_ROWS 4
#define LR_TREE_DEPTH 64
#define LR_BOX_SLACK                                                                               \
    3.814697265625e-6            /* 2^-18: boxes against rounding, relative to coordinates         \
                                  */
#define LR_BOX_MISSED 0x7F800000 /* infinity: the distance to a box that is not met */

struct gpu_plane {
    vec3 normal;  /* unit */
    float offset; /* normal . p = offset */
    uint object;
    uint flags;
    uint unused0;
    uint unused1;
};
LR_ROWS(gpu_plane, 2)

/* Rectangle, disk or triangle: a piece of a plane cut out by two coordinates, linear in p. */
struct gpu_flat {
    vec3 normal;
    float offset;
    vec3 u; /* coordinate u = u . p + u_offset */
    float u_offset;
    vec3 v;
    float v_offset;
    uint object;
    uint flags;
    uint unused0;
    uint unused1;
};
LR_ROWS(gpu_flat, 4)

/* Ellipsoid (unit sphere), box (|x|, |y|, |z| <= 1) or cone frustum (axis z from 0 to 1, radius
 * radius_from + z * radius_slope) in a space of its own: x = (row . (p, 1)) * inv_scale. The rows'
 * linear part has entries of at most 1 and carries no scale, so objects of 1e-20 do not overflow.
 */
struct gpu_solid {
    vec4 row0;
    vec4 row1;
    vec4 row2;
    float scale;
    float inv_scale;
    uint object;
    uint flags;
    float radius_from; /* only of cones, as is all that follows */
    float radius_slope;
    uint unused0;
    uint unused1;
};
LR_ROWS(gpu_solid, 5)

struct gpu_object {
    vec4 row0; /* world to object space, for patterns in object space */
    vec4 row1;
    vec4 row2;
    uint material;
    uint flags;
    uint rank;       /* as a medium, 1..65535: the highest of the nested media fills the space */
    uint instance;   /* of a mesh: which */
    uint shadow_red; /* -log2(transmit) in LR_SHADOW_UNIT */
    uint shadow_green;
    uint shadow_blue;
    uint shadow_rank; /* rank if it is solid, else 0: the medium that absorbs light in shadows */
};
LR_ROWS(gpu_object, 5)

/* Indexed by rank; rank 0 is the empty space around everything. */
struct gpu_medium {
    vec3 absorption; /* per metre, times log2(e); of paths with `scattering` added */
    float ior;
    vec3 scattering; /* the same */
    float anisotropy;
};
LR_ROWS(gpu_medium, 2)

#define LR_GPU_PATTERN_NONE 0u
#define LR_GPU_PATTERN_CHECKER 1u
#define LR_GPU_PATTERN_STRIPES 2u
#define LR_GPU_PATTERN_GRADIENT 3u
#define LR_GPU_PATTERN_RINGS 4u
#define LR_GPU_PATTERN_IMAGE 5u
#define LR_GPU_PATTERN_KIND 7u
#define LR_GPU_OBJECT_SPACE 8u /* added to the pattern's kind */
#define LR_GPU_TEXTURE_SHIFT 4 /* image: above these bits is the row of its gpu_texture */

#define LR_GPU_FRESNEL 1u
#define LR_GPU_PHONG 2u
#define LR_GPU_LIT 4u /* has ambient, diffuse, specular or emitted light to show */
#define LR_GPU_FRONT_ONLY 8u /* shines to where its normal points, not to the other side */

#define LR_MATERIAL_ROWS 9u

struct gpu_material {
    vec3 color0;
    uint pattern;
    vec3 color1;
    float inv_size; /* image: alpha below which there is no surface */
    vec3 pattern_origin;
    float inv_length2;      /* gradient: 1 / |direction|^2 */
    vec3 pattern_direction; /* unit but for the gradient */
    uint flags;
    vec3 ambient; /* with the scene's ambient light multiplied in */
    float shininess;
    vec3 diffuse;
    float ior;
    vec3 specular;
    float emission_red;
    vec3 reflect;
    float emission_green;
    vec3 transmit;
    float emission_blue;
};
LR_ROWS(gpu_material, 9)

/* Pictures of a material that are not its colour. */
#define LR_MAP_ROWS 2u
#define LR_NO_MAP 0xFFFFFFFFu
#define LR_GPU_MAPS_METALLIC_SHIFT 2 /* below: the channel of roughness; here that of metal */
#define LR_GPU_MAPS_MIRROR 16u       /* it mirrors, sharply or not */

struct gpu_maps {
    uint normal; /* the row of a gpu_texture, here and below, or LR_NO_MAP */
    float normal_scale;
    uint bump;
    float bump_height; /* metres from black to white */
    uint roughness;
    uint metallic;
    uint emission;
    uint flags;
};
LR_ROWS(gpu_maps, 2)

/* The physical side of a material, for paths. */
#define LR_BSDF_ROWS 5u

#define LR_GPU_MODEL_CLASSIC 0u /* the rest does not matter */
#define LR_GPU_MODEL_DIFFUSE 1u
#define LR_GPU_MODEL_DIELECTRIC 2u
#define LR_GPU_MODEL_CONDUCTOR 3u /* Schlick's, with the colour as reflectance at normal incidence */
#define LR_GPU_MODEL_METAL 4u     /* with eta and k, times the colour */
#define LR_GPU_MODEL_PBR 5u

struct gpu_bsdf {
    vec3 eta; /* metals: refractive index */
    uint model;
    vec3 k;
    float alpha; /* width of the microfacets' distribution; below LR_ALPHA_MIN: smooth */
    vec3 sheen;
    float sheen_alpha;
    float coat;
    float coat_alpha;
    float metallic;
    float transmission;
    float roughness; /* diffuse: of Oren and Nayar's kind */
    uint unused0;
    uint unused1;
    uint unused2;
};
LR_ROWS(gpu_bsdf, 5)

/* The materials that a mix is of; its gpu_material has the share of the second as its colour. */
struct gpu_mix {
    uint first; /* LR_GPU_MIX_NONE: it is no mix */
    uint second;
    uint unused0;
    uint unused1;
};
LR_ROWS(gpu_mix, 1)
#define LR_GPU_MIX_NONE 0xFFFFFFFFu
#define LR_GPU_MIX_NESTING_MAX 4u

#define LR_ALPHA_MIN 1.0e-3
#define LR_SHEEN_ALPHA_MIN 1.0e-2
#define LR_RATIO_FLAT 0.02 /* rough glass is smooth with a ratio of indices this close to 1 */

/* What sample_bsdf found. */
#define LR_BSDF_REFLECTS 1u
#define LR_BSDF_TRANSMITS 2u
#define LR_BSDF_DELTA 4u

/* Tables of what rough surfaces reflect (bsdf_table.glsl, tools/make_albedo.c), one behind the other
 * from row frame.albedo on: a row for each of the LR_ALBEDO_CELLS^2 cells of a square, with the values
 * at its corners. */
#define LR_ALBEDO_CELLS 47
#define LR_ALBEDO_ROWS 2209u
#define LR_ALBEDO_GGX 0u     /* reflected by GGX microfacets that absorb nothing */
#define LR_ALBEDO_SCHLICK 1u /* fifth root of the mean of Schlick's (1 - c)^5 in that, less 1 - cos */
#define LR_ALBEDO_SHEEN 2u
#define LR_ALBEDO_TABLES 3u
/* Behind these, from row frame.glass_albedo on: what glass reflects and lets through, against what GGX
 * microfacets reflect that absorb nothing: LR_GLASS_INTO rectangles into what is denser, by the fourth
 * root of |1 - ratio| / (1 + ratio) of the indices of refraction, and LR_GLASS_OUT_OF out of it. */
#define LR_GLASS_COLUMNS 64
#define LR_GLASS_ROWS 32
#define LR_GLASS_CELLS 2048u
#define LR_GLASS_INTO 17
#define LR_GLASS_OUT_OF 33
#define LR_GLASS_FIRST 0.315 /* a ratio of 1.02, */
#define LR_GLASS_LAST 0.88   /* and of 4 */

#define LR_GPU_WRAP_REPEAT 0u
#define LR_GPU_WRAP_CLAMP 1u
#define LR_GPU_WRAP_MIRROR 2u
#define LR_GPU_TEXTURE_FLOATS 16u

/* The records of the textures are the buffer's first rows. */
struct gpu_texture {
    uint texels; /* row of the first: four in a row, a byte for red, green, blue and alpha from
                    the lowest bits up; or floats, one in a row, with alpha 1 */
    uint size;   /* width, height << 16 */
    uint curve;  /* row b from here: the value of byte b */
    uint flags;  /* wrap of u, wrap of v << 2, LR_GPU_TEXTURE_FLOATS */
};
LR_ROWS(gpu_texture, 1)

#define LR_GPU_LIGHT_DIRECTIONAL 1u
#define LR_GPU_LIGHT_SPOT 2u
#define LR_GPU_LIGHT_SHADOWS 4u

struct gpu_light {
    vec3 position;      /* point, spot */
    float half_falloff; /* half the exponent: the kernels know the distance squared */
    vec3 color;         /* times intensity */
    uint flags;
    vec3 direction; /* unit, the way the light travels */
    float cos_angle;
    float cos_scale; /* 1 / (cos inner - cos angle) */
    float radius;    /* point, spot: of the ball that shines, for paths; 0: a point */
    float spread;    /* directional: 1 - cos of half the angle that it fills, for paths */
    uint unused;
};
LR_ROWS(gpu_light, 4)

/* What a path's vertex may choose as its light source: one of the lights, a surface that shines or
 * one facet of it. */
#define LR_GPU_EMITTER_LIGHT 1u
#define LR_GPU_EMITTER_RECTANGLE 2u
#define LR_GPU_EMITTER_DISK 3u
#define LR_GPU_EMITTER_TRIANGLE 4u
#define LR_GPU_EMITTER_SPHERE 5u
#define LR_GPU_EMITTER_ENVIRONMENT 6u
#define LR_GPU_EMITTER_SUN 7u
#define LR_GPU_EMITTER_KIND 7u
#define LR_GPU_EMITTER_FRONT 8u /* shines to the side that the normal points to */
#define LR_GPU_EMITTER_BACK 16u
#define LR_EMITTER_ROWS 5u

struct gpu_emitter {
    vec3 origin; /* rectangle, triangle: a corner; disk, sphere: the centre */
    uint kind;
    vec3 e1;        /* rectangle, triangle: an edge from there; disk: a radius */
    float inv_pdf; /* 1 / probability of the choice; of what is flat, times its area */
    vec3 e2;
    float pdf; /* as gpu_object_emitter */
    vec3 radiance;
    uint light; /* which of the lights; of a surface the row of its gpu_emitter_map, or 0 */
    vec3 normal;
    float radius;
};
LR_ROWS(gpu_emitter, 5)

/* How the picture of its light lies on an emitter. */
struct gpu_emitter_map {
    float u; /* texture coordinates at the origin of what is flat, */
    float v;
    float u1; /* what is added along e1, */
    float v1;
    float u2; /* and along e2 */
    float v2;
    uint texture;
    uint object; /* of a sphere */
};
LR_ROWS(gpu_emitter_map, 2)

/* The choices are a power of two, all equally likely; a number within each, below LR_CHOICE_STEPS /
 * how many there are, tells which of its two emitters (rows) it is. So all probabilities are whole
 * multiples of 1 / LR_CHOICE_STEPS. */
#define LR_CHOICE_BITS 24
#define LR_CHOICE_STEPS 16777216.0
struct gpu_choice {
    uint threshold; /* from here on it is the second */
    uint first;
    uint second;
    uint unused;
};
LR_ROWS(gpu_choice, 1)

/* Of every object, what the weight of its light is reckoned from where a path meets it. */
#define LR_OBJECT_EMITTER_ROWS 2u
struct gpu_object_emitter {
    vec3 center; /* of a sphere */
    uint kind;   /* 0: no one chooses it; all that is flat counts as a rectangle */
    float pdf;   /* that a path chooses it; of what is flat, by its area */
    float radius;
    uint unused0;
    uint unused1;
};
LR_ROWS(gpu_object_emitter, 2)

/* A picture of all directions: at angle theta from `up` and azimuth phi from `forward` to the right it
 * has the coordinates (1/2 + phi / 2 pi, theta / pi). How likely a path goes towards a texel is told
 * by two tables: of the picture's rows, each a gpu_sky_row, and behind them of the texels within each,
 * four words in a row: the steps of 1 / LR_CHOICE_STEPS before each. */
struct gpu_environment {
    vec3 right; /* unit */
    uint texture;
    vec3 up;
    float intensity;
    vec3 forward;
    uint rows;
    vec3 sun;         /* unit, towards its middle */
    float sun_spread; /* 1 - cos of half the angle that it fills */
    vec3 sun_radiance;
    float pdf;     /* that a path chooses the picture, times width / 4 pi */
    float sun_pdf; /* that it chooses the sun, per solid angle */
    uint width;
    uint height;
    uint unused;
};
LR_ROWS(gpu_environment, 6)

struct gpu_sky_row {
    uint begin; /* steps before the row */
    uint steps;
    float near;   /* sin(theta / 2)^2 where the row is nearest to its pole, measured from there, */
    float extent; /* and from there to its other edge; the lower half has the lower pole */
};
LR_ROWS(gpu_sky_row, 1)

/* All primitives are numbered, kind by kind. A list holds one kind: those from number `begin` up to
 * `end`; the record of number i is at row base + i * its rows (modulo 2^32). Bounded primitives
 * come first, and row frame.balls + i is the ball around them: centre, radius squared. */
struct gpu_list {
    uint base;
    uint begin;
    uint end;
    uint nodes; /* the root of the list's tree, a row, if it has one */
};
LR_ROWS(gpu_list, 1)
#ifdef __STDC__
typedef struct gpu_list gpu_list;
#endif

/* ---- What is the same for the whole picture ---- */
#define LR_GPU_ORTHOGRAPHIC 1u
#define LR_GPU_PANORAMA 2u
#define LR_GPU_FILTER_TENT 4u
#define LR_GPU_FILTER_BLACKMAN_HARRIS 8u
#define LR_GPU_BLADES_SHIFT 8

/* What makes a camera more than a pinhole with a box filter: LR_SPEC_CAMERA. */
struct gpu_lens {
    vec3 right; /* from the middle of the lens to its edge */
    float inv_focus;
    vec3 up;
    uint kind;          /* LR_GPU_ORTHOGRAPHIC, ..., the number of blades */
    vec3 origin_step;   /* by how much the frame's vectors change while the shutter is open */
    float blade_turns;  /* from the right, counter-clockwise, to the first corner */
    vec3 forward_step;
    float inv_blades;
    vec3 right_step;
    float turns_across; /* a pixel of a panorama */
    vec3 down_step;
    float turns_down;
};
LR_ROWS(gpu_lens, 6)
#ifdef __STDC__
typedef struct gpu_lens gpu_lens;
#endif

struct gpu_frame {
    vec3 origin;      /* camera */
    float half_width; /* of the picture, in pixels */
    vec3 forward;
    float half_height;
    vec3 pixel_right; /* one pixel to the right: at distance 1 along forward; orthographic:
                         anywhere; panorama: of unit length */
    float inv_samples;
    vec3 pixel_down;
    uint samples;
    vec3 background_low;
    uint seed;
    vec3 background_high;
    uint depth;
    vec3 background_up;
    float min_weight;
    vec3 fog_color;
    float fog_density; /* times log2(e) */
    gpu_list spheres;
    gpu_list flats;
    gpu_list solids; /* the next three together */
    gpu_list ellipsoids;
    gpu_list boxes;
    gpu_list cones;
    gpu_list planes;
    uint objects;
    uint materials;
    uint media;
    uint lights;
    uint inside0; /* media around the camera, two ranks a word */
    uint inside1;
    uint inside2;
    uint inside3;
    uint balls;   /* row */
    uint bounded; /* primitives that have a ball */
    float reach;  /* the greatest coordinate in a tree */
    uint corners; /* row of the gpu_corners of triangle 0 */
    gpu_list instances;
    gpu_list triangles;
    vec3 cells_from; /* where the first of the cells is that shadow rays are sorted by */
    uint inspect;
    vec3 inv_cell; /* 1 / its sides */
    float inspect_scale; /* the distance that is half-way between near and far */
    uint choices;         /* rows: of the first gpu_choice, */
    uint object_emitters; /* and gpu_object_emitter */
    uint choice_shift;    /* LR_CHOICE_BITS - log2 of how many choices there are */
    uint environment;     /* row of the gpu_environment */
    gpu_lens lens;
    uint bsdfs;        /* row of the gpu_bsdf of material 0 */
    uint albedo;       /* row of the tables, */
    uint glass_albedo; /* and of those of glass */
    uint maps;         /* row of the gpu_maps of material 0 */
    uint mixes;        /* row of the gpu_mix of material 0 */
    uint unused_frame0;
    uint unused_frame1;
    uint unused_frame2;
};
LR_ROWS(gpu_frame, 31)
#define LR_GPU_INSPECT_NORMAL 1u
#define LR_GPU_INSPECT_DEPTH 2u
#define LR_GPU_INSPECT_OBJECT 3u
#define LR_GPU_INSPECT_RAYS 4u
#define LR_GPU_INSPECT_RAY 0.015625 /* 1/64: what a ray adds */
#define LR_GPU_INSPECT_ALBEDO 5u
#define LR_GPU_INSPECT_SHIFTED_NORMAL 6u /* n + 1; 1 where there is nothing */
#define LR_GPU_INSPECT_DISTANCE 7u       /* red: in metres; green: 1 where there is something */
#define LR_GPU_INSPECT_POSITION 8u       /* max(p, 0) */
#define LR_GPU_INSPECT_NEGATIVE_POSITION 9u /* max(-p, 0) */
#define LR_GPU_INSPECT_NUMBER 10u /* of the object + 1: its lower 16 bits in red, the others green */
#define LR_GPU_INSPECT_KIND 15u
#define LR_GPU_INSPECT_PATHS 16u /* added: samples lie in their pixel where those of paths do */
#define LR_CELL_BITS 5 /* cells along a side, as a power of two */
#define LR_CELLS 32768u

/* ---- What differs from one dispatch to the next (push constants) ---- */
struct gpu_work {
    uint tile_x; /* first pixel of the tile in the picture; its size in pixels traced */
    uint tile_y;
    uint tile_width;
    uint tile_height;
    uint first_sample; /* of a primary pass */
    uint count;        /* rays of a queue pass */
    uint first;        /* first ray in the queue */
    uint light;        /* first light and count of a shading pass */
    uint light_count;
    uint first_lights; /* 1 in the first shading pass of the hits: the rest is done once, there */
    uint shadow_room;  /* shadow rays that a segment holds */
    uint shadow_first[4]; /* and how many are in each already */
    uint sorted;          /* 1: the shadow rays are, or will be, sorted */
    uint step;            /* camera rays: every so many-th pixel of a row, and row */
    uint film_first;      /* where the tile's first pixel is in the film, */
    uint film_pitch;      /* and how many pixels lie between it and the one below */
    uint samples;         /* of each pixel, where one invocation takes them all, */
    uint rounds;          /* and bounces that it takes in this pass; */
    uint resumed;         /* 1: the queue holds where the pass before left the paths */
    uint plane_rows; /* of the first of each kind: LR_SPEC_FEW */
    uint sphere_rows;
    uint flat_rows;
    uint solid_rows;
};
#define LR_SHADOW_THROUGH 4u /* light that no path finds otherwise comes through transparent objects */
#define LR_SHADOW_LIGHTS 4 /* light l goes to segment l modulo this */

/* ---- Queues ---- */
#define LR_STATE_DEPTH 255u /* bounces so far */
#define LR_STATE_LAST 1024u /* of a path: sees lights alone */
#define LR_STATE_KIND_SHIFT 8
#define LR_STATE_KIND 768u
#define LR_STATE_PASSES_SHIFT 16
#define LR_KIND_PRIMARY 0u
#define LR_KIND_REFLECTED 1u
#define LR_KIND_REFRACTED 2u

struct gpu_ray {
    vec3 origin;
    uint pixel;     /* of the film */
    vec3 direction; /* unit */
    uint state;
    vec3 weight;
    uint note;   /* of the ray that it comes from, in kernels that explain; in those that inspect
                    the bits of its length; in path_loop.comp twice the paths begun, and 1 if the
                    last has not ended */
    uint media0; /* only in scenes with media: ranks of the media around the origin, two a word, in
                    no order, 0: none */
    uint media1;
    uint media2;
    uint media3;
};
LR_ROWS(gpu_ray, 4)

/* What a ray has behind that when it is part of a path. */
struct gpu_path {
    uint pixel;     /* path_key in sampler.glsl */
    uint order;
    float pdf;      /* of its direction, per solid angle; 0: it could have been no other */
    float distance; /* from where the path bounced last to the ray's origin */
};
LR_ROWS(gpu_path, 1)

struct gpu_hit {
    uint ray; /* in the queue */
    float t;
    uint primitive;
    uint object;
};
LR_ROWS(gpu_hit, 1)

/* Light on its way from a source to a point, if nothing stands between them. */
struct gpu_shadow_ray {
    vec3 origin; /* the point */
    uint pixel;  /* in kernels that explain, which have but one: the light's note */
    vec3 value;  /* what it adds to the pixel */
    uint light;  /* of a path: LR_SHADOW_THROUGH or 0 */
};
LR_ROWS(gpu_shadow_ray, 2)

/* What it has behind that when it comes from a path: where to, as shadow_ray in light.glsl. */
struct gpu_shadow_way {
    vec3 direction; /* unit */
    float t_max;
};
LR_ROWS(gpu_shadow_way, 1)

/* What a pass counts. The first three words are an indirect dispatch. */
struct gpu_counters {
    uint hit_groups;
    uint hit_groups_y;
    uint hit_groups_z;
    uint hits;
    uint rays;   /* in the next generation's queue */
    uint traced; /* entries that each kernel finished: the host checks them */
    uint shaded;
    uint reflected; /* rays made, by kind */
    uint refracted;
    uint passed;
    uint reflected_hits;
    uint refracted_hits;
    uint shadow;
    uint shadow_hits;
    uint dropped_depth;
    uint dropped_weight;
    uint dropped_nesting;
    uint non_finite;
    uint saturated;
    uint made;           /* camera rays */
    uint shadow_rays[4]; /* added to the segments */
    uint found;          /* entries that the kernels of trees finished */
    uint unfinished;     /* ... that a driver stopped half-way */
    uint made_hits;      /* of camera rays, where they are not alone in their pass */
    uint unused0;
};
LR_ROWS(gpu_counters, 7)

/* The numbers of the words that kernels count in. */
#define LR_COUNTER_HIT_GROUPS 0u
#define LR_COUNTER_HITS 3u
#define LR_COUNTER_RAYS 4u
#define LR_COUNTER_TRACED 5u
#define LR_COUNTER_SHADED 6u
#define LR_COUNTER_REFLECTED 7u
#define LR_COUNTER_REFRACTED 8u
#define LR_COUNTER_PASSED 9u
#define LR_COUNTER_REFLECTED_HITS 10u
#define LR_COUNTER_REFRACTED_HITS 11u
#define LR_COUNTER_SHADOW 12u
#define LR_COUNTER_SHADOW_HITS 13u
#define LR_COUNTER_DROPPED_DEPTH 14u
#define LR_COUNTER_DROPPED_WEIGHT 15u
#define LR_COUNTER_DROPPED_NESTING 16u
#define LR_COUNTER_NON_FINITE 17u
#define LR_COUNTER_SATURATED 18u
#define LR_COUNTER_MADE 19u
#define LR_COUNTER_SHADOW_RAYS 20u
#define LR_COUNTER_FOUND 24u
#define LR_COUNTER_UNFINISHED 25u
#define LR_COUNTER_MADE_HITS 26u
LR_WORD(gpu_counters, hit_groups, LR_COUNTER_HIT_GROUPS)
LR_WORD(gpu_counters, hits, LR_COUNTER_HITS)
LR_WORD(gpu_counters, rays, LR_COUNTER_RAYS)
LR_WORD(gpu_counters, traced, LR_COUNTER_TRACED)
LR_WORD(gpu_counters, shaded, LR_COUNTER_SHADED)
LR_WORD(gpu_counters, reflected, LR_COUNTER_REFLECTED)
LR_WORD(gpu_counters, refracted, LR_COUNTER_REFRACTED)
LR_WORD(gpu_counters, passed, LR_COUNTER_PASSED)
LR_WORD(gpu_counters, reflected_hits, LR_COUNTER_REFLECTED_HITS)
LR_WORD(gpu_counters, refracted_hits, LR_COUNTER_REFRACTED_HITS)
LR_WORD(gpu_counters, shadow, LR_COUNTER_SHADOW)
LR_WORD(gpu_counters, shadow_hits, LR_COUNTER_SHADOW_HITS)
LR_WORD(gpu_counters, dropped_depth, LR_COUNTER_DROPPED_DEPTH)
LR_WORD(gpu_counters, dropped_weight, LR_COUNTER_DROPPED_WEIGHT)
LR_WORD(gpu_counters, dropped_nesting, LR_COUNTER_DROPPED_NESTING)
LR_WORD(gpu_counters, non_finite, LR_COUNTER_NON_FINITE)
LR_WORD(gpu_counters, saturated, LR_COUNTER_SATURATED)
LR_WORD(gpu_counters, made, LR_COUNTER_MADE)
LR_WORD(gpu_counters, shadow_rays, LR_COUNTER_SHADOW_RAYS)
LR_WORD(gpu_counters, found, LR_COUNTER_FOUND)
LR_WORD(gpu_counters, unfinished, LR_COUNTER_UNFINISHED)
LR_WORD(gpu_counters, made_hits, LR_COUNTER_MADE_HITS)

/* ---- The window: display.comp ---- */
#define LR_SHADES 256    /* of a channel */
#define LR_COARSE_MAX 32 /* pixels between those that are traced first, at most */

/* How film sums become shades; two of them, for pixels of display.samples and of other numbers of
 * samples. A sum has as many shades as steps that it reaches; where to begin counting is told by its
 * leading bits (sum_bucket in display.comp). */
#define LR_BUCKET_BITS 8 /* behind the leading one */
#define LR_BUCKETS 14592
struct gpu_shades {
    uint starts[LR_BUCKETS];      /* the shade of the least sum in the bucket */
    uint steps_low[LR_SHADES]; /* in film steps; the last is beyond all sums */
    uint steps_high[LR_SHADES];
    uint overflow; /* the shade of sums beyond the film's range */
    uint unused0;
    uint unused1;
    uint unused2;
};

struct gpu_display {
    uint width;
    uint height;
    uint samples;
    uint blue_first; /* 1: of a pixel's four bytes the first is blue, 0: red */
    uint overlay;    /* 1: there is one: pixels with premultiplied alpha, blue in the lowest byte */
    uint palette;    /* 1: the shade of red is an index of the palette */
    uint coarse;     /* pixels between those of the film that have samples, at most */
};

#include "gpu_notes.h"

/* ---- The start-up self-test ---- */
#define LR_SELF_TEST_COUNT 256

struct gpu_self_test_in {
    float a;
    float b;
    float c;
    uint n;
};
LR_ROWS(gpu_self_test_in, 1)

struct gpu_self_test_out {
    uint sum;
    uint difference;
    uint product;
    uint product_sum;
    uint sum_product;
    uint scaled;
    uint from_integer;
    uint to_integer;
};
LR_ROWS(gpu_self_test_out, 2)

#endif
