/* The scene in memory: flat arrays and indices, as the scene text says it, checked and completed
 * with defaults. Lengths are metres, angles degrees, colours linear RGB, directions as written
 * (not yet of unit length). The reader guarantees the ranges named here. */
#ifndef LR_SCENE_SCENE_H
#define LR_SCENE_SCENE_H

#include "base/vec.h"
#include "lavaray.h"

typedef lr_vec3 lr_color; /* x, y, z are red, green, blue; finite, >= 0 and <= LR_COLOR_MAX */

#define LR_COLOR_MAX 1e12
#define LR_COORDINATE_MAX 1e12 /* |any coordinate|; also after transforms */
#define LR_LENGTH_MIN 1e-20    /* radii and extents */
#define LR_OBJECTS_MAX 100000  /* written in a scene text */
#define LR_LIGHTS_MAX 256
#define LR_MATERIALS_MAX 65535
#define LR_NONE UINT32_MAX   /* instead of an index */
#define LR_MIX_NESTING_MAX 4 /* a mix of mixes of mixes of mixes */

/* How a texture goes on beyond 0..1. */
typedef enum lr_wrap { LR_WRAP_REPEAT, LR_WRAP_CLAMP, LR_WRAP_MIRROR } lr_wrap;

/* What the bytes of a texture stand for. Floats are what they are, but for normals, which lie
 * between 0 and 1. */
typedef enum lr_texels {
    LR_TEXELS_COLORS,  /* sRGB */
    LR_TEXELS_NUMBERS, /* byte / 255 */
    LR_TEXELS_NORMALS, /* (byte - 128) / 127, at least -1: 128, 128, 255 is straight up */
} lr_texels;

/* A picture for surfaces. Coordinates (0, 0) are the top left corner of the top left texel. */
typedef struct lr_texture {
    char *name; /* the file that stands in messages */
    uint32_t width, height;
    lr_wrap wrap_u, wrap_v;
    lr_texels texels;
    uint8_t *bytes; /* 4 a texel, top row first: red, green, blue, and alpha; or NULL, and */
    float *floats;  /* 3 a texel, top row first: linear red, green, blue >= 0 */
    bool borrowed;  /* texels of a part of the scene */
    /* Of floats: the first texel that held no colour and was changed, and one of its samples; its
     * number + 1, 0: none. */
    uint32_t changed;
    float changed_from;
} lr_texture;

/* Triangles with what belongs to their corners, stored once for all the objects that show them. All
 * numbers are finite, |positions| up to LR_COORDINATE_MAX, all indices in range. */
typedef struct lr_mesh {
    char *name;          /* the file and the part of it that stand in messages */
    float *positions;    /* 3 a vertex, in the mesh's own space */
    float *normals;      /* 3 a vertex, of unit length; NULL: flat triangles */
    float *uvs;          /* texture coordinates, 2 a vertex; NULL: none */
    float *colors;       /* 3 a vertex, linear, 0..1, times the material's colour; NULL: none */
    uint32_t *triangles; /* 3 vertices a triangle, counter-clockwise as seen from outside */
    uint32_t vertex_count, triangle_count;
    bool closed;   /* it encloses a space, which a transmitting material fills */
    bool borrowed; /* arrays of a part of the scene */
} lr_mesh;

typedef enum lr_pattern_kind {
    LR_PATTERN_NONE, /* colors[0] everywhere */
    LR_PATTERN_CHECKER,
    LR_PATTERN_STRIPES,
    LR_PATTERN_GRADIENT,
    LR_PATTERN_RINGS,
    LR_PATTERN_IMAGE, /* a texture by the mesh's texture coordinates, times colors[0] */
} lr_pattern_kind;

