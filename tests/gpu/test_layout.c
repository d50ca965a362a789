/* C and the kernels agree on every struct of gpu_layout.h: the offsets in the compiled modules, and
 * records written by C as the kernels load them. */
#include "gpu_tests.h"

#include "layout.spv.h"
#include "shade.spv.h"
#include "self_test.spv.h"
#include "trace.spv.h"

typedef struct member {
    const char *record, *name;
    size_t offset, size, record_size;
    bool word; /* an integer */
} member;

#define MEMBER(type, field, is_word)                                                               \
    {                                                                                              \
#type, #field, offsetof(struct type, field), sizeof((struct type *)0)->field,              \
            sizeof(struct type), is_word                                                           \
    }
#define FLOATS(type, field) MEMBER(type, field, false)
#define WORD(type, field) MEMBER(type, field, true)
#define LIST(type, field) MEMBER(type, field, true)

static const member members[] = {
    FLOATS(gpu_sphere, center),
    FLOATS(gpu_sphere, inv_radius),
    FLOATS(gpu_sphere, radius),
    WORD(gpu_sphere, object),
    WORD(gpu_sphere, flags),
    WORD(gpu_sphere, unused),
    FLOATS(gpu_plane, normal),
    FLOATS(gpu_plane, offset),
    WORD(gpu_plane, object),
    WORD(gpu_plane, flags),
    WORD(gpu_plane, unused0),
    WORD(gpu_plane, unused1),
    FLOATS(gpu_flat, normal),
    FLOATS(gpu_flat, offset),
    FLOATS(gpu_flat, u),
    FLOATS(gpu_flat, u_offset),
    FLOATS(gpu_flat, v),
    FLOATS(gpu_flat, v_offset),
    WORD(gpu_flat, object),
    WORD(gpu_flat, flags),
    WORD(gpu_flat, unused0),
    WORD(gpu_flat, unused1),
    FLOATS(gpu_solid, row0),
    FLOATS(gpu_solid, row1),
    FLOATS(gpu_solid, row2),
    FLOATS(gpu_solid, scale),
    FLOATS(gpu_solid, inv_scale),
    FLOATS(gpu_solid, radius_from),
    FLOATS(gpu_solid, radius_slope),
    WORD(gpu_solid, object),
    WORD(gpu_solid, flags),
    WORD(gpu_solid, unused0),
    WORD(gpu_solid, unused1),
    FLOATS(gpu_object, row0),
    FLOATS(gpu_object, row1),
    FLOATS(gpu_object, row2),
    WORD(gpu_object, material),
    WORD(gpu_object, flags),
    WORD(gpu_object, rank),
    WORD(gpu_object, instance),
    WORD(gpu_object, shadow_red),
    WORD(gpu_object, shadow_green),
    WORD(gpu_object, shadow_blue),
    WORD(gpu_object, shadow_rank),
    FLOATS(gpu_triangle, a),
    WORD(gpu_triangle, object),
    FLOATS(gpu_triangle, b),
    WORD(gpu_triangle, order),
    FLOATS(gpu_triangle, c),
    WORD(gpu_triangle, flags),
    WORD(gpu_corners, a),
    WORD(gpu_corners, b),
    WORD(gpu_corners, c),
    WORD(gpu_corners, unused),
    WORD(gpu_vertex, normal),
    FLOATS(gpu_vertex, u),
    FLOATS(gpu_vertex, v),
    WORD(gpu_vertex, color),
    FLOATS(gpu_instance, row0),
    FLOATS(gpu_instance, row1),
    FLOATS(gpu_instance, row2),
    WORD(gpu_instance, nodes),
    WORD(gpu_instance, object),
    FLOATS(gpu_instance, reach),
    WORD(gpu_instance, flags),
    FLOATS(gpu_node, min0),
    WORD(gpu_node, child0),
    FLOATS(gpu_node, max0),
    WORD(gpu_node, child1),
    FLOATS(gpu_node, min1),
    WORD(gpu_node, unused0),
    FLOATS(gpu_node, max1),
    WORD(gpu_node, unused1),
    FLOATS(gpu_medium, absorption),
    FLOATS(gpu_medium, ior),
    FLOATS(gpu_medium, scattering),
    FLOATS(gpu_medium, anisotropy),
    FLOATS(gpu_material, color0),
    WORD(gpu_material, pattern),
    FLOATS(gpu_material, color1),
    FLOATS(gpu_material, inv_size),
    FLOATS(gpu_material, pattern_origin),
    FLOATS(gpu_material, inv_length2),
    FLOATS(gpu_material, pattern_direction),
    WORD(gpu_material, flags),
    FLOATS(gpu_material, ambient),
    FLOATS(gpu_material, shininess),
    FLOATS(gpu_material, diffuse),
    FLOATS(gpu_material, ior),
    FLOATS(gpu_material, specular),
    FLOATS(gpu_material, emission_red),
    FLOATS(gpu_material, reflect),
    FLOATS(gpu_material, emission_green),
    FLOATS(gpu_material, transmit),
    FLOATS(gpu_material, emission_blue),
    FLOATS(gpu_bsdf, eta),
    WORD(gpu_bsdf, model),
    FLOATS(gpu_bsdf, k),
    FLOATS(gpu_bsdf, alpha),
    FLOATS(gpu_bsdf, sheen),
    FLOATS(gpu_bsdf, sheen_alpha),
    FLOATS(gpu_bsdf, coat),
    FLOATS(gpu_bsdf, coat_alpha),
    FLOATS(gpu_bsdf, metallic),
    FLOATS(gpu_bsdf, transmission),
    FLOATS(gpu_bsdf, roughness),
    WORD(gpu_bsdf, unused0),
    WORD(gpu_bsdf, unused1),
    WORD(gpu_bsdf, unused2),
    WORD(gpu_maps, normal),
    FLOATS(gpu_maps, normal_scale),
    WORD(gpu_maps, bump),
    FLOATS(gpu_maps, bump_height),
    WORD(gpu_maps, roughness),
    WORD(gpu_maps, metallic),
    WORD(gpu_maps, emission),
    WORD(gpu_maps, flags),
    FLOATS(gpu_emitter_map, u),
    FLOATS(gpu_emitter_map, v),
    FLOATS(gpu_emitter_map, u1),
    FLOATS(gpu_emitter_map, v1),
    FLOATS(gpu_emitter_map, u2),
    FLOATS(gpu_emitter_map, v2),
    WORD(gpu_emitter_map, texture),
    WORD(gpu_emitter_map, object),
    WORD(gpu_mix, first),
    WORD(gpu_mix, second),
    WORD(gpu_mix, unused0),
    WORD(gpu_mix, unused1),
    WORD(gpu_texture, texels),
    WORD(gpu_texture, size),
    WORD(gpu_texture, curve),
    WORD(gpu_texture, flags),
    FLOATS(gpu_light, position),
    FLOATS(gpu_light, half_falloff),
    FLOATS(gpu_light, color),
    WORD(gpu_light, flags),
    FLOATS(gpu_light, direction),
    FLOATS(gpu_light, cos_angle),
    FLOATS(gpu_light, cos_scale),
    FLOATS(gpu_light, radius),
    FLOATS(gpu_light, spread),
    WORD(gpu_light, unused),
    FLOATS(gpu_environment, right),
    WORD(gpu_environment, texture),
    FLOATS(gpu_environment, up),
    FLOATS(gpu_environment, intensity),
    FLOATS(gpu_environment, forward),
    WORD(gpu_environment, rows),
    FLOATS(gpu_environment, sun),
    FLOATS(gpu_environment, sun_spread),
    FLOATS(gpu_environment, sun_radiance),
    FLOATS(gpu_environment, pdf),
    FLOATS(gpu_environment, sun_pdf),
    WORD(gpu_environment, width),
    WORD(gpu_environment, height),
    WORD(gpu_environment, unused),
    WORD(gpu_sky_row, begin),
    WORD(gpu_sky_row, steps),
    FLOATS(gpu_sky_row, near),
    FLOATS(gpu_sky_row, extent),
    FLOATS(gpu_emitter, origin),
    WORD(gpu_emitter, kind),
    FLOATS(gpu_emitter, e1),
    FLOATS(gpu_emitter, inv_pdf),
    FLOATS(gpu_emitter, e2),
    FLOATS(gpu_emitter, pdf),
    FLOATS(gpu_emitter, radiance),
    WORD(gpu_emitter, light),
    FLOATS(gpu_emitter, normal),
    FLOATS(gpu_emitter, radius),
    WORD(gpu_choice, threshold),
    WORD(gpu_choice, first),
    WORD(gpu_choice, second),
    WORD(gpu_choice, unused),
    FLOATS(gpu_object_emitter, center),
    WORD(gpu_object_emitter, kind),
    FLOATS(gpu_object_emitter, pdf),
    FLOATS(gpu_object_emitter, radius),
    WORD(gpu_object_emitter, unused0),
    WORD(gpu_object_emitter, unused1),
    WORD(gpu_list, base),
    WORD(gpu_list, begin),
    WORD(gpu_list, end),
    WORD(gpu_list, nodes),
    FLOATS(gpu_frame, origin),
    FLOATS(gpu_frame, half_width),
    FLOATS(gpu_frame, forward),
    FLOATS(gpu_frame, half_height),
    FLOATS(gpu_frame, pixel_right),
    FLOATS(gpu_frame, inv_samples),
    FLOATS(gpu_frame, pixel_down),
    WORD(gpu_frame, samples),
    FLOATS(gpu_frame, background_low),
    WORD(gpu_frame, seed),
    FLOATS(gpu_frame, background_high),
    WORD(gpu_frame, depth),
    FLOATS(gpu_frame, background_up),
    FLOATS(gpu_frame, min_weight),
    FLOATS(gpu_frame, fog_color),
    FLOATS(gpu_frame, fog_density),
    LIST(gpu_frame, spheres),
    LIST(gpu_frame, flats),
    LIST(gpu_frame, solids),
    LIST(gpu_frame, ellipsoids),
    LIST(gpu_frame, boxes),
    LIST(gpu_frame, cones),
    LIST(gpu_frame, planes),
    WORD(gpu_frame, objects),
    WORD(gpu_frame, materials),
    WORD(gpu_frame, media),
    WORD(gpu_frame, lights),
    WORD(gpu_frame, inside0),
    WORD(gpu_frame, inside1),
    WORD(gpu_frame, inside2),
    WORD(gpu_frame, inside3),
    WORD(gpu_frame, balls),
    WORD(gpu_frame, bounded),
    FLOATS(gpu_frame, reach),
    WORD(gpu_frame, corners),
    LIST(gpu_frame, instances),
    LIST(gpu_frame, triangles),
    FLOATS(gpu_frame, cells_from),
    WORD(gpu_frame, inspect),
    FLOATS(gpu_frame, inv_cell),
    FLOATS(gpu_frame, inspect_scale),
    WORD(gpu_frame, choices),
    WORD(gpu_frame, object_emitters),
    WORD(gpu_frame, choice_shift),
    WORD(gpu_frame, environment),
    LIST(gpu_frame, lens),
    FLOATS(gpu_lens, right),
    FLOATS(gpu_lens, inv_focus),
    FLOATS(gpu_lens, up),
    WORD(gpu_lens, kind),
    FLOATS(gpu_lens, origin_step),
    FLOATS(gpu_lens, blade_turns),
    FLOATS(gpu_lens, forward_step),
    FLOATS(gpu_lens, inv_blades),
    FLOATS(gpu_lens, right_step),
    FLOATS(gpu_lens, turns_across),
    FLOATS(gpu_lens, down_step),
    FLOATS(gpu_lens, turns_down),
    WORD(gpu_frame, bsdfs),
    WORD(gpu_frame, albedo),
    WORD(gpu_frame, glass_albedo),
    WORD(gpu_frame, maps),
    WORD(gpu_frame, mixes),
    WORD(gpu_frame, unused_frame0),
    WORD(gpu_frame, unused_frame1),
    WORD(gpu_frame, unused_frame2),
    WORD(gpu_work, tile_x),
    WORD(gpu_work, tile_y),
    WORD(gpu_work, tile_width),
    WORD(gpu_work, tile_height),
    WORD(gpu_work, first_sample),
    WORD(gpu_work, count),
    WORD(gpu_work, first),
    WORD(gpu_work, light),
    WORD(gpu_work, light_count),
    WORD(gpu_work, first_lights),
    WORD(gpu_work, shadow_room),
    LIST(gpu_work, shadow_first),
    WORD(gpu_work, sorted),
    WORD(gpu_work, step),
    WORD(gpu_work, film_first),
    WORD(gpu_work, film_pitch),
    WORD(gpu_work, samples),
    WORD(gpu_work, rounds),
    WORD(gpu_work, resumed),
    WORD(gpu_work, plane_rows),
    WORD(gpu_work, sphere_rows),
    WORD(gpu_work, flat_rows),
    WORD(gpu_work, solid_rows),
    FLOATS(gpu_ray, origin),
    WORD(gpu_ray, pixel),
    FLOATS(gpu_ray, direction),
    WORD(gpu_ray, state),
    FLOATS(gpu_ray, weight),
    WORD(gpu_ray, note),
    WORD(gpu_ray, media0),
    WORD(gpu_ray, media1),
    WORD(gpu_ray, media2),
    WORD(gpu_ray, media3),
    WORD(gpu_hit, ray),
    FLOATS(gpu_hit, t),
    WORD(gpu_hit, primitive),
    WORD(gpu_hit, object),
    FLOATS(gpu_shadow_ray, origin),
    WORD(gpu_shadow_ray, pixel),
    FLOATS(gpu_shadow_ray, value),
    WORD(gpu_shadow_ray, light),
    WORD(gpu_counters, hit_groups),
    WORD(gpu_counters, hit_groups_y),
    WORD(gpu_counters, hit_groups_z),
    WORD(gpu_counters, hits),
    WORD(gpu_counters, rays),
    WORD(gpu_counters, traced),
    WORD(gpu_counters, shaded),
    WORD(gpu_counters, reflected),
    WORD(gpu_counters, refracted),
    WORD(gpu_counters, passed),
    WORD(gpu_counters, reflected_hits),
    WORD(gpu_counters, refracted_hits),
    WORD(gpu_counters, shadow),
    WORD(gpu_counters, shadow_hits),
    WORD(gpu_counters, dropped_depth),
    WORD(gpu_counters, dropped_weight),
    WORD(gpu_counters, dropped_nesting),
    WORD(gpu_counters, non_finite),
    WORD(gpu_counters, saturated),
    WORD(gpu_counters, made),
    LIST(gpu_counters, shadow_rays),
    WORD(gpu_counters, found),
    WORD(gpu_counters, unfinished),
    WORD(gpu_counters, made_hits),
    WORD(gpu_counters, unused0),
    FLOATS(gpu_ray_note, origin),
    WORD(gpu_ray_note, parent),
    FLOATS(gpu_ray_note, direction),
    WORD(gpu_ray_note, state),
    FLOATS(gpu_ray_note, weight),
    FLOATS(gpu_ray_note, t),
    FLOATS(gpu_ray_note, weight_there),
    WORD(gpu_ray_note, primitive),
    FLOATS(gpu_ray_note, fog),
    WORD(gpu_ray_note, medium),
    LIST(gpu_ray_note, fog_steps),
    LIST(gpu_ray_note, own_steps),
    FLOATS(gpu_ray_note, background),
    WORD(gpu_ray_note, object),
    FLOATS(gpu_ray_note, position),
    WORD(gpu_ray_note, flags),
    FLOATS(gpu_ray_note, normal),
    WORD(gpu_ray_note, medium_beyond),
    FLOATS(gpu_ray_note, lit_by),
    FLOATS(gpu_ray_note, cosine),
    FLOATS(gpu_ray_note, color),
    FLOATS(gpu_ray_note, refracted_cosine),
    FLOATS(gpu_ray_note, ambient),
    FLOATS(gpu_ray_note, ior),
    FLOATS(gpu_ray_note, emission),
    FLOATS(gpu_ray_note, ior_beyond),
    FLOATS(gpu_ray_note, reflect_weight),
    FLOATS(gpu_ray_note, reflectance),
    FLOATS(gpu_ray_note, transmit_weight),
    WORD(gpu_ray_note, unused0),
    FLOATS(gpu_ray_note, reflected),
    WORD(gpu_ray_note, unused1),
    FLOATS(gpu_ray_note, refracted),
    WORD(gpu_ray_note, unused2),
    FLOATS(gpu_light_note, origin),
    WORD(gpu_light_note, ray),
    FLOATS(gpu_light_note, wi),
    WORD(gpu_light_note, light),
    FLOATS(gpu_light_note, arriving),
    FLOATS(gpu_light_note, distance),
    FLOATS(gpu_light_note, value),
    FLOATS(gpu_light_note, cosine),
    FLOATS(gpu_light_note, left),
    FLOATS(gpu_light_note, highlight),
    FLOATS(gpu_light_note, attenuation),
    FLOATS(gpu_light_note, spot),
    WORD(gpu_light_note, reaches),
    WORD(gpu_light_note, unused),
    LIST(gpu_light_note, steps),
    WORD(gpu_light_note, unused0),
    WORD(gpu_light_note, unused1),
    FLOATS(gpu_obstacle_note, left),
    WORD(gpu_obstacle_note, light),
    FLOATS(gpu_obstacle_note, t0),
    FLOATS(gpu_obstacle_note, t1),
    WORD(gpu_obstacle_note, object),
    WORD(gpu_obstacle_note, unused),
    WORD(gpu_notes, rays),
    WORD(gpu_notes, lights),
    WORD(gpu_notes, obstacles),
    WORD(gpu_notes, unused),
    LIST(gpu_notes, of_hit),
    LIST(gpu_notes, ray),
    LIST(gpu_notes, light),
    LIST(gpu_notes, obstacle),
    FLOATS(gpu_self_test_in, a),
    FLOATS(gpu_self_test_in, b),
    FLOATS(gpu_self_test_in, c),
    WORD(gpu_self_test_in, n),
    WORD(gpu_self_test_out, sum),
    WORD(gpu_self_test_out, difference),
    WORD(gpu_self_test_out, product),
    WORD(gpu_self_test_out, product_sum),
    WORD(gpu_self_test_out, sum_product),
    WORD(gpu_self_test_out, scaled),
    WORD(gpu_self_test_out, from_integer),
    WORD(gpu_self_test_out, to_integer),
};
enum { MEMBER_COUNT = sizeof members / sizeof *members };

