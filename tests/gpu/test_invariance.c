/* The picture's hash does not depend on how the work was cut up, nor on what ran before. */
#include "gpu_tests.h"

/* A bit of everything: each kind of object, pattern and light, glass, mirrors, media, fog. */
static const char scene[] =
    "camera: {from: [0, 2, 7], to: [0, 0.8, 0]}\n"
    "image: {width: 61, height: 47, samples: 3, depth: 5, seed: 7}\n"
    "fog: {density: 0.01, color: [0.6, 0.7, 0.8]}\n"
    "materials:\n"
    "  floor: {color: {checker: [white, [0.05, 0.05, 0.05]]}, reflect: 0.2}\n"
    "  glass: {diffuse: 0, transmit: 0.95, ior: 1.5, fresnel: true, absorption: [0.1, 0, 0.3]}\n"
    "  water: {diffuse: 0, transmit: 1, ior: 1.33, priority: -1}\n"
    "  shiny: {color: {stripes: [red, blue], size: 0.2}, specular: 0.8, reflect: 0.3}\n"
    "lights:\n"
    "  - point: {position: [4, 6, 3], intensity: 40}\n"
    "  - spot: {position: [-4, 6, 3], to: [0, 0, 0], intensity: 30, falloff: 1.5}\n"
    "  - directional: {direction: [0.2, -1, -0.4], intensity: 0.3}\n"
    "objects:\n"
    "  - plane: {material: floor}\n"
    "  - sphere: {center: [-1.6, 1, 0], material: glass}\n"
    "  - sphere: {center: [-1.6, 1, 0.3], radius: 0.8, material: water}\n"
    "  - sphere: {radius: 0.5, scale: [1, 1.6, 1], translate: [0, 0.8, 1], material: shiny}\n"
    "  - box: {min: [1, 0, -1], max: [2, 1.5, 0], rotate: [0, 20, 0], material: shiny}\n"
    "  - cylinder: {from: [2.5, 0, 1], to: [2.5, 1, 1], radius: 0.4, material: glass}\n"
    "  - cone: {from: [0, 0, -2], to: [0, 3, -2], open: true}\n"
    "  - disk: {center: [0, 2, -3], normal: [0, 0, 1], material: {reflect: 0.8}}\n"
    "  - rectangle: {corner: [-1, 4, -1], u: [2, 0, 0], v: [0, 0, 2], material: {emission: 3}}\n"
    "  - sphere: {center: [1, 0.3, 1.5], radius: 0.2, material: {emission: [2, 1, 0]}}\n"
    "  - triangle: {a: [-3, 0, -2], b: [-2, 0, -2], c: [-2.5, 2, -2]}\n";

static const lr_integrator integrators[] = {LR_INTEGRATOR_WHITTED, LR_INTEGRATOR_PATH};

static void hash_of(lr_device *device, const lr_render_options *options, char hash[65])
{
    picture p = render_text(device, scene, options);
    memcpy(hash, p.stats.hash, 65);
    char again[65];
    lr_picture_hash(&p.image, again);
    assert_string_equal(hash, again);
    free_picture(&p);
}

static void test_tiles_and_chunks(void **state)
{
    const lr_render_options options[] = {
        {.tile_size = 8},
        {.tile_size = 33},
        {.tile_size = 61},
        {.tile_size = 128},
        {.tile_size = 1000},
        {.tile_size = 1, .chunk_rays = 1, .width = 5, .height = 3},
        {.tile_size = 8, .chunk_rays = 64},
        {.tile_size = 16, .chunk_rays = 1000},
        {.chunk_rays = 1u << 20},
        {.storage_loads = true},
        {.storage_loads = true, .tile_size = 33, .chunk_rays = 2048},
    };
    for (int k = 0; k < 2; k++) {
        char reference[65], small[65], hash[65];
        lr_render_options plain = {.integrator = integrators[k]};
        hash_of(*state, &plain, reference);
        plain.width = 5;
        plain.height = 3;
        hash_of(*state, &plain, small);
        assert_string_not_equal(reference, small);
        for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
            lr_render_options cut = options[i];
            cut.integrator = integrators[k];
            hash_of(*state, &cut, hash);
            assert_string_equal(hash, options[i].width ? small : reference);
        }
    }
}