typedef struct lr_pattern {
    lr_pattern_kind kind;
    bool object_space; /* follows the object's transform; otherwise fixed in the world */
    lr_color colors[2];
    uint32_t texture;  /* image: which */
    double size;       /* of a checker's cell, a stripe, a ring; > 0 */
    lr_vec3 origin;    /* rings: centre; gradient: where colors[0] is */
    lr_vec3 direction; /* stripes: across them; rings: their axis; gradient: from origin to where
                          colors[1] is. Not zero. */
} lr_pattern;

/* What a picture may shape beside the colour. */
typedef enum lr_map_kind {
    LR_MAP_NORMAL,    /* in tangent space, y up; `amount` multiplies x and y */
    LR_MAP_BUMP,      /* heights, in red; `amount` is that of white, in metres */
    LR_MAP_ROUGHNESS, /* a channel multiplies `roughness`; only for paths, as the next is */
    LR_MAP_METALLIC,  /* ... `metallic` */
    LR_MAP_EMISSION,  /* multiplies `emission` */
    LR_MAP_COUNT,
} lr_map_kind;

typedef enum lr_channel {
    LR_CHANNEL_RED,
    LR_CHANNEL_GREEN,
    LR_CHANNEL_BLUE,
    LR_CHANNEL_ALPHA,
} lr_channel;

typedef struct lr_map {
    bool given;
    lr_channel channel;
    uint32_t texture;
    double amount;
} lr_map;

typedef enum lr_highlight { LR_HIGHLIGHT_BLINN, LR_HIGHLIGHT_PHONG } lr_highlight;

typedef enum lr_emits { LR_EMITS_BOTH, LR_EMITS_FRONT } lr_emits;
/* What a material is made of, for paths. The fields of the classic shading are then an
 * approximation (models.h). */
typedef enum lr_model {
    LR_MODEL_CLASSIC,
    LR_MODEL_DIFFUSE,
    LR_MODEL_DIELECTRIC,
    LR_MODEL_CONDUCTOR,
    LR_MODEL_PBR,
    LR_MODEL_THIN_GLASS,
    LR_MODEL_MIX,
} lr_model;

typedef enum lr_metal {
    LR_METAL_NONE,
    LR_METAL_GOLD,
    LR_METAL_SILVER,
    LR_METAL_COPPER,
    LR_METAL_ALUMINIUM,
    LR_METAL_CHROMIUM,
    LR_METAL_TUNGSTEN,
    LR_METAL_IRON,
    LR_METAL_NICKEL,
} lr_metal;

typedef struct lr_material {
    char *name; /* NULL for one written inside an object */
    uint32_t line;
    lr_pattern color;
    lr_color ambient, diffuse, specular, reflect, transmit; /* defaults already filled in */
    lr_color emission; /* radiance that the surface sends out by itself; only paths are lit by it */
    lr_emits emits;    /* front: where the normal points */
    double shininess;  /* 0..1e6 */
    lr_highlight highlight;
    double ior; /* 0.01..100 */
    bool fresnel;
    lr_color absorption; /* per metre, Beer-Lambert: exp(-absorption * distance) */
    lr_color scattering; /* per metre, only for paths */
    double anisotropy;   /* -0.95..0.95: mean cosine of the angles that it scatters by */
    int priority;        /* -100..100: which of two overlapping media fills the overlap */
    double alpha_cutoff; /* where its texture's alpha is below, no surface; 0: everywhere */
    bool one_sided;      /* from behind, flats, triangles and open cones are not there */
    lr_model model;      /* the rest is 0 where it does not use it */
    double roughness;    /* 0..1; its square is the width of the microfacets' distribution */
    lr_metal metal;      /* conductor: the one that eta and k are of */
    lr_color eta, k;     /* conductor: refractive index; all 0: `color` is its reflectance */
    double metallic, transmission, clearcoat, clearcoat_roughness; /* pbr: 0..1 */
    lr_color sheen;                                                /* pbr: 0..1 */
    double sheen_roughness;
    lr_map maps[LR_MAP_COUNT]; /* as lr_map_kind */
    bool pane;                 /* what it lets through goes straight on: it bounds no medium */
    struct {
        uint32_t first, second; /* materials without emission, holes and sides of their own */
        lr_pattern weight;      /* share of the second: luminance, of which 1 counts at most */
        uint32_t nesting;       /* 1: a mix of none; <= LR_MIX_NESTING_MAX */
    } mix;
} lr_material;

