/* One material on the device, seen from one direction: evaluated, sampled, summed up. */
#ifndef LR_BSDF_TESTS_H
#define LR_BSDF_TESTS_H

#include "packed_tests.h"

#include "bsdf.spv.h"

#define MOST (1u << 20) /* answers of one question */
#define FINE 16         /* each cell of a density is integrated by the square of it */
#define PI 3.14159265358979323846

typedef enum task { EVALUATE, SAMPLE, SUM } task;

typedef struct way {
    float wi[3], choice;
} way;

typedef struct answer {
    vec4 a, b;
} answer;

typedef struct view {
    float wo[3];
    uint32_t material;
    float ior1, ior2;
    uint32_t solid, seed;
} view;

typedef struct question {
    view view;
    way ways[MOST];
} question;

typedef struct harness {
    lr_scene *scene;
    lr_packed_scene packed;
    packed_kernel kernel;
} harness;

static question asked;
static answer found[MOST];

static inline lr_scene *scene_of(const lr_material *materials, uint32_t count)
{
    lr_scene *scene = scene_without_materials();
    lr_scene_builder builder = {.scene = scene};
    for (uint32_t i = 0; i < count; i++)
        *lr_scene_add_material(&builder) = materials[i];
    return scene;
}

/* The materials must need no memory of their own: their names are NULL. */
static inline void open_harness(harness *h, lr_device *device, const lr_material *materials,
                                uint32_t count)
{
    *h = (harness){.scene = scene_of(materials, count)};
    lr_settings settings = {.width = 1,
                            .height = 1,
                            .samples = 1,
                            .camera = &h->scene->cameras[0],
                            .integrator = LR_INTEGRATOR_PATH};
    MUST(lr_pack_scene(h->scene, &settings, &h->packed, error));
    lr_program_desc desc = {bsdf_spv, sizeof bsdf_spv / 4, h->packed.constants, LR_SPEC_COUNT};
    open_packed(&h->kernel, device, &h->packed, &desc, sizeof asked, sizeof found);
}

static inline void close_harness(harness *h)
{
    close_packed(&h->kernel);
    lr_packed_scene_free(&h->packed);
    lr_scene_destroy(h->scene);
}

/* Asks what is in `asked`; the first `count` answers, a multiple of LR_GROUP_SIZE, are in `found`,
 * each summing up `each` samples. */
static inline void ask(harness *h, task what, uint32_t count, uint32_t each)
{
    struct gpu_work work = {.tile_x = what, .count = each};
    size_t ways = what == EVALUATE ? count : 1;
    assert_in_range(count, 1, MOST);
    assert_int_equal(count % LR_GROUP_SIZE, 0);
    ask_packed(&h->kernel, &work, count / LR_GROUP_SIZE, &asked,
               sizeof asked.view + ways * sizeof(way), found, count * sizeof *found);
}

/* Seen from a cosine, from an angle about the normal that nothing depends on. */
static inline view view_at(uint32_t material, double cosine)
{
    double sine = sqrt(1 - cosine * cosine);
    return (view){.wo = {(float)(0.6 * sine), (float)(-0.8 * sine), (float)cosine},
                  .material = material,
                  .ior1 = 1,
                  .ior2 = 1,
                  .seed = 7};
}

static inline lr_material material(lr_model model, double color)
{
    lr_color c = {color, color, color};
    return (lr_material){.model = model,
                         .color = {.colors = {c, c}, .size = 1, .direction = {0, 1, 0}},
                         .transmit = model == LR_MODEL_DIELECTRIC || model == LR_MODEL_THIN_GLASS
                                         ? (lr_color){1, 1, 1}
                                         : (lr_color){0, 0, 0},
                         .ior = 1.5};
}

static const view from_air = {.ior1 = 1, .ior2 = 1.5f}, from_glass = {.ior1 = 1.5f, .ior2 = 1};

static inline lr_material rough(lr_model model, double color, double roughness)
{
    lr_material m = material(model, color);
    m.roughness = roughness;
    return m;
}

static inline lr_material classic(lr_highlight highlight)
{
    lr_material m = material(LR_MODEL_CLASSIC, 0);
    m.specular = (lr_color){0.5, 0.5, 0.5};
    m.shininess = 20;
    m.highlight = highlight;
    return m;
}

static inline vec3 spherical(double cosine, double angle)
{
    double sine = sqrt(1 - cosine * cosine);
    return (vec3){(float)(sine * cos(angle)), (float)(sine * sin(angle)), (float)cosine};
}

static inline view seen_along(vec3 wo, uint32_t material, view sides, bool solid)
{
    return (view){.wo = {wo.x, wo.y, wo.z},
                  .material = material,
                  .ior1 = sides.ior1,
                  .ior2 = sides.ior2,
                  .solid = solid,
                  .seed = 7};
}

/* The answers for `count` directions of light. */
static inline void evaluate(harness *h, view seen, const vec3 *wi, uint32_t count)
{
    asked.view = seen;
    uint32_t padded = (count + LR_GROUP_SIZE - 1) / LR_GROUP_SIZE * LR_GROUP_SIZE;
    for (uint32_t i = 0; i < padded; i++) {
        vec3 d = wi[i < count ? i : 0];
        asked.ways[i] = (way){{d.x, d.y, d.z}, 0.5f};
    }
    ask(h, EVALUATE, padded, 0);
}

static inline double dot(vec3 a, vec3 b)
{
    return (double)a.x * b.x + (double)a.y * b.y + (double)a.z * b.z;
}

/* ---- Samples against their density --------------------------------------------------------- */

static inline bool is_spread(answer a)
{
    return !(bits_of(a.b.w) & LR_BSDF_DELTA) && a.a.w > 0;
}

/* Where the point `i` of FINE is within its part, so that no two stand in a row: i's bits the other
 * way round. */
static inline double net_place(int i)
{
    return (((i & 1) << 3 | (i & 2) << 1 | (i & 4) >> 1 | (i & 8) >> 3) + 0.5) / FINE;
}

/* The upper end of chi-square for a chance of one in some 10,000 (Wilson and Hilferty, 1931). */
static inline double chi_square_limit(double freedom)
{
    double a = 2 / (9 * freedom), b = 1 - a + 3.72 * sqrt(a);
    return freedom * b * b * b;
}

static inline int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Counts of MOST samples in cells against the density integrated over them. */
static inline void check_counts(const char *name, const double *expected, const double *counted,
                                uint32_t count)
{
    static struct {
        double expected, counted;
    } cells[4096];
    double sum = 0, sampled = 0;
    assert_in_range(count, 1, 4096);
    for (uint32_t i = 0; i < count; i++) {
        cells[i].expected = expected[i] * MOST;
        cells[i].counted = counted[i];
        sum += expected[i];
        sampled += counted[i] / MOST;
    }
    /* Cells of few are one. */
    qsort(cells, count, sizeof *cells, compare_doubles);
    double chi = 0, few = 0, few_counted = 0, freedom = 0;
    for (uint32_t i = 0; i < count; i++) {
        few += cells[i].expected;
        few_counted += cells[i].counted;
        if (few < 20)
            continue;
        chi += (few_counted - few) * (few_counted - few) / few;
        few = few_counted = 0;
        freedom++;
    }
    double limit = chi_square_limit(fmax(freedom, 1));
    print_message("%s: density %.5f in all, %.5f of samples, chi-square %.1f of at most %.1f\n",
                  name, sum, sampled, chi, limit);
    assert_true(sum <= 1.001);
    assert_true(chi <= limit);
}

#endif
