/* The keys of patterns, maps and materials. */
#include "scene/keys_table.h"

#include <assert.h>

#include "scene/models.h"

static const char *const spaces[] = {"world", "object", NULL};
static const char *const wraps[] = {"repeat", "clamp", "mirror", NULL};
static const char *const emits[] = {"both", "front", NULL};
static const char *const highlights[] = {"blinn", "phong", NULL};

#define SPACE                                                                                      \
    {                                                                                              \
        "space", LR_FIELD_CHOICE, 0, DEFAULT(0), MEMBER(lr_pattern_draft, space),                  \
            .choices = spaces,                                                                     \
            .doc = "Fixed in the world, or moved along with the object's transform."               \
    }
#define PATTERN_COLORS(name_, doc_)                                                                \
    {                                                                                              \
        name_, LR_FIELD_COLORS, LR_REQUIRED, COLOR, MEMBER(lr_pattern_draft, pattern.colors),      \
            .doc = (doc_)                                                                          \
    }
#define SIZE(doc_)                                                                                 \
    {                                                                                              \
        "size", LR_FIELD_NUMBER, 0, LENGTH, DEFAULT(1), MEMBER(lr_pattern_draft, pattern.size),    \
            .doc = (doc_)                                                                          \
    }

static const lr_field checker_fields[] = {
    PATTERN_COLORS("checker", "The two colours of the cells."),
    SIZE("Edge of a cell."),
    SPACE,
};
static const lr_field stripes_fields[] = {
    PATTERN_COLORS("stripes", "The two colours of the stripes."),
    SIZE("Width of a stripe."),
    {"direction", LR_FIELD_VECTOR, LR_NONZERO, COORDINATE, DEFAULT(1, 0, 0),
     MEMBER(lr_pattern_draft, pattern.direction), .doc = "Across the stripes."},
    SPACE,
};
static const lr_field gradient_fields[] = {
    PATTERN_COLORS("gradient", "The colours at `from` and at `to`, blended in between."),
    {"from", LR_FIELD_VECTOR, 0, COORDINATE, DEFAULT(0, 0, 0),
     MEMBER(lr_pattern_draft, pattern.origin), .doc = "Where the first colour ends."},
    {"to", LR_FIELD_VECTOR, 0, COORDINATE, DEFAULT(0, 1, 0), MEMBER(lr_pattern_draft, to),
     .doc = "Where the second colour begins."},
    SPACE,
};
static const lr_field rings_fields[] = {
    PATTERN_COLORS("rings", "The two colours of the rings."),
    SIZE("Width of a ring."),
    {"center", LR_FIELD_VECTOR, 0, COORDINATE, DEFAULT(0, 0, 0),
     MEMBER(lr_pattern_draft, pattern.origin), .doc = "A point on the axis."},
    {"axis", LR_FIELD_VECTOR, LR_NONZERO, COORDINATE, DEFAULT(0, 1, 0),
     MEMBER(lr_pattern_draft, pattern.direction), .doc = "What the rings run around."},
    SPACE,
};
static const lr_field picture_fields[] = {
    {"image", LR_FIELD_TEXT, LR_REQUIRED, MEMBER(lr_pattern_draft, image),
     .doc = "The file of the picture, as seen from the scene's folder."},
    {"tint", LR_FIELD_COLOR, 0, COLOR, DEFAULT(1, 1, 1),
     MEMBER(lr_pattern_draft, pattern.colors[0]), .doc = "Multiplies the picture's colours."},
    {"wrap", LR_FIELD_CHOICE, 0, DEFAULT(0), MEMBER(lr_pattern_draft, wrap), .choices = wraps,
     .doc = "How the picture goes on beyond its edges."},
};
const lr_record lr_pattern_records[] = {
    RECORD("checker", "Cubes in two colours.", checker_fields, LR_PATTERN_CHECKER),
    RECORD("stripes", "Slabs in two colours.", stripes_fields, LR_PATTERN_STRIPES),
    RECORD("gradient", "A blend along a line.", gradient_fields, LR_PATTERN_GRADIENT),
    RECORD("rings", "Cylinders around an axis in two colours.", rings_fields, LR_PATTERN_RINGS),
    RECORD("image", "A picture from a file.", picture_fields, LR_PATTERN_IMAGE),
};
const uint32_t lr_pattern_record_count = COUNT(lr_pattern_records);

#define MAP_IMAGE                                                                                  \
    {                                                                                              \
        "image", LR_FIELD_TEXT, LR_REQUIRED, MEMBER(lr_map_draft, image),                          \
            .doc = "The file of the picture, as seen from the scene's folder."                     \
    }
#define MAP_WRAP                                                                                   \
    {                                                                                              \
        "wrap", LR_FIELD_CHOICE, 0, DEFAULT(0), MEMBER(lr_map_draft, wrap),                        \
            .choices = wraps, .doc = "How the picture goes on beyond its edges."                   \
    }
