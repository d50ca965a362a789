/* lavaray: renders a scene to the same bytes on every Vulkan device.
 *
 * The library never prints, never exits and keeps no global state. Functions that can fail return
 * an lr_status and describe the cause in the lr_error they are given (which may be NULL). Destroy
 * functions accept NULL. Descriptor structs may be zeroed: zero means the default. */
#ifndef LAVARAY_H
#define LAVARAY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define LR_VERSION "0.1.0"

typedef enum lr_status {
    LR_OK = 0,
    LR_ERROR_ARGUMENT,    /* a value that the caller passed is out of range */
    LR_ERROR_SCENE,       /* the scene text is invalid; diagnostics tell where */
    LR_ERROR_DEVICE,      /* no usable Vulkan device, or it was lost */
    LR_ERROR_FILE,        /* a file could not be read or written */
    LR_ERROR_MEMORY,      /* out of memory, or over a stated limit */
    LR_ERROR_INTERRUPTED, /* the progress callback asked to stop */
} lr_status;

typedef struct lr_error {
    lr_status status;
    char message[1024];
} lr_error;

/* ---- Scenes ------------------------------------------------------------------------------- */

typedef struct lr_scene lr_scene;

/* What tells one state of a file from another; links are followed. All 0: there is no file. */
typedef struct lr_file_stamp {
    uint64_t device, inode, size;
    int64_t modified; /* nanoseconds since 1970 */
    bool young;       /* changed so shortly before that one more change may not show */
} lr_file_stamp;

typedef struct lr_file {
    char *path;
    lr_file_stamp stamp; /* as it was right before it was read */
} lr_file;

#define LR_FILES_MAX 4096

/* Files, each once, up to LR_FILES_MAX of them. Zeroed is empty; lr_file_list_free leaves it so. */
typedef struct lr_file_list {
    lr_file *files;
    uint32_t count, capacity;
} lr_file_list;

void lr_file_list_free(lr_file_list *list);

/* How scene files are read. What others made may name any file and claim any size. */
typedef struct lr_load_options {
    bool allow_path;        /* files may name files outside of the scene's folder */
    uint64_t max_triangles; /* of all meshes; 0: 100 million */
    uint64_t max_memory;    /* bytes for files and meshes, about; 0: 8 GiB */
    double frame;           /* in which values with keys are read */
    /* Called from time to time with what is being done and the fraction of it, 0 to 1; returning
     * false stops with LR_ERROR_INTERRUPTED. */
    bool (*progress)(void *user, const char *what, double fraction);
    void *user;
    /* NULL, or where loading adds the files that the scene consists of, as they were looked for:
     * also those that are not there, and also when it fails. */
    lr_file_list *files;
    /* NULL, or a scene whose meshes and textures are taken instead of being read again, where their
     * files are still the same. The scenes share them: either may be destroyed first, on any
     * thread. */
    const lr_scene *previous;
} lr_load_options;

/* Reads and checks the scene file at path ("-" is standard input): glTF, OBJ, PLY, STL and NFF by
 * their endings, everything else as the scene language. options may be NULL. On LR_ERROR_SCENE,
 * *report is the text of all errors, `file:line:col: message` each with its source line and a
 * caret; the caller frees it. Other failures, and what is wrong with the files of other programs,
 * are described in error and leave *report NULL. One file of another program at a time: the library
 * that reads them has one place for its messages. */
lr_status lr_scene_load(const char *path, const lr_load_options *options, lr_scene **scene,
                        char **report, lr_error *error);

/* The same from a text of the scene language in memory; name stands in the messages for the file,
 * and files that the text names are looked for in its folder. */
lr_status lr_scene_parse(const char *text, size_t length, const char *name, lr_scene **scene,
                         char **report, lr_error *error);
void lr_scene_destroy(lr_scene *scene);

/* How light becomes a colour that a screen can show: as it is, clipped at 1; by Reinhard's formula
 * for each channel, with 4 as white; as in ACES 1.0, by Stephen Hill's fit; as in AgX. */
typedef enum lr_tone { LR_TONE_NONE, LR_TONE_REINHARD, LR_TONE_ACES, LR_TONE_AGX } lr_tone;