typedef enum lr_object_kind {
    LR_SPHERE,
    LR_PLANE,
    LR_BOX,
    LR_DISK,
    LR_RECTANGLE,
    LR_CYLINDER,
    LR_CONE,
    LR_TRIANGLE,
    LR_MESH,
} lr_object_kind;

typedef struct lr_object {
    lr_object_kind kind;
    uint32_t material;
    uint32_t line;
    bool shadow;           /* whether it casts shadows */
    bool open;             /* cylinder, cone: without end caps */
    bool inward;           /* sphere, open cylinder and cone: only its inside is there */
    bool transformed;      /* to_world is not the identity */
    bool moves;            /* it has values with keys, or a group around it has */
    lr_transform to_world; /* of the object and of the groups around it; invertible */
    union {
        struct {
            lr_vec3 center;
            double radius;
        } sphere;
        struct {
            lr_vec3 normal; /* not zero */
            double offset;  /* points with normal . p = offset */
        } plane;
        struct {
            lr_vec3 min, max; /* min < max in each coordinate */
        } box;
        struct {
            lr_vec3 center, normal;
            double radius;
        } disk;
        struct {
            lr_vec3 corner, u, v; /* corner + a u + b v, 0 <= a, b <= 1; u and v not parallel */
        } rectangle;
        struct {
            lr_vec3 from, to;              /* centres of the two ends, distinct */
            double radius_from, radius_to; /* cylinder: equal. cone: >= 0, not both 0 */
        } cone;                            /* cylinder and cone */
        struct {
            lr_vec3 a, b, c; /* not on one line; normal (b - a) x (c - a) */
        } triangle;
        uint32_t mesh; /* index of the scene's meshes */
    };
} lr_object;

typedef enum lr_light_kind { LR_LIGHT_POINT, LR_LIGHT_DIRECTIONAL, LR_LIGHT_SPOT } lr_light_kind;

typedef struct lr_light {
    lr_light_kind kind;
    uint32_t line;
    lr_color color;
    double intensity;  /* at distance 1, for any falloff; 0..LR_COLOR_MAX */
    double falloff;    /* exponent of 1/distance; 0..16; 0 for directional */
    lr_vec3 position;  /* point, spot */
    lr_vec3 direction; /* directional, spot: the way the light travels; not zero */
    double angle;      /* spot: from the axis to the edge, 0 < angle <= 90; directional: that it
                          fills as seen from the scene, 0..180, for paths */
    double radius;     /* point, spot: of the ball that shines, for paths; 0: a point */
    double inner;      /* spot: from the axis to where the light begins to fade, <= angle */
    bool shadows;
} lr_light;

bool lr_light_is_black(const lr_light *light);

typedef enum lr_projection { LR_PERSPECTIVE, LR_ORTHOGRAPHIC, LR_PANORAMA } lr_projection;

typedef enum lr_background_kind {
    LR_BACKGROUND_GRADIENT, /* or one colour */
    LR_BACKGROUND_IMAGE,
    LR_BACKGROUND_SKY,
} lr_background_kind;

/* What is seen infinitely far away. */
typedef struct lr_background {
    lr_background_kind kind;
    lr_color colors[2]; /* gradient: looking along -up, looking along up; equal for one colour */
    uint32_t texture;   /* image: all directions, up at the top, -z in the middle if up is y */
    double intensity;   /* image, sky: a factor; 0..LR_COLOR_MAX */
    double rotate;      /* image: degrees about up, counter-clockwise as seen from above */
    lr_vec3 sun;        /* sky: where it stands, above the horizon; not of unit length */
    double turbidity;   /* sky: 1.7..10 */
    lr_color ground;    /* sky: the share of light that the ground reflects; 0..1 */
} lr_background;

