/* The keys of all but materials. */
#include "scene/keys_table.h"

/* ---- Camera, image, surroundings ----------------------------------------------------------- */

static const char *const projections[] = {"perspective", "orthographic", "panorama", NULL};
static const lr_field camera_fields[] = {
    {"from", LR_FIELD_VECTOR, 0, COORDINATE, DEFAULT(0, 1, 5), MEMBER(lr_camera, from),
     .doc = "Where the eye is."},
    {"to", LR_FIELD_VECTOR, 0, COORDINATE, DEFAULT(0, 0, 0), MEMBER(lr_camera, to),
     .doc = "The point in the middle of the picture."},
    {"up", LR_FIELD_VECTOR, LR_NONZERO | LR_DERIVED, COORDINATE, MEMBER(lr_camera, up),
     .derived = "the scene's `up`", .doc = "The direction that is up in the picture."},
    {"fov", LR_FIELD_NUMBER, LR_ABOVE | LR_BELOW, RANGE(0, 180), DEFAULT(40),
     MEMBER(lr_camera, fov), .doc = "Vertical field of view in degrees."},
    {"fov_to_centers", LR_FIELD_BOOLEAN, 0, DEFAULT(0), MEMBER(lr_camera, fov_to_centers),
     .doc = "The field of view ends in the middle of the outer rows of pixels, as in NFF, not at "
            "their edges."},
    {"projection", LR_FIELD_CHOICE, 0, DEFAULT(0), MEMBER(lr_camera, projection),
     .choices = projections,
     .doc = "How directions become places: from a point, along parallels, or all of them around."},
    {"height", LR_FIELD_NUMBER, 0, RANGE(0, LR_COORDINATE_MAX), DEFAULT(0),
     MEMBER(lr_camera, height),
     .doc = "Orthographic: the height of what the picture shows; 0: what `fov` shows at `to`."},
    {"aperture", LR_FIELD_NUMBER, 0, RANGE(0, LR_COORDINATE_MAX), DEFAULT(0),
     MEMBER(lr_camera, aperture),
     .doc = "Diameter of the lens; the wider, the less depth is sharp. 0: all of it."},
    {"focus", LR_FIELD_NUMBER, 0, RANGE(0, LR_COORDINATE_MAX), DEFAULT(0), MEMBER(lr_camera, focus),
     .doc = "Distance along the view at which a lens is sharp; 0: that of `to`."},
    {"blades", LR_FIELD_INTEGER, 0, RANGE(0, 32), DEFAULT(0), MEMBER(lr_camera, blades),
     .doc = "Corners of the lens's opening, 3 or more; 0: round."},
    {"blade_rotation", LR_FIELD_NUMBER, 0, RANGE(-1e6, 1e6), DEFAULT(0),
     MEMBER(lr_camera, blade_rotation),
     .doc = "Degrees, clockwise in the picture; at 0 a corner points up."},
    {"shutter", LR_FIELD_NUMBER, 0, RANGE(0, 1), DEFAULT(0), MEMBER(lr_camera, shutter),
     .doc = "Fraction of a frame that the shutter is open: how far what moves is blurred."},
};
const lr_record lr_camera_record =
    RECORD("camera", "Where the picture is taken from.", camera_fields, 0);

static const char *const filters[] = {"box", "tent", "blackman-harris", NULL};
static const char *const integrators[] = {"whitted", "path", NULL};
static const char *const tones[] = {"none", "reinhard", "aces", "agx", NULL};