/* As flags and the scene language call it; NULL: there is no such tone map. */
const char *lr_tone_name(lr_tone tone);

typedef struct lr_scene_info {
    uint32_t objects, lights, materials, cameras;
    float exposure;  /* image.exposure, in stops */
    lr_tone tone;    /* image.tone */
    float white;     /* image.white, in kelvin; 0: off */
    char sha256[65]; /* of the file, as 64 hexadecimal digits */
    uint32_t meshes;
    uint64_t triangles;       /* of the meshes, each counted once */
    const char *const *notes; /* what was left out of other programs' files, and why; the scene's */
    uint32_t note_count;
    bool moves; /* some value has keys: frames differ */
    bool blurs; /* not only cameras move while the shutter of one of them is open */
} lr_scene_info;

void lr_scene_get_info(const lr_scene *scene, lr_scene_info *info);

#define LR_OBJECT_KINDS 9

/* What a scene holds and takes. */
typedef struct lr_scene_facts {
    struct {
        const char *name; /* as the scene language calls them */
        uint32_t count;
    } objects[LR_OBJECT_KINDS];
    uint32_t point_lights, directional_lights, spot_lights; /* written, not added */
    uint64_t vertices, triangles;                           /* of the meshes, each counted once */
    uint64_t shown_triangles;                               /* ... as often as objects show them */
    uint32_t textures;
    uint64_t texels;
    bool bounded;          /* there are bounded objects: all but planes */
    double min[3], max[3]; /* of these, in the world */
    uint64_t bytes;        /* of all arrays, in host memory */
    /* Of all that shapes the picture; docs/info.md has the order. The same numbers on two machines
     * have the same hash, whatever library read them. */
    char sha256[65];
} lr_scene_facts;

void lr_scene_get_facts(const lr_scene *scene, lr_scene_facts *facts);

#define LR_NO_INDEX UINT32_MAX /* in place of the number of an object, a ray, ... */

/* What stands in the scene's text about an object, a material, a light. Numbers begin at 0; strings
 * live as long as the scene. Lines are those of the scene's file, 0 where it has none. */
typedef struct lr_object_info {
    const char *kind; /* as the scene language calls it */
    const char *mesh; /* of a mesh the file and the part of it; NULL */
    uint32_t line, material;
} lr_object_info;

typedef struct lr_material_info {
    const char *name; /* NULL for one without */
    uint32_t line;
    double ambient[3], diffuse[3], specular[3], reflect[3], transmit[3]; /* without the colour */
    double shininess, ior;
    bool phong, fresnel;
} lr_material_info;

typedef struct lr_light_info {
    const char *kind; /* as the scene language calls it */
    uint32_t line;
    double color[3], intensity, falloff;
    bool shadows;
    bool added; /* the scene has no lights, so this one suits the camera */
} lr_light_info;

/* False when there is none of this number. */
bool lr_scene_get_object(const lr_scene *scene, uint32_t index, lr_object_info *info);
bool lr_scene_get_material(const lr_scene *scene, uint32_t index, lr_material_info *info);
bool lr_scene_get_light(const lr_scene *scene, uint32_t index, lr_light_info *info);

/* The name of a camera, NULL for the only one of a scene. */
const char *lr_scene_camera_name(const lr_scene *scene, uint32_t index);

/* The languages that scenes are written in: ours, and those of POV-Ray 3.7 and Tachyon. */
typedef enum lr_scene_format {
    LR_SCENE_YAML,
    LR_SCENE_POVRAY,
    LR_SCENE_TACHYON,
} lr_scene_format;

/* The language that a path's ending names (.yaml .yml, .pov, .dat .tac), false when it names none.
 */
bool lr_scene_format_from_path(const char *path, lr_scene_format *format);

/* Writes the scene to path. Meshes and pictures of LR_SCENE_YAML go into files beside it: PATH
 * without its ending and with -1.ply, -2.ply, -1.png, ... behind; they replace files of these names
 * only if path is replaced as well. What the language cannot say is told in *notes, one line each,
 * which the caller frees; NULL: nothing. Files are replaced only after their successors are
 * complete. */