/* ---- Offsets ------------------------------------------------------------------------------- */

enum {
    OP_NAME = 5,
    OP_MEMBER_NAME = 6,
    OP_TYPE_RUNTIME_ARRAY = 29,
    OP_TYPE_ARRAY = 28,
    OP_TYPE_STRUCT = 30,
    OP_DECORATE = 71,
    OP_MEMBER_DECORATE = 72,
    DECORATION_ARRAY_STRIDE = 6,
    DECORATION_OFFSET = 35,
    IDS_MAX = 131072,
};

typedef struct module {
    const uint32_t *words;
    size_t count;
    const char *names[IDS_MAX]; /* of ids */
    uint32_t strides[IDS_MAX];  /* of arrays */
} module;

#define EACH(at, m) for (size_t at = 5; at < (m)->count; at += (m)->words[at] >> 16)

static void read_module(module *m, const uint32_t *words, size_t count)
{
    *m = (module){.words = words, .count = count};
    assert_true(words[3] <= IDS_MAX);
    EACH(at, m)
    {
        const uint32_t *w = &words[at];
        if ((w[0] & 0xFFFF) == OP_NAME)
            m->names[w[1]] = (const char *)&w[2];
        if ((w[0] & 0xFFFF) == OP_DECORATE && w[2] == DECORATION_ARRAY_STRIDE)
            m->strides[w[1]] = w[3];
    }
}