static const lr_field image_fields[] = {
    {"width", LR_FIELD_INTEGER, 0, RANGE(1, 32768), DEFAULT(640), MEMBER(lr_scene, image.width),
     .doc = "Width in pixels."},
    {"height", LR_FIELD_INTEGER, 0, RANGE(1, 32768), DEFAULT(480), MEMBER(lr_scene, image.height),
     .doc = "Height in pixels."},
    {"samples", LR_FIELD_INTEGER, LR_DERIVED, RANGE(1, 65536), MEMBER(lr_scene, image.samples),
     .derived = "1; with `integrator: path` 64",
     .doc = "Rays through each pixel; more give smoother edges and, of paths, less noise."},
    {"depth", LR_FIELD_INTEGER, 0, RANGE(0, 64), DEFAULT(6), MEMBER(lr_scene, image.depth),
     .doc = "Bounces: how often a ray may be reflected or refracted; 0 is only what the eye sees."},
    {"seed", LR_FIELD_INTEGER, 0, RANGE(0, 4294967295.0), DEFAULT(0), MEMBER(lr_scene, image.seed),
     .doc = "Another seed, another choice of sample positions."},
    {"min_weight", LR_FIELD_NUMBER, 0, RANGE(0, 1), DEFAULT(0), MEMBER(lr_scene, image.min_weight),
     .doc = "Rays whose weight in the pixel is below this are not traced."},
    {"exposure", LR_FIELD_NUMBER, 0, RANGE(-64, 64), DEFAULT(0), MEMBER(lr_scene, image.exposure),
     .doc = "Stops: the picture is written 2^exposure times as bright."},
    {"integrator", LR_FIELD_CHOICE, 0, DEFAULT(0), MEMBER(lr_scene, image.integrator),
     .choices = integrators,
     .doc = "How light is found: mirrors, glass and direct light, or all of its ways by chance."},
    {"filter", LR_FIELD_CHOICE, 0, DEFAULT(0), MEMBER(lr_scene, image.filter), .choices = filters,
     .doc = "How samples weigh by their distance from the middle of the pixel."},
    {"tone", LR_FIELD_CHOICE, 0, DEFAULT(0), MEMBER(lr_scene, image.tone), .choices = tones,
     .doc = "How light becomes a colour of PPM and PNG files; none clips it at 1."},
    {"white", LR_FIELD_NUMBER, LR_DERIVED, RANGE(LR_WHITE_MIN, LR_WHITE_MAX),
     MEMBER(lr_scene, image.white), .derived = "off",
     .doc = "White balance: light of this colour temperature, in kelvin, becomes white."},
};
const lr_record lr_image_record = RECORD("image", "The picture to be made.", image_fields, 0);

static const lr_field fog_fields[] = {
    {"color", LR_FIELD_COLOR, 0, COLOR, DEFAULT(0.5, 0.5, 0.5), MEMBER(lr_scene, fog_color),
     .doc = "What distance fades to."},
    {"density", LR_FIELD_NUMBER, LR_REQUIRED, RANGE(0, LR_COLOR_MAX), MEMBER(lr_scene, fog_density),
     .doc = "Per metre: exp(-density * distance) of what lies behind is still seen."},
};
const lr_record lr_fog_record = RECORD("fog", "Fog outside of all objects.", fog_fields, 0);

static const lr_field air_fields[] = {
    {"absorption", LR_FIELD_COLOR, 0, COLOR, DEFAULT(0), MEMBER(lr_scene, air.absorption),
     .doc = "Per metre: what is left is exp(-absorption * distance)."},
    {"scattering", LR_FIELD_COLOR, 0, COLOR, DEFAULT(0), MEMBER(lr_scene, air.scattering),
     .doc = "Per metre: light that goes on in another direction."},
    {"anisotropy", LR_FIELD_NUMBER, 0, RANGE(-0.95, 0.95), DEFAULT(0),
     MEMBER(lr_scene, air.anisotropy),
     .doc = "Which direction that is: back, below 0, evenly all around, or on, above 0."},
};
const lr_record lr_air_record =
    RECORD("air", "What fills the space outside of all objects, for paths.", air_fields, 0);

#define BACKGROUND(member) MEMBER(lr_background_draft, background.member)
#define BACKGROUND_INTENSITY                                                                       \
    {                                                                                              \
        "intensity", LR_FIELD_NUMBER, 0, RANGE(0, LR_COLOR_MAX), DEFAULT(1),                       \
            BACKGROUND(intensity), .doc = "Multiplies its light."                                  \
    }