lr_status lr_scene_write(const lr_scene *scene, const char *path, lr_scene_format format,
                         char **notes, lr_error *error);

/* The JSON Schema of the scene language; the caller frees it. NULL when memory is out. */
char *lr_scene_schema(void);

/* ---- Devices ------------------------------------------------------------------------------ */

typedef struct lr_device_info {
    char name[256];
    char driver[256]; /* driver name and version as the driver states them */
    uint32_t api_version;
    bool software;     /* a CPU implementation such as lavapipe */
    bool usable;       /* offers everything that lavaray needs */
    char missing[256]; /* what it lacks when it is not usable */
} lr_device_info;

/* Lists all Vulkan devices; *devices is freed by the caller. LR_ERROR_DEVICE when there is no
 * loader or no driver; the message says which, and the Debian package that brings it. */
lr_status lr_device_list(lr_device_info **devices, uint32_t *count, lr_error *error);

typedef struct lr_device lr_device;

typedef struct lr_device_desc {
    const char *select; /* "auto" (default: a GPU before a CPU), "cpu", "gpu", an index, a name */
    bool validation;    /* enable the Khronos validation layer, if it is installed */
} lr_device_desc;

lr_status lr_device_open(const lr_device_desc *desc, lr_device **device, lr_error *error);
void lr_device_close(lr_device *device);
const lr_device_info *lr_device_get_info(const lr_device *device);

/* The number of validation messages so far; always 0 without validation. The first message is
 * copied to text (at most size bytes) when there is one. */
uint32_t lr_device_validation_messages(const lr_device *device, char *text, size_t size);

/* Whether the device passes the arithmetic self-test that the exact promise rests on. */
bool lr_device_is_exact(const lr_device *device);

/* ---- Pictures ----------------------------------------------------------------------------- */

/* Linear RGB, float32, top row first. */
typedef struct lr_picture {
    uint32_t width, height;
    float *pixels; /* 3 * width * height */
} lr_picture;

void lr_picture_free(lr_picture *picture);

/* SHA-256 over width, height (uint32) and the pixels (float32), all little-endian, -0 written as
 * +0, as 64 lower-case hexadecimal digits. */
void lr_picture_hash(const lr_picture *picture, char hash[65]);

typedef enum lr_transfer { LR_TRANSFER_SRGB, LR_TRANSFER_LINEAR } lr_transfer;
typedef enum lr_format { LR_FORMAT_PPM, LR_FORMAT_PNG, LR_FORMAT_PFM, LR_FORMAT_EXR } lr_format;

/* What a picture file says beside its pixels. Keys have 1 to 31 printable ASCII characters without
 * spaces, and are none of EXR's own attributes. */
typedef struct lr_text {
    const char *key, *value;
} lr_text;

/* What an EXR holds of the same pixels beside the picture: a channel NAME.C for each letter C of
 * `channels`, such as "RGB" or "XYZ", or for "" one channel called NAME. Layers have 32 bits also
 * where the picture has 16. */
typedef struct lr_layer {
    const char *name; /* 2 to 29 printable ASCII characters without spaces and dots; each once */
    const char *channels;
    const void *samples; /* floats, or uint32_t; channels * width * height, top row first */
    bool integers;       /* the samples are uint32_t */
    bool light;          /* "RGB" floats that white balance and exposure change as the picture */
} lr_layer;

#define LR_WHITE_MIN 1667 /* kelvin */
#define LR_WHITE_MAX 25000

typedef struct lr_encoding {
    lr_format format;
    uint32_t maxval; /* PPM: 1..65535, PNG: 255 or 65535; 0 means 255. PFM and EXR have none. */
    lr_transfer transfer; /* PFM and EXR are always linear, */
    lr_tone tone;         /* ... and never tone-mapped */
    float exposure;       /* in stops; the pixels are multiplied by 2^exposure */
    float white;          /* kelvin: light of this colour temperature becomes white; 0: off */
    bool half;            /* EXR: 16-bit floats, those above 65504 become 65504; otherwise 32-bit */
    const lr_text *texts; /* PNG: text chunks, EXR: string attributes; PPM and PFM carry none */
    uint32_t text_count;
    const lr_layer *layers; /* EXR alone */
    uint32_t layer_count;
} lr_encoding;

