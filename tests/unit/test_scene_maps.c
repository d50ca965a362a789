/* Pictures of materials that are not their colour: in scenes, in glTF and OBJ files, and what is
 * wrong with them. */
#include "import_tests.h"

#include "render/light_map.h"

/* A scene whose material is `material`, in the folder. */
static lr_scene *scene_with(const char *material)
{
    char text[1024];
    snprintf(text, sizeof text, "camera: {}\nobjects: [{sphere: {material: {%s}}}]\n", material);
    put_text("s.yaml", text);
    return import_good("s.yaml");
}

static const lr_texture *texture_of(const lr_scene *scene, const lr_map *map)
{
    assert_true(map->given);
    assert_in_range(map->texture, 0, scene->texture_count - 1);
    return &scene->textures[map->texture];
}

static void test_keys(void **state)
{
    (void)state;
    put_text("a.ppm", "P3 1 1 255 10 20 30\n");
    put_text("b.ppm", "P3 1 1 255 40 50 60\n");
    lr_scene *scene = scene_with(
        "model: pbr, color: {image: a.ppm}, normal_map: a.ppm, bump_map: {image: a.ppm, height: "
        "-2, "
        "wrap: clamp}, roughness_map: a.ppm, metallic_map: {image: a.ppm, channel: alpha}, "
        "emission_map: a.ppm");
    const lr_material *m = &scene->materials[0];
    const lr_map *maps = m->maps;
    assert_int_equal(texture_of(scene, &maps[LR_MAP_NORMAL])->texels, LR_TEXELS_NORMALS);
    assert_near(maps[LR_MAP_NORMAL].amount, 1, 0);
    assert_int_equal(texture_of(scene, &maps[LR_MAP_BUMP])->texels, LR_TEXELS_NUMBERS);
    assert_int_equal(texture_of(scene, &maps[LR_MAP_BUMP])->wrap_v, LR_WRAP_CLAMP);
    assert_near(maps[LR_MAP_BUMP].amount, -2, 0);
    assert_int_equal(maps[LR_MAP_ROUGHNESS].channel, LR_CHANNEL_GREEN);
    assert_int_equal(maps[LR_MAP_METALLIC].channel, LR_CHANNEL_ALPHA);
    /* The same file for the same purpose is one texture. */
    assert_int_equal(maps[LR_MAP_ROUGHNESS].texture, maps[LR_MAP_METALLIC].texture);
    assert_int_equal(maps[LR_MAP_EMISSION].texture, m->color.texture);
    assert_int_equal(scene->texture_count, 4);
    assert_near(m->emission.y, 1, 0);
    lr_scene_destroy(scene);

    scene = scene_with("normal_map: {image: b.ppm, scale: 0.5}, emission: [0, 2, 0], "
                       "emission_map: {image: b.ppm, wrap: mirror}");
    m = &scene->materials[0];
    assert_near(m->maps[LR_MAP_NORMAL].amount, 0.5, 0);
    assert_near(m->emission.y, 2, 0);
    assert_near(m->emission.x, 0, 0);
    assert_false(m->maps[LR_MAP_BUMP].given);
    lr_scene_destroy(scene);

    scene = scene_with("emission: 0, emission_map: b.ppm");
    assert_false(scene->materials[0].maps[LR_MAP_EMISSION].given);
    lr_scene_destroy(scene);
    /* Ray trees take what has a picture of its metal for none. */
    scene = scene_with("model: pbr, metallic: 1, roughness: 0, color: gold, metallic_map: b.ppm");
    assert_near(scene->materials[0].metallic, 1, 0);
    assert_near(scene->materials[0].reflect.x, 0.04, 1e-12);
    lr_scene_destroy(scene);
}

static bool scene_fails(const char *material, const char *fragment)
{
    char text[1024];
    snprintf(text, sizeof text, "camera: {}\nobjects: [{sphere: {material: {%s}}}]\n", material);
    put_text("s.yaml", text);
    return import_fails("s.yaml", NULL, fragment);
}

