/* The texture filter against double precision: all wraps, both kinds of texels, coordinates within
 * the picture, at its and its texels' edges, far off, infinite and not numbers. */
#include "packed_tests.h"

#include "scene/color.h"
#include "texture.spv.h"

#define COUNT 262144u

typedef struct lookup {
    float u, v;
    uint32_t texture, material;
} lookup;

typedef struct answer {
    float color[4];
    uint32_t cut;
} answer;

static lookup given[COUNT];
static answer found[COUNT];

/* ---- A scene of textures ------------------------------------------------------------------- */

/* As many texels in all as a texel buffer of SwiftShader holds. */
static const uint32_t sizes[][2] = {{1, 1}, {2, 2},  {3, 5},    {64, 17},
                                    {7, 1}, {1, 33}, {4096, 1}, {120, 40}};
enum { SIZES = sizeof sizes / sizeof *sizes, WRAPS = 9, TEXTURES = SIZES * WRAPS };

static void add_texture(lr_scene_builder *builder, uint32_t *seed, uint32_t index)
{
    lr_texture *texture = lr_scene_add_texture(builder);
    lr_material *material = lr_scene_add_material(builder);
    const uint32_t *size = sizes[index % SIZES];
    *texture = (lr_texture){.width = size[0],
                            .height = size[1],
                            .wrap_u = (lr_wrap)(index / SIZES % 3),
                            .wrap_v = (lr_wrap)(index / SIZES / 3)};
    *material = (lr_material){
        .color = {.kind = LR_PATTERN_IMAGE, .texture = index, .direction = {0, 1, 0}},
        .alpha_cutoff = index % 4 == 0 ? 1 : random_between(seed, 0, 1),
    };
    size_t count = (size_t)size[0] * size[1];
    if ((index + index / SIZES) % 3 == 0) {
        texture->floats = calloc(3 * count, sizeof(float));
        for (size_t i = 0; i < 3 * count; i++)
            texture->floats[i] = random_between(seed, 0, 100);
    } else {
        texture->bytes = calloc(4, count);
        for (size_t i = 0; i < 4 * count; i++)
            texture->bytes[i] = (uint8_t)random_bits(seed);
    }
}

static lr_scene *make_scene(void)
{
    lr_scene *scene = scene_without_materials();
    lr_scene_builder builder = {.scene = scene};
    uint32_t seed = 5;
    for (uint32_t i = 0; i < TEXTURES; i++)
        add_texture(&builder, &seed, i);
    return scene;
}

/* ---- Coordinates --------------------------------------------------------------------------- */

static float random_coordinate(uint32_t *seed, uint32_t size)
{
    static const float special[] = {NAN,     INFINITY, -INFINITY, 0,        -0.0f,      1e-40f,
                                    -1e-40f, -1e-30f,  1,         -1,       8388607.5f, 8388608,
                                    8388609, 16777216, -8388607,  -8388609, 3.4e38f,    -3.4e38f};
    uint32_t count = sizeof special / sizeof *special;
    switch (random_bits(seed) % 6) {
    case 0:
        return random_between(seed, 0, 1);
    case 1:
        return random_between(seed, -4, 4);
    case 2: { /* an edge or the middle of a texel, or just beside it */
        uint32_t places = 2 * size;
        float at = (float)(random_bits(seed) % (4 * places)) / (float)places - 2;
        return nextafterf(at, random_sign(seed) * (random_bits(seed) & 1 ? 9.0f : fabsf(at)));
    }
    case 3:
        return random_sign(seed) * random_magnitude(seed, -126, 127);
    case 4:
        return random_between(seed, -9e6, 9e6);
    default:
        return special[random_bits(seed) % count];
    }
}

/* ---- What is expected ---------------------------------------------------------------------- */

/* One coordinate as a place among the texels' centres, and the neighbours. */
static void place(float given_u, uint32_t size, lr_wrap wrap, uint32_t texels[2], double *share)
{
    double u = isnan(given_u) ? 0 : fmax(-0x1p23, fmin(given_u, 0x1p23));
    if (wrap == LR_WRAP_CLAMP)
        u = fmax(0, fmin(u, 1));
    double x = u * size - 0.5, whole = floor(x);
    *share = x - whole;
    for (int i = 0; i < 2; i++) {
        double last = size - 1.0, texel = whole + i, period = wrap == LR_WRAP_MIRROR ? 2 : 1;
        if (wrap == LR_WRAP_CLAMP) {
            texel = fmax(0, fmin(texel, last));
        } else {
            texel -= floor(texel / (period * size)) * period * size;
            texel = texel > last ? 2 * size - 1 - texel : texel;
        }
        texels[i] = (uint32_t)texel;
    }
}