typedef struct lr_camera {
    char *name; /* NULL for the only one */
    uint32_t line;
    lr_vec3 from, to, up; /* from != to, up not along the view */
    double fov;           /* vertical, 0 < fov < 180 */
    bool fov_to_centers;  /* fov ends at the centres of the outer rows of pixels, as in NFF */
    lr_projection projection;
    double height;   /* orthographic: of the picture; 0: what fov shows where `to` is */
    double aperture; /* diameter of the lens; 0: a pinhole, as all but perspective cameras are */
    double focus;    /* distance along the view that is sharp; 0: that of `to` */
    uint32_t blades; /* corners of the aperture, 3..32; 0: round */
    double blade_rotation; /* of the corner that else points up, clockwise in the picture */
    double shutter;        /* fraction of a frame that it is open */
    bool moves;            /* meanwhile; `closing` is where to */
    struct {
        lr_vec3 from, to, up;
        double fov, height;
    } closing;
} lr_camera;

struct lr_part;   /* part.h */
struct lr_retold; /* moment.h */

struct lr_scene {
    char *source;    /* the name that stands in messages */
    char sha256[65]; /* of the text */
    lr_camera *cameras;
    uint32_t camera_count; /* >= 1 */
    lr_material *materials;
    uint32_t material_count;
    lr_object *objects;
    uint32_t object_count; /* >= 1 */
    lr_mesh *meshes;
    uint32_t mesh_count;
    lr_texture *textures;
    uint32_t texture_count;
    struct lr_part **parts; /* what it shares with other scenes */
    uint32_t part_count;
    char **notes; /* what an import left out and why, one line each */
    uint32_t note_count;
    lr_light *lights; /* empty only when the scene says `lights: []` */
    uint32_t light_count;
    double frame;             /* in which values with keys are read */
    bool moves;               /* some value changes from frame to frame */
    bool things_move;         /* ... from this one on, beside those of cameras and the image, */
    double moves_from;        /* ... and in this frame the first of them begins to */
    uint64_t motion;          /* a hash of all that is keyed from this frame to the next */
    bool moment;              /* one of the moments that a picture is made of; moment.h */
    struct lr_retold *retold; /* NULL, or what its moments are read from */
    bool default_light;       /* no `lights` key: the renderer adds one that suits the camera */
    lr_color ambient;
    lr_background background;
    lr_vec3 background_up; /* unit */
    lr_color fog_color;
    double fog_density;                  /* per metre; 0: no fog */
    struct {                             /* outside of all media, only for paths; all 0: nothing */
        lr_color absorption, scattering; /* per metre */
        double anisotropy;               /* as lr_material has it */
    } air;
    struct {
        uint32_t width, height, samples; /* 1..32768, 1..32768, 0..65536; 0: as the
                                            integrator needs */
        uint32_t depth;                  /* 0..64 */
        uint32_t seed;
        double min_weight; /* 0..1 */
        double exposure;   /* stops, -64..64 */
        enum { LR_SCENE_WHITTED, LR_SCENE_PATH } integrator;
        enum { LR_SCENE_BOX, LR_SCENE_TENT, LR_SCENE_BLACKMAN_HARRIS } filter;
        lr_tone tone;
        double white; /* kelvin, LR_WHITE_MIN..LR_WHITE_MAX; 0: off */
    } image;
};

/* As the scene language calls it. */
const char *lr_object_kind_name(lr_object_kind kind);

/* Whether its normals are not those of the surface. */
bool lr_material_has_relief(const lr_material *material);

/* Whether it fills more than a point or a single direction. */
bool lr_light_is_soft(const lr_light *light);

/* The light of a scene that names none: from above and to the left of the camera. */
lr_light lr_default_light(const lr_camera *camera);

#endif