static void test_errors(void **state)
{
    (void)state;
    put_text("a.ppm", "P3 1 1 255 10 20 30\n");
    assert_true(scene_fails("normal_map: none.ppm", "none.ppm"));
    assert_true(scene_fails("normal_map: [1, 2]", "{image: file}"));
    assert_true(scene_fails("normal_map: {scale: 2}", "normal_map has no \"image\""));
    assert_true(scene_fails("normal_map: {image: a.ppm, height: 2}", "unknown key \"height\""));
    assert_true(scene_fails("bump_map: {image: a.ppm, height: high}", "height"));
    assert_true(scene_fails("roughness_map: a.ppm", "no key of materials of model classic"));
    assert_true(scene_fails("model: conductor, metallic_map: a.ppm", "expected model: pbr"));
    assert_true(scene_fails("emission_map: {image: a.ppm, channel: red}", "unknown key"));
    assert_true(scene_fails("model: pbr, metallic_map: {image: a.ppm, channel: hue}",
                            "red, green, blue or alpha"));
}

#define PICTURES                                                                                   \
    "\"images\": [{\"uri\": \"mr.ppm\"}, {\"uri\": \"n.ppm\"}, {\"uri\": \"e.ppm\"}], "            \
    "\"samplers\": [{\"wrapS\": 33071, \"wrapT\": 33648}], "                                       \
    "\"textures\": [{\"source\": 0}, {\"source\": 1, \"sampler\": 0}, {\"source\": 2}], "

static void put_gltf(const char *name, const char *material)
{
    char text[4096];
    snprintf(text, sizeof text,
             GLTF("{\"mesh\": 0}", ", \"material\": 0", PICTURES "\"materials\": [%s],"), material);
    put_text(name, text);
}

static void test_gltf(void **state)
{
    (void)state;
    put_triangle_bin();
    put_text("mr.ppm", "P3 1 1 255 0 128 255\n");
    put_text("n.ppm", "P3 1 1 255 128 128 255\n");
    put_text("e.ppm", "P3 1 1 255 255 128 0\n");
    put_gltf(
        "maps.gltf",
        "{\"pbrMetallicRoughness\": {\"roughnessFactor\": 0.5, \"metallicRoughnessTexture\": "
        "{\"index\": 0}}, \"normalTexture\": {\"index\": 1, \"scale\": 0.75}, "
        "\"emissiveTexture\": {\"index\": 2}, \"emissiveFactor\": [1, 0.5, 0], \"extensions\": "
        "{\"KHR_materials_emissive_strength\": {\"emissiveStrength\": 4}}}");
    lr_scene *scene = import_good("maps.gltf");
    const lr_material *m = &scene->materials[scene->objects[0].material];
    const lr_map *maps = m->maps;
    assert_int_equal(m->model, LR_MODEL_PBR);
    assert_near(m->metallic, 1, 0);
    assert_near(m->roughness, 0.5, 0);
    assert_int_equal(maps[LR_MAP_ROUGHNESS].channel, LR_CHANNEL_GREEN);
    assert_int_equal(maps[LR_MAP_METALLIC].channel, LR_CHANNEL_BLUE);
    assert_int_equal(maps[LR_MAP_METALLIC].texture, maps[LR_MAP_ROUGHNESS].texture);
    assert_int_equal(texture_of(scene, &maps[LR_MAP_METALLIC])->texels, LR_TEXELS_NUMBERS);
    assert_int_equal(texture_of(scene, &maps[LR_MAP_METALLIC])->bytes[1], 128);
    const lr_texture *normal = texture_of(scene, &maps[LR_MAP_NORMAL]);
    assert_int_equal(normal->texels, LR_TEXELS_NORMALS);
    assert_int_equal(normal->bytes[2], 255);
    assert_int_equal(normal->wrap_u, LR_WRAP_CLAMP);
    assert_int_equal(normal->wrap_v, LR_WRAP_MIRROR);
    assert_near(maps[LR_MAP_NORMAL].amount, 0.75, 0);
    assert_int_equal(texture_of(scene, &maps[LR_MAP_EMISSION])->texels, LR_TEXELS_COLORS);
    assert_int_equal(texture_of(scene, &maps[LR_MAP_EMISSION])->bytes[1], 128);
    assert_near(m->emission.x, 4, 1e-12);
    assert_near(m->emission.y, 2, 1e-12);
    /* Ray trees see no metal. */
    assert_near(m->diffuse.x, 1, 0);
    assert_int_equal(scene->note_count, 0);
    lr_scene_destroy(scene);

    /* Without the pictures: no metal, no light, and notes. */
    put_text("mr.ppm", "no picture");
    put_text("e.ppm", "no picture");
    put_gltf("broken.gltf", "{\"pbrMetallicRoughness\": {\"metallicRoughnessTexture\": "
                            "{\"index\": 0}}, \"normalTexture\": {\"index\": 1, \"texCoord\": 1}, "
                            "\"emissiveTexture\": {\"index\": 2}, \"emissiveFactor\": [1, 1, 1]}");
    scene = import_good("broken.gltf");
    m = &scene->materials[scene->objects[0].material];
    for (int i = 0; i < LR_MAP_COUNT; i++)
        assert_false(m->maps[i].given);
    assert_near(m->metallic, 0, 0);
    assert_near(m->emission.x, 0, 0);
    assert_true(has_note(scene, "without its metallic-roughness map"));
    assert_true(has_note(scene, "without its emissive map"));
    assert_true(has_note(scene, "its normal map is not shown"));
    lr_scene_destroy(scene);
}

