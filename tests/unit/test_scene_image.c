/* Pictures as colours in the scene language. */
#define _GNU_SOURCE
#include "scene_tests.h"
#include "temporary_folder.h"

#include "base/file.h"

static void save(const char *name, const char *bytes, size_t size)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_int_equal(lr_file_write(path, bytes, size, NULL), LR_OK);
}

/* A scene in the folder with these materials, each on a sphere; the report if it is wrong. */
static char *load(const char *materials, lr_scene **scene)
{
    char text[2048], path[128], *report;
    snprintf(text, sizeof text, "camera: {}\nobjects:\n- sphere: {}\nmaterials:\n%s", materials);
    save("scene.yaml", text, strlen(text));
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    lr_error error = {0};
    lr_status status = lr_scene_load(path, NULL, scene, &report, &error);
    assert_int_equal(status, report ? LR_ERROR_SCENE : LR_OK);
    return report;
}

static void test_image(void **state)
{
    (void)state;
    static const char ppm[] = "P6 2 1 255\n\1\2\3\4\5\6";
    save("a.ppm", ppm, sizeof ppm - 1);
    lr_scene *scene;
    char *report = load("  a: {color: {image: a.ppm}}\n"
                        "  b: {color: {image: a.ppm, tint: [1, 0.5, 0], wrap: mirror},"
                        " alpha_cutoff: 0.25, one_sided: true, emission: [1, 2, 3]}\n"
                        "  c: {color: {wrap: repeat, image: ./a.ppm}}\n"
                        "  d: {color: {image: a.ppm, wrap: clamp}}\n"
                        "  e: {color: {image: a.ppm, wrap: mirror}}\n",
                        &scene);
    if (report)
        fail_msg("%s", report);
    static const uint32_t textures[] = {0, 1, 2, 3, 1};
    static const lr_wrap wraps[] = {LR_WRAP_REPEAT, LR_WRAP_MIRROR, LR_WRAP_REPEAT, LR_WRAP_CLAMP};
    assert_int_equal(scene->texture_count, 4);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(scene->materials[i].color.kind, LR_PATTERN_IMAGE);
        assert_int_equal(scene->materials[i].color.texture, textures[i]);
    }
    for (int i = 0; i < 4; i++) {
        const lr_texture *texture = &scene->textures[i];
        assert_int_equal(texture->wrap_u, wraps[i]);
        assert_int_equal(texture->wrap_v, wraps[i]);
        assert_int_equal(texture->width, 2);
        assert_memory_equal(texture->bytes, "\1\2\3\377\4\5\6\377", 8);
    }
    const lr_material *plain = &scene->materials[0], *full = &scene->materials[1];
    assert_near(plain->color.colors[0].y, 1, 0);
    assert_near(plain->alpha_cutoff, 0, 0);
    assert_near(plain->emission.y, 0, 0);
    assert_false(plain->one_sided);
    assert_near(full->color.colors[0].y, 0.5, 0);
    assert_near(full->alpha_cutoff, 0.25, 0);
    assert_near(full->emission.y, 2, 0);
    assert_true(full->one_sided);
    lr_scene_destroy(scene);
}

static void test_refusals(void **state)
{
    (void)state;
    static const char cut[] = "P6 2 1 255\n\1\2\3";
    save("cut.ppm", cut, sizeof cut - 1);
    static const struct {
        const char *material, *message;
    } rows[] = {
        {"{image: none.png}", "none.png: No such file or directory"},
        {"{image: cut.ppm}", "cut.ppm: truncated: the file ends after 14 bytes"},
        {"{image: scene.yaml}", "scene.yaml: not a picture in a known format"},
        {"{image: /dev/zero}", "/dev/zero is an absolute path"},
        {"{image: ../a.png}", "../a.png"},
        {"{image: [a.png]}", "image is a list of 1, expected a text"},
        {"{image: a.png, wrap: round}", "expected repeat, clamp or mirror"},
        {"{imag: a.png}", "did you mean \"image\"?"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[256];
        lr_scene *scene;
        snprintf(text, sizeof text, "  a: {color: %s}\n", rows[i].material);
        char *report = load(text, &scene);
        if (!report || !strstr(report, rows[i].message) || !strstr(report, "scene.yaml:5:"))
            fail_msg("%s: expected \"%s\", got \"%s\"", rows[i].material, rows[i].message,
                     report ? report : "a scene");
        free(report);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_image),
                                       cmocka_unit_test(test_refusals)};
    return cmocka_run_group_tests(tests, setup, teardown);
}