/* Glass, mirrors and lamps among more objects than rays test one by one. */
static void test_paths_through_trees(void **state)
{
    static const char *const materials[] = {"glass", "lamp", "matt", "mirror"};
    char text[8192];
    FILE *out = fmemopen(text, sizeof text, "w");
    fputs("camera: {from: [0, 3, 9], to: [0, 1, 0]}\n"
          "image: {width: 61, height: 47, samples: 3, depth: 5, integrator: path}\n"
          "materials: {glass: {transmit: 1, fresnel: true}, lamp: {emission: 4}, matt: {}, mirror: "
          "{reflect: 0.9}}\n"
          "lights: [point: {position: [4, 6, 3], intensity: 20}]\nobjects:\n- plane: {}\n",
          out);
    for (int i = 0; i < 48; i++)
        fprintf(out, "- sphere: {center: [%d, %d, %d], radius: 0.4, material: %s}\n", i % 7 - 3,
                i % 3 + 1, i % 5 - 2, materials[i % 4]);
    fclose(out);
    const lr_render_options options[] = {
        {.tile_size = 8, .chunk_rays = 64},
        {.tile_size = 33, .chunk_rays = 2000, .storage_loads = true},
        {.single_rays = true},
        {.leaf_size = 7},
    };
    picture whole = render_text(*state, text, NULL);
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        picture cut = render_text(*state, text, &options[i]);
        assert_string_equal(cut.stats.hash, whole.stats.hash);
        assert_int_equal(cut.stats.bounced.traced, whole.stats.bounced.traced);
        assert_int_equal(cut.stats.shadow.hit, whole.stats.shadow.hit);
        free_picture(&cut);
    }
    assert_true(whole.stats.bounced.traced > 0 && whole.stats.shadow.hit > 0);
    free_picture(&whole);
}

static void test_storage_loads_of_one_tile(void **state)
{
    char texel[65], storage[65];
    lr_render_options options = {.samples = 1, .has_depth = true, .depth = 0};
    hash_of(*state, &options, texel);
    options.storage_loads = true;
    hash_of(*state, &options, storage);
    assert_string_equal(texel, storage);
}

/* A crop is that part of the whole picture, bit for bit. */
static void test_crop(void **state)
{
    lr_render_options options = {.integrator = LR_INTEGRATOR_PATH};
    picture whole = render_text(*state, scene, &options);
    options.crop.x = 13;
    options.crop.y = 9;
    options.crop.width = 30;
    options.crop.height = 21;
    for (uint32_t tile_size = 0; tile_size <= 7; tile_size += 7) {
        options.tile_size = tile_size;
        picture part = render_text(*state, scene, &options);
        assert_int_equal(part.image.width, 30);
        assert_int_equal(part.image.height, 21);
        for (uint32_t y = 0; y < 21; y++)
            assert_memory_equal(&part.image.pixels[3 * 30 * y],
                                &whole.image.pixels[3 * (61 * (y + 9) + 13)],
                                3 * 30 * sizeof(float));
        free_picture(&part);
    }
    free_picture(&whole);
}

/* Another device in the same process, and another picture in between. */
static void test_repetition(void **state)
{
    char first[65], second[65], other[65], fresh[65];
    hash_of(*state, NULL, first);
    hash_of(*state, &(lr_render_options){.seed = 8, .has_seed = true}, other);
    hash_of(*state, NULL, second);
    lr_device *device = open_device();
    hash_of(device, NULL, fresh);
    close_device(device);
    assert_string_equal(first, second);
    assert_string_equal(first, fresh);
    assert_string_not_equal(first, other);
}

static void test_statistics_do_not_depend_on_the_cut(void **state)
{
    picture a = render_text(*state, scene, NULL);
    picture b = render_text(*state, scene, &(lr_render_options){.tile_size = 8, .chunk_rays = 64});
    assert_int_equal(a.stats.primary.traced, 61 * 47 * 3);
    assert_int_equal(a.stats.primary.hit, b.stats.primary.hit);
    assert_int_equal(a.stats.reflected.traced, b.stats.reflected.traced);
    assert_int_equal(a.stats.refracted.traced, b.stats.refracted.traced);
    assert_int_equal(a.stats.reflected.hit, b.stats.reflected.hit);
    assert_int_equal(a.stats.refracted.hit, b.stats.refracted.hit);
    assert_int_equal(a.stats.shadow.traced, b.stats.shadow.traced);
    assert_int_equal(a.stats.shadow.hit, b.stats.shadow.hit);
    assert_int_equal(a.stats.passed, b.stats.passed);
    assert_int_equal(a.stats.dropped_depth, b.stats.dropped_depth);
    assert_int_equal(a.stats.dropped_weight, b.stats.dropped_weight);
    assert_true(a.stats.passed > 0 && a.stats.dropped_depth > 0);
    free_picture(&a);
    free_picture(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tiles_and_chunks),
        cmocka_unit_test(test_paths_through_trees),
        cmocka_unit_test(test_storage_loads_of_one_tile),
        cmocka_unit_test(test_crop),
        cmocka_unit_test(test_repetition),
        cmocka_unit_test(test_statistics_do_not_depend_on_the_cut),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