static void test_obj(void **state)
{
    (void)state;
    put_text("grey.ppm", "P3 2 1 255 0 0 0 255 255 255\n");
    put_text("blue.ppm", "P3 1 1 255 128 128 255\n");
    put_text("t.mtl", "newmtl a\nKd 1 1 1\nmap_Bump -bm 3 grey.ppm\n"
                      "newmtl b\nKd 1 1 1\nmap_Bump -bm 0.5 blue.ppm\n"
                      "newmtl c\nnorm blue.ppm\nmap_Ke grey.ppm\nKe 2 2 2\n");
    put_text("t.obj",
             "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
             "usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 2/2 3/3\nusemtl c\nf 1/1 2/2 3/3\n");
    lr_scene *scene = import_good("t.obj");
    assert_int_equal(scene->object_count, 3);
    const lr_material *m = &scene->materials[scene->objects[0].material];
    assert_int_equal(texture_of(scene, &m->maps[LR_MAP_BUMP])->texels, LR_TEXELS_NUMBERS);
    assert_near(m->maps[LR_MAP_BUMP].amount, 0.03, 1e-9);
    m = &scene->materials[scene->objects[1].material];
    assert_false(m->maps[LR_MAP_BUMP].given);
    assert_int_equal(texture_of(scene, &m->maps[LR_MAP_NORMAL])->texels, LR_TEXELS_NORMALS);
    assert_near(m->maps[LR_MAP_NORMAL].amount, 0.5, 1e-9);
    m = &scene->materials[scene->objects[2].material];
    assert_near(m->maps[LR_MAP_NORMAL].amount, 1, 0);
    assert_int_equal(texture_of(scene, &m->maps[LR_MAP_EMISSION])->texels, LR_TEXELS_COLORS);
    assert_near(m->emission.x, 2, 1e-12);
    assert_int_equal(scene->note_count, 0);
    lr_scene_destroy(scene);
}

/* How bright parts of a picture are: 0 only where no texel that blending reaches shines. */
static void test_light_map(void **state)
{
    (void)state;
    float texels[3 * 64 * 40] = {0};
    lr_texture texture = {.width = 64, .height = 40, .floats = texels};
    lr_light_map map;
    texels[3 * (10 * 64 + 20)] = 3e6f; /* red of 20, 10 */
    assert_true(lr_light_map_build(&texture, &map));
    double whole = lr_light_map_mean(&map, (double[2]){0, 0}, (double[2]){1, 1});
    assert_near(whole, 1e6 / (64 * 40), 1);
    assert_near(lr_light_map_mean(&map, (double[2]){-3, 0.5}, (double[2]){7, 0.6}), 0, 0);
    for (int y = 1; y < 38; y++)
        for (int x = 1; x < 62; x++) {
            /* Right in the middle of a texel: it and its neighbours are near. */
            double low[2] = {(x + 0.5) / 64, (y + 0.5) / 40}, high[2] = {low[0], low[1]};
            bool lit = lr_light_map_mean(&map, low, high) > 0;
            if (abs(x - 20) <= 1 && abs(y - 10) <= 1 && !lit)
                fail_msg("%d, %d is black", x, y);
            if ((abs(x - 20) > 12 || abs(y - 10) > 12) && lit)
                fail_msg("%d, %d is bright", x, y);
        }
    lr_light_map_free(&map);
    texels[3 * (10 * 64 + 20)] = 0;
    assert_true(lr_light_map_build(&texture, &map));
    assert_near(lr_light_map_mean(&map, (double[2]){0, 0}, (double[2]){1, 1}), 0, 0);
    lr_light_map_free(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_keys), cmocka_unit_test(test_errors),    cmocka_unit_test(test_gltf),
        cmocka_unit_test(test_obj),  cmocka_unit_test(test_light_map),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