static const lr_field gradient_background_fields[] = {
    {"gradient", LR_FIELD_COLORS, LR_REQUIRED, COLOR, BACKGROUND(colors),
     .doc = "Two colours: looking straight down and straight up."},
};
static const lr_field image_background_fields[] = {
    {"image", LR_FIELD_TEXT, LR_REQUIRED, MEMBER(lr_background_draft, image),
     .doc = "The file of a picture of all directions, as seen from the scene's folder."},
    BACKGROUND_INTENSITY,
    {"rotate", LR_FIELD_NUMBER, 0, RANGE(-1e6, 1e6), DEFAULT(0), BACKGROUND(rotate),
     .doc = "Degrees about `up`, counter-clockwise as seen from above."},
};
static const lr_field sky_fields[] = {
    {"sky", LR_FIELD_VECTOR, LR_REQUIRED | LR_NONZERO, COORDINATE, BACKGROUND(sun),
     .doc = "The direction towards the sun, above the horizon."},
    {"turbidity", LR_FIELD_NUMBER, 0, RANGE(1.7, 10), DEFAULT(3), BACKGROUND(turbidity),
     .doc = "Haze: 2 is very clear, 3 clear, 6 and more hazy."},
    {"ground", LR_FIELD_COLOR, 0, RANGE(0, 1), DEFAULT(0.2, 0.2, 0.2), BACKGROUND(ground),
     .doc = "Share of light that the ground below the horizon reflects."},
    BACKGROUND_INTENSITY,
};
const lr_record lr_background_records[] = {
    RECORD("gradient", "A blend from below to above.", gradient_background_fields,
           LR_BACKGROUND_GRADIENT),
    RECORD("image", "A picture all around.", image_background_fields, LR_BACKGROUND_IMAGE),
    RECORD("sky", "The sky by day.", sky_fields, LR_BACKGROUND_SKY),
};
const uint32_t lr_background_record_count = COUNT(lr_background_records);

/* ---- Lights -------------------------------------------------------------------------------- */

#define LIGHT_COLOR                                                                                \
    {                                                                                              \
        "color", LR_FIELD_COLOR, 0, COLOR, DEFAULT(1, 1, 1), MEMBER(lr_light_draft, light.color),  \
            .doc = "Colour of the light."                                                          \
    }
#define LIGHT_INTENSITY                                                                            \
    {                                                                                              \
        "intensity", LR_FIELD_NUMBER, 0, RANGE(0, LR_COLOR_MAX), DEFAULT(1),                       \
            MEMBER(lr_light_draft, light.intensity), .doc = "Brightness at distance 1."            \
    }
#define LIGHT_FALLOFF                                                                              \
    {                                                                                              \
        "falloff", LR_FIELD_NUMBER, 0, RANGE(0, 16), DEFAULT(2),                                   \
            MEMBER(lr_light_draft, light.falloff),                                                 \
            .doc = "Exponent: the light fades with 1 / distance^falloff."                          \
    }
#define LIGHT_SHADOWS                                                                              \
    {                                                                                              \
        "shadows", LR_FIELD_BOOLEAN, 0, DEFAULT(1), MEMBER(lr_light_draft, light.shadows),         \
            .doc = "Whether objects block this light."                                             \
    }
#define LIGHT_POSITION                                                                             \
    {                                                                                              \
        "position", LR_FIELD_VECTOR, LR_REQUIRED, COORDINATE,                                      \
            MEMBER(lr_light_draft, light.position), .doc = "Where the light is."                   \
    }

#define LIGHT_RADIUS                                                                               \
    {                                                                                              \
        "radius", LR_FIELD_NUMBER, 0, RANGE(0, LR_COORDINATE_MAX), DEFAULT(0),                     \
            MEMBER(lr_light_draft, light.radius),                                                  \
            .doc = "Of the ball that shines, for soft shadows; only paths see it."                 \
    }