static const member *find_member(const char *record, const char *name)
{
    for (size_t i = 0; i < MEMBER_COUNT; i++)
        if (!strcmp(members[i].record, record) && !strcmp(members[i].name, name))
            return &members[i];
    return NULL;
}

static size_t count_members(const char *record)
{
    size_t count = 0;
    for (size_t i = 0; i < MEMBER_COUNT; i++)
        count += !strcmp(members[i].record, record);
    return count;
}

static const char *member_name(const module *m, uint32_t id, uint32_t index)
{
    EACH(at, m)
    {
        const uint32_t *w = &m->words[at];
        if ((w[0] & 0xFFFF) == OP_MEMBER_NAME && w[1] == id && w[2] == index)
            return (const char *)&w[3];
    }
    return "?";
}

/* Compares the offsets that a struct type has with those in C, and returns how
 * many it has; types without any are for variables only. */
static size_t check_struct(const module *m, uint32_t id, const char *record)
{
    size_t checked = 0;
    EACH(at, m)
    {
        const uint32_t *w = &m->words[at];
        if ((w[0] & 0xFFFF) != OP_MEMBER_DECORATE || w[1] != id || w[3] != DECORATION_OFFSET)
            continue;
        const char *name = member_name(m, id, w[2]);
        const member *expected = find_member(record, name);
        if (!expected)
            fail_msg("%s.%s is not in the table", record, name);
        else if (w[4] != expected->offset)
            fail_msg("%s.%s is at %u, in C at %zu", record, name, w[4], expected->offset);
        checked++;
    }
    return checked;
}