/* The format that a path's ending names (.ppm .png .pfm .exr), false when it names none. */
bool lr_format_from_path(const char *path, lr_format *format);

/* Writes the picture to path, or to standard output when path is "-". A regular file is replaced
 * only after its successor is complete. */
lr_status lr_picture_write(const lr_picture *picture, const char *path, const lr_encoding *encoding,
                           lr_error *error);

/* ---- Denoising -----------------------------------------------------------------------------
 *
 * By Intel's Open Image Denoise, where it is installed (libOpenImageDenoise.so.2, .1 or .0). What
 * it makes of a picture is not covered by the promise of equal bytes. */

typedef struct lr_denoiser lr_denoiser;

/* LR_ERROR_FILE: the library is not there or not complete; LR_ERROR_DEVICE: it refuses this
 * computer. It stays loaded until the program ends. */
lr_status lr_denoiser_open(lr_denoiser **denoiser, lr_error *error);
void lr_denoiser_close(lr_denoiser *denoiser);

/* "Open Image Denoise 2.3.0" */
const char *lr_denoiser_name(const lr_denoiser *denoiser);

typedef struct lr_denoise_options {
    /* NULL, or what the same pixels show first: 3 * width * height floats each, top row first. They
     * keep textures and edges sharp. Normals need albedo beside them. */
    const float *albedo, *normal; /* 0 to 1; unit vectors */
    /* As in lr_render_options; may be called on another thread. */
    bool (*progress)(void *user, double fraction);
    void *user;
} lr_denoise_options;

/* Denoises light, so before white balance, exposure and tone map. options may be NULL. When it
 * fails the picture is as it was. */
lr_status lr_denoiser_run(lr_denoiser *denoiser, lr_picture *picture,
                          const lr_denoise_options *options, lr_error *error);

/* ---- Rendering ---------------------------------------------------------------------------- */

/* How light is found. */
typedef enum lr_integrator {
    LR_INTEGRATOR_DEFAULT, /* as the scene says */
    LR_INTEGRATOR_WHITTED, /* mirrors, glass and direct light: Whitted's ray trees, 1980 */
    LR_INTEGRATOR_PATH,    /* all ways of light, by chance: Kajiya's paths, 1986 */
} lr_integrator;

/* How samples weigh by their distance from the middle of the pixel: in each direction up to 0.5, 1
 * or 1.5 pixels away. */
typedef enum lr_filter {
    LR_FILTER_DEFAULT, /* as the scene says */
    LR_FILTER_BOX,
    LR_FILTER_TENT,
    LR_FILTER_BLACKMAN_HARRIS,
} lr_filter;

typedef struct lr_render_options {
    uint32_t width, height; /* 0: as the scene says */
    uint32_t samples;       /* per pixel; 0: as the scene says */
    int32_t depth;          /* bounces; with has_depth false: as the scene says */
    bool has_depth;
    uint32_t seed;
    bool has_seed;
    const char *camera; /* NULL: the scene's first */
    lr_integrator integrator;
    lr_filter filter;
    struct {
        uint32_t x, y, width, height; /* of the picture; width 0: all of it */
    } crop;
    /* Of the picture's samples only count from number `first` on; count 0: all. */
    struct {
        uint32_t first, count;
    } sample_range;
    /* 0, or how long the call may take: every pixel gets as many samples as fit, at least one and
     * at most `samples` (0: 65536). The picture is that of so many samples; stats->samples tells
     * how many. For LR_INTEGRATOR_PATH alone, whose first samples are those of any number, and
     * neither with sample_range nor checkpoint. */
    double seconds;
    /* 0, or how noisy the picture may be, in steps of 1e-6 up to 1: blocks of 16 x 16 pixels get no
     * more samples once an estimate of their noise, looked at when they have 16, 32, 64, ... of
     * them, is below that. `samples` (0: 65536) is the most that a pixel gets. 0.01 is about one of
     * 255 shades. Paths alone, and neither with seconds, sample_range nor checkpoint. */
    double noise;
    /* NULL, or a file that keeps what has been traced, now and then and when the render ends early,
     * so that a later call with the same scene and settings goes on from there. The caller deletes
     * it once the picture is safe. LR_ERROR_FILE when it is anything else already. */
    const char *checkpoint;
    double checkpoint_seconds; /* between two writings, at least; 0: 30 */
    /* How the work is cut up. The picture does not depend on these; zero picks good values. */
    uint32_t tile_size;  /* pixels along a tile's side */
    uint32_t chunk_rays; /* rays handed to the device at once */
    bool storage_loads;  /* read the scene through storage buffers, not texel buffers */
    bool single_rays;    /* every ray goes through the trees by itself, not in packets */
    uint32_t leaf_size;  /* most primitives in a leaf of a tree, 1 to 8 */
    uint32_t threads;    /* that build trees */
    /* Called between dispatches from the calling thread with the fraction done, 0 to 1; returning
     * false stops the render with LR_ERROR_INTERRUPTED. */
    bool (*progress)(void *user, double fraction);
    void *user;
} lr_render_options;