static const lr_field point_fields[] = {
    LIGHT_POSITION, LIGHT_COLOR, LIGHT_INTENSITY, LIGHT_FALLOFF, LIGHT_RADIUS, LIGHT_SHADOWS,
};
static const lr_field directional_fields[] = {
    {"direction", LR_FIELD_VECTOR, LR_REQUIRED | LR_NONZERO, COORDINATE,
     MEMBER(lr_light_draft, light.direction), .doc = "The way the light travels."},
    {"angle", LR_FIELD_NUMBER, 0, RANGE(0, 180), DEFAULT(0), MEMBER(lr_light_draft, light.angle),
     .doc = "Degrees of the sky that the light fills, for soft shadows (the sun: 0.53); only paths "
            "see it."},
    LIGHT_COLOR,
    LIGHT_INTENSITY,
    LIGHT_SHADOWS,
};
static const lr_field spot_fields[] = {
    LIGHT_POSITION,
    {"to", LR_FIELD_VECTOR, LR_DERIVED, COORDINATE, MEMBER(lr_light_draft, to),
     .derived = "from `direction`", .doc = "A point on the axis; this or `direction`."},
    {"direction", LR_FIELD_VECTOR, LR_NONZERO | LR_DERIVED, COORDINATE,
     MEMBER(lr_light_draft, light.direction), .derived = "from `to`",
     .doc = "The way the light travels along the axis; this or `to`."},
    {"angle", LR_FIELD_NUMBER, LR_ABOVE, RANGE(0, 90), DEFAULT(30),
     MEMBER(lr_light_draft, light.angle), .doc = "Degrees from the axis to the edge."},
    {"inner", LR_FIELD_NUMBER, LR_DERIVED, RANGE(0, 90), MEMBER(lr_light_draft, light.inner),
     .derived = "0.8 * `angle`", .doc = "Degrees from the axis to where the light begins to fade."},
    LIGHT_COLOR,
    LIGHT_INTENSITY,
    LIGHT_FALLOFF,
    LIGHT_RADIUS,
    LIGHT_SHADOWS,
};
const lr_record lr_light_records[] = {
    RECORD("point", "Shines from a point in all directions.", point_fields, LR_LIGHT_POINT),
    RECORD("directional", "Shines from infinitely far away.", directional_fields,
           LR_LIGHT_DIRECTIONAL),
    RECORD("spot", "Shines from a point in a cone.", spot_fields, LR_LIGHT_SPOT),
};
const uint32_t lr_light_record_count = COUNT(lr_light_records);

/* ---- Objects ------------------------------------------------------------------------------- */

#define OBJECT(member) MEMBER(lr_object_draft, object.member)
/* Read into the draft, applied as translate * rotate * scale, or the matrix alone. */
#define TRANSFORM                                                                                  \
    {"scale",                                                                                      \
     LR_FIELD_SCALE,                                                                               \
     LR_NONZERO,                                                                                   \
     COORDINATE,                                                                                   \
     DEFAULT(1, 1, 1),                                                                             \
     MEMBER(lr_object_draft, scale),                                                               \
     .doc = "Factor, or one along each axis; about the origin; applied first."},                   \
        {"rotate",                                                                                 \
         LR_FIELD_ROTATE,                                                                          \
         0,                                                                                        \
         RANGE(-1e6, 1e6),                                                                         \
         DEFAULT(0, 0, 0),                                                                         \
         MEMBER(lr_object_draft, rotate),                                                          \
         .doc = "Degrees about x, then y, then z, or {axis, angle}; about the origin; second."},   \
        {"translate",                                                                              \
         LR_FIELD_VECTOR,                                                                          \
         0,                                                                                        \
         COORDINATE,                                                                               \
         DEFAULT(0, 0, 0),                                                                         \
         MEMBER(lr_object_draft, translate),                                                       \
         .doc = "Moves it; applied last."},                                                        \
    {                                                                                              \
        "matrix", LR_FIELD_MATRIX, LR_DERIVED, COORDINATE, MEMBER(lr_object_draft, matrix),        \
            .derived = "from the other three",                                                     \
            .doc = "Three rows of four numbers: any affine map, in place of the other three."      \
    }
#define PLACEMENT                                                                                  \
    {"material", LR_FIELD_MATERIAL, LR_DERIVED, .derived = "the group's, else grey",               \
     .doc = "The name of one of `materials`, or a material written here."},                        \
        {"shadow",   LR_FIELD_BOOLEAN, 0,                                                          \
         DEFAULT(1), OBJECT(shadow),   .doc = "Whether it casts shadows."},                        \
        TRANSFORM
#define POINT(name_, member_, doc_)                                                                \
    {                                                                                              \
        name_, LR_FIELD_VECTOR, LR_REQUIRED, COORDINATE, OBJECT(member_), .doc = (doc_)            \
    }
#define OPEN                                                                                       \
    {                                                                                              \
        "open", LR_FIELD_BOOLEAN, 0, DEFAULT(0), OBJECT(open), .doc = "Without the end caps."      \
    }

