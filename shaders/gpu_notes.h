/* The part of gpu_layout.h that kernels which explain write down, of one pixel.
 * A note's number is 1 + its index, 0 is none. The last of each kind is for all that have no room.
 */
#ifndef LR_GPU_NOTES_H
#define LR_GPU_NOTES_H

#define LR_NOTED_RAYS 16384
#define LR_NOTED_LIGHTS 65536
#define LR_NOTED_OBSTACLES 65536
#define LR_NOTED_HITS 4096 /* most rays of a pass */

#define LR_NOTE_ENTERING 1u /* the ray comes from outside */
#define LR_NOTE_LIT 2u      /* the material shows light */
#define LR_NOTE_BENDS 4u    /* what goes through is refracted */
#define LR_NOTE_TOTAL 8u    /* ... and there is total internal reflection */
#define LR_NOTE_FRESNEL 16u
#define LR_NOTE_HIDDEN 32u /* another medium fills the space on both sides */
#define LR_NOTE_HOLE 64u
#define LR_NOTE_LOST                                                                               \
    128u /* more nested media, or hidden surfaces passed, than are kept track of                   \
          */
#define LR_NOTE_REFLECTED_SHIFT 8  /* LR_FATE_* of the reflected ray, */
#define LR_NOTE_REFRACTED_SHIFT 10 /* of the refracted one */
#define LR_FATE_NONE 0u            /* its weight is 0 */
#define LR_FATE_TRACED 1u
#define LR_FATE_TOO_DEEP 2u
#define LR_FATE_TOO_WEAK 3u

/* Steps: low and high word of red, green and blue, as in the film. */
struct gpu_ray_note {
    vec3 origin;
    uint parent; /* the note of the ray that it comes from */
    vec3 direction;
    uint state; /* as gpu_ray's */
    vec3 weight;
    float t;           /* LR_T_MAX: it meets nothing */
    vec3 weight_there; /* behind fog and absorption */
    uint primitive;
    vec3 fog;    /* the light that it brings */
    uint medium; /* rank of what it goes through */
    uint fog_steps[6];
    uint own_steps[6]; /* background; ambient and emitted light */
    vec3 background;
    uint object; /* from here on of what it meets */
    vec3 position;
    uint flags;             /* LR_NOTE_* */
    vec3 normal;            /* geometric, outward */
    uint medium_beyond;     /* rank */
    vec3 lit_by;            /* normal that it is lit and mirrors by, against the ray */
    float cosine;           /* between that and the way back, the sheet's c1 */
    vec3 color;             /* of the material here */
    float refracted_cosine; /* the sheet's c2 */
    vec3 ambient;           /* light */
    float ior;
    vec3 emission; /* light */
    float ior_beyond;
    vec3 reflect_weight;
    float reflectance; /* by Fresnel's equations */
    vec3 transmit_weight;
    uint unused0;
    vec3 reflected; /* directions, unit */
    uint unused1;
    vec3 refracted;
    uint unused2;
};
LR_ROWS(gpu_ray_note, 19)

struct gpu_light_note {
    vec3 origin; /* where the light may fall */
    uint ray;    /* the note of the ray that met the surface there */
    vec3 wi;     /* towards the light */
    uint light;
    vec3 arriving; /* its colour there, without shadows */
    float distance;
    vec3 value; /* of that what reaches the pixel, without shadows */
    float cosine;
    vec3 left; /* share that arrives through what stands in the way */
    float highlight;
    float attenuation; /* 1 / distance^falloff */
    float spot;        /* share within a spot light's cone */
    uint reaches;      /* 1: value is worth a shadow ray */
    uint unused;
    uint steps[6];
    uint unused0;
    uint unused1;
};
LR_ROWS(gpu_light_note, 8)

struct gpu_obstacle_note {
    vec3 left;  /* share of the light that it lets through */
    uint light; /* the note of the light that it meets */
    float t0;   /* where, in metres from the surface; what is not on the way counts for nothing */
    float t1;
    uint object;
    uint unused;
};
LR_ROWS(gpu_obstacle_note, 2)

#ifdef __STDC__
typedef struct gpu_ray_note gpu_ray_note;
typedef struct gpu_light_note gpu_light_note;
typedef struct gpu_obstacle_note gpu_obstacle_note;
#endif

struct gpu_notes {
    uint rays; /* how many there would be */
    uint lights;
    uint obstacles;
    uint unused;
    uint of_hit[LR_NOTED_HITS]; /* the note of the ray of each hit of this pass */
    gpu_ray_note ray[LR_NOTED_RAYS];
    gpu_light_note light[LR_NOTED_LIGHTS];
    gpu_obstacle_note obstacle[LR_NOTED_OBSTACLES];
};

#endif
