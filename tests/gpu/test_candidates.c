/* The bounding balls never rule out what the exact test hits: with rays that graze the primitives,
 * from near and from far, for small and for great objects close to the origin and off it. */
#include "gpu_tests.h"

#include "candidates.spv.h"
#include "render/pack.h"

#define ROUNDS 40 /* objects of each kind */
#define RAYS 4096 /* at each of them */

typedef struct ray_and_primitive {
    float origin[3];
    uint32_t kind;
    float direction[4], ball[4];
    vec4 rows[5];
} ray_and_primitive;

static double uniform(uint32_t *seed, double low, double high)
{
    return low + (high - low) * (random_bits(seed) / 4294967296.0);
}

static lr_vec3 random_direction(uint32_t *seed)
{
    for (;;) {
        lr_vec3 v = {uniform(seed, -1, 1), uniform(seed, -1, 1), uniform(seed, -1, 1)};
        double length = lr_vec3_length(v);
        if (length > 0.1 && length < 1)
            return lr_vec3_scale(v, 1 / length);
    }
}

/* A scene of one object of the kind: some 1 m in size, then scaled, turned and moved. */
static int describe(char *text, size_t size, uint32_t *seed, uint32_t kind)
{
    static const char *const shapes[5][3] = {
        {"sphere: {radius: 0.7", "sphere: {radius: 0.7", "sphere: {radius: 1.1"},
        {"rectangle: {corner: [-1, -0.5, 0], u: [2, 0, 0], v: [0, 1, 0.3]",
         "disk: {center: [0.2, 0, 0], normal: [1, 2, 3], radius: 0.8",
         "triangle: {a: [-1, 0, 0.2], b: [1, 0.3, 0], c: [0, 1, 0]"},
        {"sphere: {radius: 0.7", "sphere: {radius: 0.7", "sphere: {radius: 1.1"},
        {"box: {min: [-0.5, -0.2, -1], max: [0.5, 0.2, 1]", "box: {min: [0, 0, 0], max: [1, 1, 1]",
         "box: {min: [-1, -0.01, -1], max: [1, 0, 1]"},
        {"cone: {from: [0, -1, 0], to: [0, 1, 0], radius: 0.6",
         "cylinder: {from: [0, -1, 0], to: [0, 1, 1], radius: 0.3",
         "cylinder: {from: [0, 0, 0], to: [0, 0.1, 0], radius: 1"},
    };
    double scale = exp(uniform(seed, -12, 12)), off = scale * exp(uniform(seed, -5, 7));
    lr_vec3 move = lr_vec3_scale(random_direction(seed), off);
    double stretch = kind == 2 ? 3 : 1;
    return snprintf(text, size,
                    "camera: {}\nobjects:\n  - %s, scale: [%.9g, %.9g, %.9g], rotate: [%.3f, %.3f, "
                    "%.3f], translate: [%.9g, %.9g, %.9g]}\n",
                    shapes[kind][random_bits(seed) % 3], scale, scale * stretch, scale,
                    uniform(seed, 0, 360), uniform(seed, 0, 360), uniform(seed, 0, 360), move.x,
                    move.y, move.z);
}

static void pack_one(uint32_t *seed, uint32_t kind, ray_and_primitive *out)
{
    char text[512];
    int length = describe(text, sizeof text, seed, kind);
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_packed_scene packed;
    lr_settings settings = {.width = 1, .height = 1, .samples = 1};
    lr_error error = {0};
    if (lr_scene_parse(text, (size_t)length, "test.yaml", &scene, &report, &error))
        fail_msg("%s%s", error.message, report ? report : "");
    settings.camera = &scene->cameras[0];
    if (lr_pack_scene(scene, &settings, &packed, &error))
        fail_msg("%s", error.message);
    const gpu_list *lists[] = {&packed.frame.spheres, &packed.frame.flats, &packed.frame.ellipsoids,
                               &packed.frame.boxes, &packed.frame.cones};
    assert_int_equal(lists[kind]->end - lists[kind]->begin, 1);
    *out = (ray_and_primitive){.kind = kind};
    memcpy(out->rows, &packed.rows[lists[kind]->base], sizeof out->rows);
    memcpy(out->ball, &packed.rows[packed.frame.balls], sizeof out->ball);
    lr_packed_scene_free(&packed);
    lr_scene_destroy(scene);
}

/* A ray whose line passes the ball's centre at 0.01 to 1.01 of its radius, mostly near its rim. */
static void aim(uint32_t *seed, ray_and_primitive *r)
{
    lr_vec3 center = {r->ball[0], r->ball[1], r->ball[2]};
    double radius = sqrt(r->ball[3]);
    lr_vec3 d = random_direction(seed), side, up;
    lr_vec3_frame(d, &side, &up);
    double rim = 1.01 - exp(uniform(seed, -14, 0)), back = exp(uniform(seed, -4, 8));
    double turn = uniform(seed, 0, 6.28);
    lr_vec3 p = lr_vec3_add(center, lr_vec3_scale(side, radius * rim * cos(turn)));
    p = lr_vec3_add(p, lr_vec3_scale(up, radius * rim * sin(turn)));
    p = lr_vec3_sub(p, lr_vec3_scale(d, radius * back * (random_bits(seed) % 8 ? 1 : -1)));
    double exact[] = {p.x, p.y, p.z, d.x, d.y, d.z};
    for (int i = 0; i < 3; i++) {
        r->origin[i] = (float)exact[i];
        r->direction[i] = (float)exact[3 + i];
    }
}

static void check_kind(lr_device *device, uint32_t kind)
{
    static ray_and_primitive given[RAYS];
    static uint32_t found[RAYS];
    uint32_t seed = 7 + kind, hits = 0, candidates = 0;
    for (int round = 0; round < ROUNDS; round++) {
        ray_and_primitive one;
        pack_one(&seed, kind, &one);
        for (int i = 0; i < RAYS; i++) {
            given[i] = one;
            aim(&seed, &given[i]);
        }
        kernel k = {candidates_spv,
                    sizeof candidates_spv / 4,
                    given,
                    sizeof given,
                    found,
                    sizeof found,
                    0,
                    RAYS / LR_GROUP_SIZE};
        run_kernel(device, &k);
        for (int i = 0; i < RAYS; i++) {
            hits += found[i] & 1;
            candidates += found[i] >> 1;
            if (found[i] == 1)
                fail_msg("kind %u: a ray from (%.9g %.9g %.9g) along (%.9g %.9g %.9g) hits, but "
                         "misses the ball at (%.9g %.9g %.9g), radius^2 %.9g",
                         kind, given[i].origin[0], given[i].origin[1], given[i].origin[2],
                         given[i].direction[0], given[i].direction[1], given[i].direction[2],
                         given[i].ball[0], given[i].ball[1], given[i].ball[2], given[i].ball[3]);
        }
    }
    /* The balls are worth having only if they rule out something. */
    assert_true(hits > ROUNDS * RAYS / 50);
    assert_true(candidates < ROUNDS * RAYS * 49 / 50);
}

static void test_no_hit_is_ruled_out(void **state)
{
    for (uint32_t kind = 0; kind < 5; kind++)
        check_kind(*state, kind);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_hit_is_ruled_out),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