#define LR_SETTINGS_TEXT 512

typedef struct lr_render_stats {
    uint32_t width, height, samples, depth, seed;
    lr_integrator integrator;
    uint32_t first_sample, sample_count; /* of the samples: which were asked for */
    char settings[LR_SETTINGS_TEXT]; /* what the pixels depend on beside the scene, as files say it
                                      */
    uint32_t least_samples, most_samples; /* of any pixel: with noise they have different numbers */
    double mean_samples;
    double resumed;               /* the share of the samples that a checkpoint brought, 0 to 1 */
    char checkpoint_problem[256]; /* why the last checkpoint could not be written; "" */
    struct {
        uint64_t traced, hit;
    } primary, reflected, refracted, shadow, bounced; /* bounced: the later rays of paths */
    uint64_t passed;          /* crossings of surfaces hidden inside another medium */
    uint64_t dropped_depth;   /* rays not traced because the depth was used up */
    uint64_t dropped_weight;  /* ... because their weight was below min_weight */
    uint64_t dropped_nesting; /* ... or media lost because too many were nested */
    uint64_t non_finite;      /* contributions that were NaN or infinite, left out */
    uint64_t saturated;       /* contributions above the film's range, clipped to it */
    double device_seconds, build_seconds, upload_seconds, compile_seconds, trace_seconds,
        read_back_seconds;
    /* What all threads computed meanwhile, those of a software driver with them; trace_cpu_seconds
     * has the reading back in it. */
    double build_cpu_seconds, upload_cpu_seconds, compile_cpu_seconds, trace_cpu_seconds;
    double layers_seconds;       /* what lr_render_layers took once it had the picture */
    double longest_pass_seconds; /* the longest wait for the device; a watchdog may end long ones */
    char hash[65];               /* of the picture; see lr_picture_hash */
} lr_render_stats;

/* Renders the scene; the caller frees *picture. stats may be NULL. */
lr_status lr_render(lr_device *device, const lr_scene *scene, const lr_render_options *options,
                    lr_picture *picture, lr_render_stats *stats, lr_error *error);

/* What lr_render_layers tells of a picture's pixels beside their light. What is seen is what the
 * camera's rays meet first: mirrors and glass, not what shows in them. */
typedef enum lr_aov {
    LR_AOV_ALBEDO,   /* RGB: the share of light that comes back or through, at most 1 */
    LR_AOV_NORMAL,   /* XYZ: the mean of unit vectors that face the camera, in the world */
    LR_AOV_DEPTH,    /* metres along the ray, the mean of the samples that meet something; else 0 */
    LR_AOV_POSITION, /* XYZ: in the world; likewise */
    LR_AOV_ALPHA,    /* the share of the samples that meet something */
    LR_AOV_ID,       /* uint32_t: the object in the middle of the pixel, counted from 1; else 0 */
    LR_AOV_DIRECT,   /* RGB: the picture with depth 0 */
    LR_AOV_INDIRECT, /* RGB: the rest of it */
    LR_AOV_VARIANCE, /* RGB: of the pixel, as far as its samples tell */
    LR_AOV_SAMPLES,  /* uint32_t: of the pixel */
    LR_AOV_COUNT
} lr_aov;

