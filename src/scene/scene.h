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
#define LR_OBJECTS_MAX 8192    /* every ray tests every object until there is a BVH */
#define LR_LIGHTS_MAX 256
#define LR_MATERIALS_MAX 65535

typedef enum lr_pattern_kind {
    LR_PATTERN_NONE, /* colors[0] everywhere */
    LR_PATTERN_CHECKER,
    LR_PATTERN_STRIPES,
    LR_PATTERN_GRADIENT,
    LR_PATTERN_RINGS,
} lr_pattern_kind;

typedef struct lr_pattern {
    lr_pattern_kind kind;
    bool object_space; /* follows the object's transform; otherwise fixed in the world */
    lr_color colors[2];
    double size;       /* of a checker's cell, a stripe, a ring; > 0 */
    lr_vec3 origin;    /* rings: centre; gradient: where colors[0] is */
    lr_vec3 direction; /* stripes: across them; rings: their axis; gradient: from origin to where
                          colors[1] is. Not zero. */
} lr_pattern;

typedef enum lr_highlight { LR_HIGHLIGHT_BLINN, LR_HIGHLIGHT_PHONG } lr_highlight;

typedef struct lr_material {
    char *name; /* NULL for one written inside an object */
    uint32_t line;
    lr_pattern color;
    lr_color ambient, diffuse, specular, reflect, transmit; /* defaults already filled in */
    double shininess;                                       /* 0..1e6 */
    lr_highlight highlight;
    double ior; /* 0.01..100 */
    bool fresnel;
    lr_color absorption; /* per metre, Beer-Lambert: exp(-absorption * distance) */
    int priority;        /* -100..100: which of two overlapping media fills the overlap */
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
} lr_object_kind;

typedef struct lr_object {
    lr_object_kind kind;
    uint32_t material;
    uint32_t line;
    bool shadow;           /* whether it casts shadows */
    bool open;             /* cylinder, cone: without end caps */
    bool transformed;      /* to_world is not the identity */
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
    double angle;      /* spot: from the axis to the edge, 0 < angle <= 90 */
    double inner;      /* spot: from the axis to where the light begins to fade, <= angle */
    bool shadows;
} lr_light;

typedef struct lr_camera {
    char *name; /* NULL for the only one */
    uint32_t line;
    lr_vec3 from, to, up; /* from != to, up not along the view */
    double fov;           /* vertical, 0 < fov < 180 */
} lr_camera;

struct lr_scene {
    char *source;    /* the name that stands in messages */
    char sha256[65]; /* of the text */
    lr_camera *cameras;
    uint32_t camera_count; /* >= 1 */
    lr_material *materials;
    uint32_t material_count;
    lr_object *objects;
    uint32_t object_count; /* >= 1 */
    lr_light *lights;      /* empty only when the scene says `lights: []` */
    uint32_t light_count;
    bool default_light; /* no `lights` key: the renderer adds one that suits the camera */
    lr_color ambient;
    lr_color background[2]; /* looking along -up, looking along up; equal for a plain colour */
    lr_vec3 background_up;  /* unit */
    lr_color fog_color;
    double fog_density; /* per metre; 0: no fog */
    struct {
        uint32_t width, height, samples; /* 1..32768, 1..32768, 1..65536 */
        uint32_t depth;                  /* 0..64 */
        uint32_t seed;
        double min_weight; /* 0..1 */
        double exposure;   /* stops, -64..64 */
    } image;
};

#endif