/* Compares all records that the module lays out, and the strides of arrays of them. Notes the
 * records in seen[]. */
static void check_module(const uint32_t *words, size_t count, bool seen[MEMBER_COUNT])
{
    static module m;
    read_module(&m, words, count);
    EACH(at, &m)
    {
        const uint32_t *w = &words[at];
        uint32_t opcode = w[0] & 0xFFFF;
        bool array = opcode == OP_TYPE_ARRAY || opcode == OP_TYPE_RUNTIME_ARRAY;
        const char *record = NULL;
        if (array)
            record = m.names[w[2]];
        else if (opcode == OP_TYPE_STRUCT)
            record = m.names[w[1]];
        if (!record || strncmp(record, "gpu_", 4))
            continue;
        if (!array) {
            size_t checked = check_struct(&m, w[1], record);
            if (checked)
                assert_int_equal(checked, count_members(record));
        }
        for (size_t i = 0; i < MEMBER_COUNT; i++)
            if (!strcmp(members[i].record, record)) {
                if (array && m.strides[w[1]])
                    assert_int_equal(m.strides[w[1]], members[i].record_size);
                seen[i] = true;
            }
    }
}

static void test_offsets(void **state)
{
    (void)state;
    bool seen[MEMBER_COUNT] = {false};
    check_module(trace_spv, sizeof trace_spv / 4, seen);
    check_module(shade_spv, sizeof shade_spv / 4, seen);
    check_module(self_test_spv, sizeof self_test_spv / 4, seen);
    check_module(layout_spv, sizeof layout_spv / 4, seen);
    for (size_t i = 0; i < MEMBER_COUNT; i++)
        if (!seen[i])
            fail_msg("no kernel declares %s", members[i].record);
}