static const lr_field sphere_fields[] = {
    {"center", LR_FIELD_VECTOR, 0, COORDINATE, DEFAULT(0, 0, 0), OBJECT(sphere.center),
     .doc = "The centre."},
    {"radius", LR_FIELD_NUMBER, 0, LENGTH, DEFAULT(1), OBJECT(sphere.radius), .doc = "The radius."},
    PLACEMENT,
};
static const lr_field plane_fields[] = {
    {"normal", LR_FIELD_VECTOR, LR_NONZERO, COORDINATE, DEFAULT(0, 1, 0), OBJECT(plane.normal),
     .doc = "At right angles to the plane, away from the half-space it fills."},
    {"offset", LR_FIELD_NUMBER, 0, COORDINATE, DEFAULT(0), OBJECT(plane.offset),
     .doc = "The plane is where normal . p = offset."},
    PLACEMENT,
};
static const lr_field box_fields[] = {
    POINT("min", box.min, "The corner with the smallest coordinates."),
    POINT("max", box.max, "The corner with the largest coordinates."),
    PLACEMENT,
};
static const lr_field disk_fields[] = {
    {"center", LR_FIELD_VECTOR, 0, COORDINATE, DEFAULT(0, 0, 0), OBJECT(disk.center),
     .doc = "The centre."},
    {"normal", LR_FIELD_VECTOR, LR_NONZERO, COORDINATE, DEFAULT(0, 1, 0), OBJECT(disk.normal),
     .doc = "At right angles to the disk."},
    {"radius", LR_FIELD_NUMBER, 0, LENGTH, DEFAULT(1), OBJECT(disk.radius), .doc = "The radius."},
    PLACEMENT,
};
static const lr_field rectangle_fields[] = {
    POINT("corner", rectangle.corner, "One corner."),
    POINT("u", rectangle.u, "The edge from the corner to the next one."),
    POINT("v", rectangle.v, "The other edge from the corner."),
    PLACEMENT,
};
static const lr_field cylinder_fields[] = {
    POINT("from", cone.from, "The centre of one end."),
    POINT("to", cone.to, "The centre of the other end."),
    {"radius", LR_FIELD_NUMBER, 0, LENGTH, DEFAULT(1), OBJECT(cone.radius_from),
     .doc = "The radius."},
    OPEN,
    PLACEMENT,
};
static const lr_field cone_fields[] = {
    POINT("from", cone.from, "The centre of the base."),
    POINT("to", cone.to, "The tip, or the centre of the top."),
    {"radius", LR_FIELD_NUMBER, 0, RANGE(0, LR_COORDINATE_MAX), DEFAULT(1),
     OBJECT(cone.radius_from), .doc = "The radius at `from`."},
    {"top_radius", LR_FIELD_NUMBER, 0, RANGE(0, LR_COORDINATE_MAX), DEFAULT(0),
     OBJECT(cone.radius_to), .doc = "The radius at `to`; not 0 when `radius` is."},
    OPEN,
    PLACEMENT,
};
static const lr_field triangle_fields[] = {
    POINT("a", triangle.a, "A corner."),
    POINT("b", triangle.b, "The next, counter-clockwise as seen from the front."),
    POINT("c", triangle.c, "The last."),
    PLACEMENT,
};
static const lr_field mesh_fields[] = {
    {"file", LR_FIELD_TEXT, LR_REQUIRED | LR_DERIVED, MEMBER(lr_object_draft, file),
     .derived = "the path of a model, such as spot.obj",
     .doc = "A glTF, GLB, OBJ, PLY or STL file, as seen from the scene's folder."},
    {"material", LR_FIELD_MATERIAL, LR_DERIVED, .derived = "the group's, else the file's own",
     .doc = "For all that is in the file: the name of one of `materials`, or a material written "
            "here."},
    {"shadow", LR_FIELD_BOOLEAN, 0, DEFAULT(1), OBJECT(shadow), .doc = "Whether it casts shadows."},
    TRANSFORM,
};
const lr_record lr_object_records[] = {
    RECORD("sphere", "A ball.", sphere_fields, LR_SPHERE),
    RECORD("plane", "An endless plane.", plane_fields, LR_PLANE),
    RECORD("box", "A box along the axes.", box_fields, LR_BOX),
    RECORD("disk", "A flat round disk.", disk_fields, LR_DISK),
    RECORD("rectangle", "A flat parallelogram.", rectangle_fields, LR_RECTANGLE),
    RECORD("cylinder", "A round bar between two points.", cylinder_fields, LR_CYLINDER),
    RECORD("cone", "A cone, or a cut-off one with `top_radius`.", cone_fields, LR_CONE),
    RECORD("triangle", "A flat triangle.", triangle_fields, LR_TRIANGLE),
    RECORD("mesh", "The model in a file of another program.", mesh_fields, LR_MESH),
};
const uint32_t lr_object_record_count = COUNT(lr_object_records);