#define MAP_CHANNEL(index_)                                                                        \
    {                                                                                              \
        "channel", LR_FIELD_CHOICE, 0, DEFAULT(index_), MEMBER(lr_map_draft, map.channel),         \
            .choices = channels, .doc = "Which of the picture's channels it is."                   \
    }

static const char *const channels[] = {"red", "green", "blue", "alpha", NULL};
static const lr_field normal_map_fields[] = {
    MAP_IMAGE,
    {"scale", LR_FIELD_NUMBER, 0, RANGE(-1000, 1000), DEFAULT(1), MEMBER(lr_map_draft, map.amount),
     .doc = "Multiplies how far normals lean; 0: not at all."},
    MAP_WRAP,
};
static const lr_field bump_map_fields[] = {
    MAP_IMAGE,
    {"height", LR_FIELD_NUMBER, 0, RANGE(-1e6, 1e6), DEFAULT(0.01),
     MEMBER(lr_map_draft, map.amount),
     .doc = "Metres from black to white; below 0, white is deepest."},
    MAP_WRAP,
};
static const lr_field roughness_map_fields[] = {MAP_IMAGE, MAP_CHANNEL(LR_CHANNEL_GREEN), MAP_WRAP};
static const lr_field metallic_map_fields[] = {MAP_IMAGE, MAP_CHANNEL(LR_CHANNEL_BLUE), MAP_WRAP};
static const lr_field emission_map_fields[] = {MAP_IMAGE, MAP_WRAP};
const lr_record lr_map_records[LR_MAP_COUNT] = {
    RECORD("normal_map", "Which way the surface faces.", normal_map_fields, LR_MAP_NORMAL),
    RECORD("bump_map", "Heights on the surface.", bump_map_fields, LR_MAP_BUMP),
    RECORD("roughness_map", "Where the surface is rough.", roughness_map_fields, LR_MAP_ROUGHNESS),
    RECORD("metallic_map", "Where the surface is metal.", metallic_map_fields, LR_MAP_METALLIC),
    RECORD("emission_map", "Where the surface shines.", emission_map_fields, LR_MAP_EMISSION),
};
#define MAP(name_, kind_, doc_)                                                                    \
    {                                                                                              \
        .name = (name_), .type = LR_FIELD_MAP, .flags = LR_DERIVED,                                \
        .record = &lr_map_records[kind_], .derived = "none", .doc = (doc_)                         \
    }

#define SHARE(name_, member_, doc_)                                                                \
    {                                                                                              \
        name_, LR_FIELD_NUMBER, 0, RANGE(0, 1), DEFAULT(0), MEMBER(lr_material, member_),          \
            .doc = (doc_)                                                                          \
    }