/* ---- Round trip ---------------------------------------------------------------------------- */

#define RECORDS 3 /* of each kind; the last is loaded */

/* The rows in the order of a packed scene, and what layout.comp makes of them. */
static const char *const kinds[] = {"gpu_texture", "gpu_sphere",   "gpu_solid",    "gpu_plane",
                                    "gpu_flat",    "gpu_object",   "gpu_material", "gpu_medium",
                                    "gpu_light",   "gpu_triangle", "gpu_instance", "gpu_ray",
                                    "gpu_hit"};
enum { KIND_COUNT = sizeof kinds / sizeof *kinds, ROW_KINDS = KIND_COUNT - 2 };

/* Floats that are no subnormals, and integers that would be: small ones. */
static size_t fill_record(uint32_t *seed, const char *record, uint32_t *words)
{
    size_t size = 0;
    for (size_t i = 0; i < MEMBER_COUNT; i++) {
        const member *m = &members[i];
        if (strcmp(m->record, record))
            continue;
        size = m->record_size;
        for (size_t k = 0; k < m->size / 4; k++) {
            float value = random_sign(seed) * random_magnitude(seed, -100, 100);
            uint32_t word =
                m->word ? random_bits(seed) >> (random_bits(seed) % 31) : bits_of(value);
            words[m->offset / 4 + k] = word;
        }
    }
    return size;
}