/* As flags and files call it, such as "albedo"; NULL: there is none of this number. */
const char *lr_aov_name(uint32_t aov);

typedef struct lr_layers {
    lr_layer layers[LR_AOV_COUNT]; /* as lr_encoding takes them, in the order of lr_aov */
    uint32_t count;
} lr_layers;

void lr_layers_free(lr_layers *layers);

/* Renders the scene as lr_render does, and the layers whose bits 1 << lr_aov are in `wanted`, which
 * are as exact as the picture. The caller frees *picture and *layers. LR_ERROR_ARGUMENT: a layer
 * does not go with the options; none goes with sample_range and checkpoint. The rays in the
 * statistics are the picture's. */
lr_status lr_render_layers(lr_device *device, const lr_scene *scene,
                           const lr_render_options *options, uint32_t wanted, lr_picture *picture,
                           lr_layers *layers, lr_render_stats *stats, lr_error *error);

/* Renders the scene as lr_render does and writes the exact sums of its pixels to path: a part, for
 * lr_merge_parts. It is an EXR file; docs/parts.md has its channels. */
lr_status lr_render_part(lr_device *device, const lr_scene *scene, const lr_render_options *options,
                         const char *path, lr_render_stats *stats, lr_error *error);

/* A picture made of parts. */
typedef struct lr_merge_info {
    char scene_hash[65]; /* of the scene's text, as in lr_scene_info; of the first part's */
    char settings[LR_SETTINGS_TEXT]; /* as in lr_render_stats */
    char missing[200];               /* samples that no part has, such as "16-31, 48"; "" */
    char hash[65];                   /* of the picture; see lr_picture_hash */
    float exposure, white;           /* image.exposure and image.white of the scene, */
    lr_tone tone;                    /* ... and image.tone */
    uint32_t samples;                /* of all parts together */
} lr_merge_info;

/* Adds up the parts at these paths, in any order; the picture has the pixels that lr_render makes
 * of all samples. The caller frees it. LR_ERROR_FILE when a file cannot be read or is no part, when
 * parts belong to different pictures, or have samples in common; without `partial` also when
 * samples are missing. info may be NULL. */
lr_status lr_merge_parts(const char *const *paths, uint32_t count, bool partial,
                         lr_picture *picture, lr_merge_info *info, lr_error *error);

/* ---- Explaining a pixel --------------------------------------------------------------------
 *
 * The tree of rays behind one sample of a pixel, noted by the kernels that make the picture, so all
 * floats are the device's own. Positions and directions are in the world, lengths in metres,
 * colours linear RGB. Light that reaches the pixel is counted in steps of 2^-36, the picture's own:
 * sums of steps are exact (modulo 2^64, where light beyond the picture's range is summed up). */

typedef enum lr_ray_kind {
    LR_RAY_CAMERA,
    LR_RAY_REFLECTED,
    LR_RAY_REFRACTED, /* through a thin sheet, too, which bends nothing */
    LR_RAY_ONWARD,    /* its parent, behind a surface that is not there for it */
} lr_ray_kind;

typedef enum lr_ray_cut {
    LR_CUT_NONE,
    LR_CUT_DEPTH,  /* not traced: the bounces are used up */
    LR_CUT_WEIGHT, /* ... its weight is below min_weight */
} lr_ray_cut;

/* Something on the way of light. */
typedef struct lr_explained_obstacle {
    uint32_t object;
    float distance; /* from where the light would fall */
    float left[3];  /* share that it lets through */
} lr_explained_obstacle;