static const lr_field material_fields[] = {
    {"model", LR_FIELD_CHOICE, 0, DEFAULT(LR_MODEL_CLASSIC), MEMBER(lr_material, model),
     .choices = lr_model_names, .doc = "What it is made of; each model has keys of its own."},
    {"color", LR_FIELD_PAINT, 0, COLOR, DEFAULT(0.8, 0.8, 0.8), MEMBER(lr_material, color),
     .doc = "The colour of the surface: a colour, a pattern or a picture."},
    {"ambient", LR_FIELD_COLOR, LR_DERIVED, COLOR, MEMBER(lr_material, ambient),
     .derived = "the same as `diffuse`", .doc = "Share of the scene's ambient light."},
    {"diffuse", LR_FIELD_COLOR, LR_DERIVED, COLOR, MEMBER(lr_material, diffuse),
     .derived = "what `reflect` and `transmit` leave over of 1", .doc = "Share of matt shading."},
    {"specular", LR_FIELD_COLOR, 0, COLOR, DEFAULT(0), MEMBER(lr_material, specular),
     .doc = "Strength of the highlight of each light."},
    {"shininess", LR_FIELD_NUMBER, 0, RANGE(0, 1e6), DEFAULT(32), MEMBER(lr_material, shininess),
     .doc = "Exponent of the highlight; larger is smaller and sharper."},
    {"highlight", LR_FIELD_CHOICE, 0, DEFAULT(0), MEMBER(lr_material, highlight),
     .choices = highlights, .doc = "The highlight's formula."},
    {"reflect", LR_FIELD_COLOR, 0, RANGE(0, 1), DEFAULT(0), MEMBER(lr_material, reflect),
     .doc = "Weight of the mirrored ray."},
    {"transmit", LR_FIELD_COLOR, 0, RANGE(0, 1), DEFAULT(0), MEMBER(lr_material, transmit),
     .doc = "Weight of the ray that goes through; of glass it is 1 unless it is given."},
    {"ior", LR_FIELD_NUMBER, 0, RANGE(0.01, 100), DEFAULT(1.5), MEMBER(lr_material, ior),
     .doc = "Index of refraction of the inside."},
    {"fresnel", LR_FIELD_BOOLEAN, 0, DEFAULT(0), MEMBER(lr_material, fresnel),
     .doc = "Share light between mirroring and transmission by angle, as glass does."},
    {"absorption", LR_FIELD_COLOR, 0, COLOR, DEFAULT(0), MEMBER(lr_material, absorption),
     .doc = "Per metre inside: what is left is exp(-absorption * distance)."},
    {"scattering", LR_FIELD_COLOR, 0, COLOR, DEFAULT(0), MEMBER(lr_material, scattering),
     .doc = "Per metre inside: light that goes on in another direction, as in milk; only paths "
            "see it."},
    {"anisotropy", LR_FIELD_NUMBER, 0, RANGE(-0.95, 0.95), DEFAULT(0),
     MEMBER(lr_material, anisotropy),
     .doc = "Which direction that is: back, below 0, evenly all around, or on, above 0."},
    {"priority", LR_FIELD_INTEGER, 0, RANGE(-100, 100), DEFAULT(0), MEMBER(lr_material, priority),
     .doc = "Where media overlap, the higher one fills the overlap."},
    {"emission", LR_FIELD_COLOR, 0, COLOR, DEFAULT(0), MEMBER(lr_material, emission),
     .doc = "Light that the surface sends out by itself; only paths are lit by it."},
    {"emits", LR_FIELD_CHOICE, 0, DEFAULT(0), MEMBER(lr_material, emits), .choices = emits,
     .doc = "The sides that shine: both, or only where the normal points."},
    {"alpha_cutoff", LR_FIELD_NUMBER, 0, RANGE(0, 1), DEFAULT(0), MEMBER(lr_material, alpha_cutoff),
     .doc = "Where the picture's alpha is below this, there is no surface."},
    {"one_sided", LR_FIELD_BOOLEAN, 0, DEFAULT(0), MEMBER(lr_material, one_sided),
     .doc = "Flat and open objects are not there as seen from behind."},
    {"first", LR_FIELD_MATERIAL, LR_DERIVED, .derived = "required by `model: mix`",
     .doc = "One of the two materials of a mix: a name, or a material written here."},
    {"second", LR_FIELD_MATERIAL, LR_DERIVED, .derived = "required by `model: mix`",
     .doc = "The other one."},
    {"weight", LR_FIELD_PAINT, 0, RANGE(0, 1), DEFAULT(0.5, 0.5, 0.5),
     MEMBER(lr_material, mix.weight),
     .doc = "Share of the second: a number, a pattern or a picture, whose luminance counts."},
    SHARE("roughness", roughness, "From smooth to rough; its square is the width of the facets."),
    {"metal", LR_FIELD_CHOICE, 0, DEFAULT(LR_METAL_NONE), MEMBER(lr_material, metal),
     .choices = lr_metal_names,
     .doc = "A conductor that has been measured, in place of eta and k."},
    {"eta", LR_FIELD_COLOR, 0, RANGE(0, 100), DEFAULT(0), MEMBER(lr_material, eta),
     .doc = "Refractive index of a conductor, the real part."},
    {"k", LR_FIELD_COLOR, 0, RANGE(0, 100), DEFAULT(0), MEMBER(lr_material, k),
     .doc = "Refractive index of a conductor, the imaginary part."},
    SHARE("metallic", metallic, "From dielectric to metal."),
    SHARE("transmission", transmission, "Share of light that goes in where it is no metal."),
    SHARE("clearcoat", clearcoat, "Strength of a clear coat above all else."),
    SHARE("clearcoat_roughness", clearcoat_roughness, "Roughness of the coat."),
    {"sheen", LR_FIELD_COLOR, 0, RANGE(0, 1), DEFAULT(0), MEMBER(lr_material, sheen),
     .doc = "Colour of fibres that stand out of cloth."},
    SHARE("sheen_roughness", sheen_roughness, "Roughness of the fibres."),
    MAP("normal_map", LR_MAP_NORMAL, "A picture of the way that the surface faces."),
    MAP("bump_map", LR_MAP_BUMP, "A picture of heights on the surface."),
    MAP("roughness_map", LR_MAP_ROUGHNESS, "A picture that multiplies `roughness`."),
    MAP("metallic_map", LR_MAP_METALLIC, "A picture that multiplies `metallic`."),
    MAP("emission_map", LR_MAP_EMISSION, "A picture that multiplies `emission`, which is 1 then."),
};
static_assert(COUNT(material_fields) <= LR_FIELDS_MAX, "lr_given has room for all keys");
const lr_record lr_material_record =
    RECORD("material", "How a surface and its inside look.", material_fields, 0);