typedef struct upload {
    uint32_t rows[4096], frame[128], work[32], counters[128], rays[128], hits[128];
    uint32_t expected[1024];
    size_t row_words, expected_words;
} upload;

static void expect_words(upload *u, const uint32_t *words, size_t size)
{
    memcpy(&u->expected[u->expected_words], words, size);
    u->expected_words += size / 4;
}

static void fill_upload(upload *u, uint32_t seed)
{
    uint32_t first[ROW_KINDS], textures;
    for (uint32_t kind = 0; kind < KIND_COUNT; kind++) {
        uint32_t *to =
            kind < ROW_KINDS ? &u->rows[u->row_words] : (kind == ROW_KINDS ? u->rays : u->hits);
        size_t size = 0;
        for (uint32_t i = 0; i < RECORDS; i++)
            size = fill_record(&seed, kinds[kind], to + i * size / 4);
        expect_words(u, to + (RECORDS - 1) * size / 4, size);
        if (kind < ROW_KINDS) {
            first[kind] = (uint32_t)(u->row_words / 4);
            u->row_words += RECORDS * size / 4;
        }
    }
    struct gpu_frame frame;
    fill_record(&seed, "gpu_frame", u->frame);
    memcpy(&frame, u->frame, sizeof frame);
    uint32_t *firsts[] = {
        &textures,         &frame.spheres.base,   &frame.solids.base,   &frame.planes.base,
        &frame.flats.base, &frame.objects,        &frame.materials,     &frame.media,
        &frame.lights,     &frame.triangles.base, &frame.instances.base};
    for (uint32_t i = 0; i < ROW_KINDS; i++)
        *firsts[i] = first[i];
    assert_int_equal(textures, 0);
    memcpy(u->frame, &frame, sizeof frame);
    expect_words(u, u->frame, sizeof frame);
    struct gpu_work work;
    fill_record(&seed, "gpu_work", u->work);
    memcpy(&work, u->work, sizeof work);
    work.first = RECORDS - 1;
    memcpy(u->work, &work, sizeof work);
    expect_words(u, u->work, sizeof work);
    expect_words(u, u->counters, fill_record(&seed, "gpu_counters", u->counters));
}