static const lr_field rotation_fields[] = {
    {"axis", LR_FIELD_VECTOR, LR_REQUIRED | LR_NONZERO, COORDINATE, MEMBER(lr_rotation_draft, axis),
     .doc = "What to turn about, through the origin."},
    {"angle", LR_FIELD_NUMBER, LR_REQUIRED, RANGE(-1e6, 1e6), MEMBER(lr_rotation_draft, angle),
     .doc = "Degrees, counter-clockwise as seen against the axis."},
};
const lr_record lr_rotation_record =
    RECORD("rotate", "A rotation about any axis.", rotation_fields, 0);

static const lr_field group_fields[] = {
    {"objects", LR_FIELD_OBJECTS, LR_REQUIRED, .doc = "The objects and groups in it."},
    {"material", LR_FIELD_MATERIAL, LR_DERIVED, .derived = "the group's around it, else grey",
     .doc = "For the objects in it that have none."},
    TRANSFORM,
};
const lr_record lr_group_record =
    RECORD("group", "Several objects that are moved together.", group_fields, -1);

/* ---- The scene ----------------------------------------------------------------------------- */

static const lr_field scene_fields[] = {
    {"lavaray", LR_FIELD_NUMBER, 0, RANGE(1, 1), DEFAULT(1), MEMBER(lr_scene_draft, version),
     .doc = "The version of the scene language."},
    {"camera", LR_FIELD_RECORD, LR_DERIVED, .record = &lr_camera_record,
     .derived = "required, unless there are `cameras`", .doc = "The only camera."},
    {"cameras", LR_FIELD_CAMERAS, LR_DERIVED, .derived = "required, unless there is a `camera`",
     .doc = "Several cameras by name; the first is used unless another is asked for."},
    {"image", LR_FIELD_RECORD, 0, .record = &lr_image_record, .doc = "The picture to be made."},
    {"ambient", LR_FIELD_COLOR, 0, COLOR, DEFAULT(0.1, 0.1, 0.1),
     MEMBER(lr_scene_draft, scene.ambient), .doc = "Light that is everywhere."},
    {"background", LR_FIELD_BACKGROUND, 0, COLOR, DEFAULT(1, 1, 1, 0.4, 0.6, 1),
     .doc = "What rays see that hit nothing: a colour, a gradient from below to above, a picture "
            "or the sky."},
    {"fog", LR_FIELD_RECORD, LR_DERIVED, .record = &lr_fog_record, .derived = "no fog",
     .doc = "Fog outside of all objects."},
    {"air", LR_FIELD_RECORD, LR_DERIVED, .record = &lr_air_record, .derived = "nothing",
     .doc = "What fills the space outside of all objects, for paths; in place of fog."},
    {"up", LR_FIELD_VECTOR, LR_NONZERO, COORDINATE, DEFAULT(0, 1, 0), MEMBER(lr_scene_draft, up),
     .doc = "Up for the background and for cameras that do not say."},
    {"materials", LR_FIELD_MATERIALS, 0, .doc = "Materials by name."},
    {"lights", LR_FIELD_LIGHTS, LR_DERIVED, .derived = "one light that suits the camera",
     .doc = "The lights; an empty list is a scene without any."},
    {"objects", LR_FIELD_OBJECTS, LR_REQUIRED, .doc = "What there is to see; at least one."},
};
const lr_record lr_scene_record = RECORD("the scene", "A scene of lavaray.", scene_fields, 0);