static double channel_of(const lr_texture *t, uint32_t x, uint32_t y, int channel)
{
    size_t i = (size_t)y * t->width + x;
    if (t->floats)
        return channel == 3 ? 1 : (double)t->floats[3 * i + (size_t)channel];
    uint8_t byte = t->bytes[4 * i + (size_t)channel];
    return channel == 3 ? byte / 255.0 : lr_srgb_to_linear(byte);
}

static void check(const lr_scene *scene, const lookup *look, const answer *reply)
{
    const lr_texture *t = &scene->textures[look->texture];
    uint32_t x[2], y[2];
    double across, down;
    place(look->u, t->width, t->wrap_u, x, &across);
    place(look->v, t->height, t->wrap_v, y, &down);
    /* The place is rounded to float, and so is the blend. */
    double greatest = t->floats ? 100 : 1;
    double tolerance = greatest * ((t->width + t->height) * 0x1p-23 + 0x1p-21);
    for (int channel = 0; channel < 4; channel++) {
        double upper = channel_of(t, x[0], y[0], channel) * (1 - across) +
                       channel_of(t, x[1], y[0], channel) * across;
        double lower = channel_of(t, x[0], y[1], channel) * (1 - across) +
                       channel_of(t, x[1], y[1], channel) * across;
        double expected = upper * (1 - down) + lower * down;
        if (!(fabs(reply->color[channel] - expected) <= tolerance))
            fail_msg("channel %d of texture %u, %u x %u with wraps %d %d, at %.9g %.9g is %.9g, "
                     "expected %.9g",
                     channel, look->texture, t->width, t->height, (int)t->wrap_u, (int)t->wrap_v,
                     (double)look->u, (double)look->v, (double)reply->color[channel], expected);
    }
    double cutoff = (float)scene->materials[look->material].alpha_cutoff;
    double alpha = reply->color[3];
    if (reply->cut != (uint32_t)(alpha < cutoff))
        fail_msg("cut out is %u with alpha %.9g and cutoff %.9g", reply->cut, alpha, cutoff);
}

/* ---- The device ---------------------------------------------------------------------------- */

static void run(lr_device *device, const lr_packed_scene *packed, bool texel_loads)
{
    uint32_t constants[LR_SPEC_COUNT] = {[LR_SPEC_TEXEL_LOADS] = texel_loads};
    lr_program_desc desc = {texture_spv, sizeof texture_spv / 4, constants, LR_SPEC_COUNT};
    struct gpu_work work = {0};
    packed_kernel k;
    open_packed(&k, device, packed, &desc, sizeof given, sizeof found);
    ask_packed(&k, &work, COUNT / LR_GROUP_SIZE, given, sizeof given, found, sizeof found);
    close_packed(&k);
}

static void test_filter(void **state)
{
    lr_scene *scene = make_scene();
    lr_settings settings = {.width = 1, .height = 1, .samples = 1, .camera = &scene->cameras[0]};
    lr_packed_scene packed;
    MUST(lr_pack_scene(scene, &settings, &packed, error));
    assert_int_equal(packed.constants[LR_SPEC_TEXTURES], 1);
    assert_int_equal(packed.constants[LR_SPEC_CUTOUTS], 1);
    assert_int_equal(packed.constants[LR_SPEC_PATTERNS], 0);
    uint32_t seed = 11, cut = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t texture = random_bits(&seed) % TEXTURES;
        given[i] =
            (lookup){random_coordinate(&seed, scene->textures[texture].width),
                     random_coordinate(&seed, scene->textures[texture].height), texture, texture};
    }
    for (int texel_loads = 0; texel_loads < 2; texel_loads++) {
        run(*state, &packed, texel_loads);
        for (uint32_t i = 0; i < COUNT; i++) {
            check(scene, &given[i], &found[i]);
            cut += found[i].cut;
        }
    }
    assert_in_range(cut, COUNT / 4, 7 * COUNT / 4);
    lr_packed_scene_free(&packed);
    lr_scene_destroy(scene);
}

/* A plane whose picture, along x, is opaque up to 1/2, between a wall and its light. */
static void test_plane_with_a_hole(void **state)
{
    for (int i = 0; i < 8; i++) {
        double x = i / 4.0 - 0.7;
        rgb color =
            render_pixel(*state, NULL,
                         "camera: {from: [%g, 0, 0], to: [%g, 0, -1]}\n"
                         "ambient: 0\n"
                         "lights: [{directional: {direction: [0, 0, -1]}}]\n"
                         "objects:\n"
                         "- plane: {normal: [0, 0, 1], offset: -1, material: {color: 1}}\n"
                         "- plane: {normal: [0, 0, 1], offset: 1, material: {color: {image: "
                         "tests/images/scenes/cutout.png, wrap: clamp}, alpha_cutoff: 0.5}}\n",
                         x, x);
        assert_near(color.g, x < 0.5 ? 0 : 1, 1e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_filter),
        cmocka_unit_test(test_plane_with_a_hole),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