static void load_back(lr_device *device, const upload *u, bool texel_loads, uint32_t *found)
{
    VkDescriptorType types[LR_BIND_COUNT];
    lr_buffer_kind buffer_kinds[LR_BIND_COUNT];
    const void *contents[LR_BIND_COUNT] = {
        [LR_BIND_FRAME] = u->frame,       [LR_BIND_SCENE_TEXEL] = u->rows,
        [LR_BIND_COUNTERS] = u->counters, [LR_BIND_RAYS_IN] = u->rays,
        [LR_BIND_HITS] = u->hits,         [LR_BIND_RAYS_TEXEL] = u->rays,
        [LR_BIND_HITS_TEXEL] = u->hits,
    };
    lr_buffer own[LR_BIND_COUNT], back;
    const lr_buffer *buffers[LR_BIND_COUNT];
    for (int i = 0; i < LR_BIND_COUNT; i++) {
        types[i] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        buffer_kinds[i] = LR_BUFFER_STORAGE;
    }
    types[LR_BIND_FRAME] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    buffer_kinds[LR_BIND_FRAME] = LR_BUFFER_UNIFORM;
    const int texel_bindings[] = {LR_BIND_SCENE_TEXEL, LR_BIND_RAYS_TEXEL, LR_BIND_HITS_TEXEL};
    for (int i = 0; i < 3; i++) {
        types[texel_bindings[i]] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
        buffer_kinds[texel_bindings[i]] = LR_BUFFER_TEXEL;
    }
    for (int i = 0; i < LR_BIND_COUNT; i++) {
        size_t size = i == LR_BIND_SCENE_TEXEL ? sizeof u->rows : sizeof u->frame;
        size_t room = i == LR_BIND_FILM ? sizeof u->expected : size;
        MUST(lr_buffer_create(device, buffer_kinds[i], room, "a test", &own[i], error));
        if (contents[i])
            MUST(lr_buffer_upload(device, &own[i], contents[i], size, error));
        buffers[i] = &own[i == LR_BIND_SCENE_ROWS ? LR_BIND_SCENE_TEXEL : i];
    }
    MUST(lr_buffer_create(device, LR_BUFFER_HOST, sizeof u->expected, "back", &back, error));

    uint32_t constants[LR_SPEC_COUNT] = {0};
    constants[LR_SPEC_TEXEL_LOADS] = constants[LR_SPEC_TEXEL_QUEUES] = texel_loads;
    constants[LR_SPEC_CONES] = constants[LR_SPEC_MEDIA] = 1;
    lr_layout_desc layout_desc = {types, LR_BIND_COUNT, sizeof(struct gpu_work), 1};
    lr_program_desc program_desc = {layout_spv, sizeof layout_spv / 4, constants, LR_SPEC_COUNT};
    lr_layout layout;
    VkPipeline program;
    VkDescriptorSet set;
    MUST(lr_layout_create(device, &layout_desc, &layout, error));
    MUST(lr_set_create(device, &layout, buffers, &set, error));
    MUST(lr_program_create(device, &layout, &program_desc, &program, error));
    MUST(lr_commands_begin(device, error));
    lr_commands_zero(device, &own[LR_BIND_FILM], sizeof u->expected);
    lr_commands_barrier(device);
    lr_commands_dispatch(device, &layout, program, set, u->work, 1, 1, 1);
    lr_commands_barrier(device);
    lr_commands_copy(device, &own[LR_BIND_FILM], &back, sizeof u->expected);
    MUST(lr_commands_finish(device, error));
    memcpy(found, back.mapped, sizeof u->expected);
    device->vk.vkDestroyPipeline(device->handle, program, NULL);
    lr_layout_destroy(device, &layout);
    for (int i = 0; i < LR_BIND_COUNT; i++)
        lr_buffer_destroy(device, &own[i]);
    lr_buffer_destroy(device, &back);
}

static void test_round_trip(void **state)
{
    for (uint32_t texel_loads = 0; texel_loads < 2; texel_loads++)
        for (uint32_t seed = 1; seed <= 5; seed++) {
            static upload u;
            static uint32_t found[sizeof u.expected / 4];
            u = (upload){0};
            fill_upload(&u, seed);
            load_back(*state, &u, texel_loads, found);
            for (size_t i = 0; i < u.expected_words; i++)
                if (found[i] != u.expected[i])
                    fail_msg("word %zu is %08x, expected %08x", i, found[i], u.expected[i]);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_offsets),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