/* The light of one source where a ray meets a surface. */
typedef struct lr_explained_light {
    uint32_t light;
    float origin[3];   /* where it falls, a little off the surface */
    float wi[3];       /* unit, towards the source */
    float distance;    /* to it; of directional light 0 */
    float attenuation; /* 1 / distance^falloff */
    float spot;        /* share within the cone of a spot light, else 1 */
    float cosine;      /* cos theta, between the normal and wi; nothing falls there if it is < 0 */
    float highlight;   /* (h . n)^shininess or Phong's; 0 without specular */
    float arriving[3]; /* color * intensity * attenuation * spot */
    float unshadowed[3]; /* what it brings to the pixel if nothing stands in the way */
    bool tested;         /* that is a step or more, and so what stands in the way was looked for */
    float left[3];       /* share that comes through all of that */
    uint32_t first_obstacle, obstacle_count; /* nearest first */
    uint64_t steps[3];                       /* what it brings */
} lr_explained_light;

typedef struct lr_explained_ray {
    uint32_t parent; /* LR_NO_INDEX: none */
    lr_ray_kind kind;
    lr_ray_cut cut;  /* if any, `steps` and all behind `weight` are zero */
    uint32_t depth;  /* bounces from the camera to here */
    uint32_t passed; /* surfaces from the camera to here that were not there for it */
    float origin[3], direction[3], weight[3];

    float t;               /* where it meets a surface; 1e15: nowhere */
    uint32_t medium;       /* the object inside of which it runs; LR_NO_INDEX: none */
    float weight_there[3]; /* after fog or absorption */
    float fog[3];          /* light */
    uint64_t fog_steps[3];

    uint32_t object;     /* LR_NO_INDEX: it sees the background */
    uint32_t triangle;   /* number in the mesh; LR_NO_INDEX */
    float background[3]; /* light */
    float position[3];
    float normal[3];               /* geometric, unit, outward */
    float lit_by[3];               /* the normal that light falls by, against the ray */
    float cosine;                  /* between that and the way back: the sheet's c1 */
    float color[3];                /* of the material there */
    bool entering;                 /* from outside */
    bool lit;                      /* the material shows light: `lights` were asked */
    bool hidden;                   /* the surface is not there: another medium is on both sides, */
    bool hole;                     /* ... or its picture is transparent there */
    bool lost;                     /* more media, or hidden surfaces, than are kept track of */
    float ambient[3], emission[3]; /* light */
    uint64_t own_steps[3];         /* background; ambient and emission */
    uint32_t first_light, light_count;

    /* Only in scenes where something reflects, transmits or has holes: */
    bool bends;             /* what goes through is refracted, */
    bool total;             /* ... or not: total internal reflection */
    bool fresnel;           /* the material's reflectance depends on the angle */
    uint32_t medium_beyond; /* object, or LR_NO_INDEX */
    float ior, ior_beyond;  /* the sheet's gamma 1 and 2 */
    float refracted_cosine; /* the sheet's c2 */
    float reflectance;      /* by Fresnel's equations */
    float reflect_weight[3], transmit_weight[3]; /* of the children */

    uint64_t steps[3]; /* what the ray and all its children bring */
} lr_explained_ray;

typedef struct lr_explanation {
    uint32_t width, height, x, y;
    uint32_t sample, samples, depth, seed;
    /* The camera's ray first, then each behind its parent, reflected rays and all that comes from
     * them before refracted ones. */
    lr_explained_ray *rays;
    uint32_t ray_count;
    lr_explained_light *lights;
    uint32_t light_count;
    lr_explained_obstacle *obstacles;
    uint32_t obstacle_count;
    uint64_t sample_steps[3]; /* what the sample brings: the camera ray's steps */
    uint64_t total_steps[3];  /* all samples */
    bool saturated;           /* a channel of them left the picture's range */
    float pixel[3];           /* their mean, as lr_render gives it */
} lr_explanation;

/* Explains sample `sample` of pixel x, y of the picture that lr_render makes with these options
 * (but for the crop). LR_ERROR_ARGUMENT: there is no such pixel or sample; LR_ERROR_MEMORY: the
 * tree has more than some 16,000 rays or 65,000 lights or obstacles. */
lr_status lr_explain(lr_device *device, const lr_scene *scene, const lr_render_options *options,
                     uint32_t x, uint32_t y, uint32_t sample, lr_explanation *explanation,
                     lr_error *error);
void lr_explanation_free(lr_explanation *explanation);

#endif
