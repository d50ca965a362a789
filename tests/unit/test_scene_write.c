/* Scenes that are written and read again are the same; meshes are what their PLY files say. */
#include "scene_tests.h"

#include "base/file.h"
#include "scene/camera.h"
#include "scene/nff.h"
#include "temporary_folder.h"

#include <dirent.h>

static char *path_of(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static char *write_scene(const lr_scene *scene, const char *name, lr_scene_format format)
{
    char *notes, *text;
    size_t length;
    lr_error error = {0};
    if (lr_scene_write(scene, path_of(name), format, &notes, &error) != LR_OK)
        fail_msg("%s", error.message);
    free(notes);
    assert_int_equal(lr_file_read(path_of(name), 1 << 20, &text, &length, NULL), LR_OK);
    return text;
}

/* Equal but for rounding where the language says the sum or the direction of two values. */
static void near_vec3(const char *what, lr_vec3 a, lr_vec3 b)
{
    double scale = 1e-15 * (1 + lr_vec3_length(a));
    if (!(lr_vec3_length(lr_vec3_sub(a, b)) <= 4 * scale))
        fail_msg("%s: %.17g %.17g %.17g, then %.17g %.17g %.17g", what, a.x, a.y, a.z, b.x, b.y,
                 b.z);
}

#define SAME(member) assert_memory_equal(&a->member, &b->member, sizeof a->member)

static void compare_materials(const lr_material *a, const lr_material *b)
{
    if (a->name)
        assert_string_equal(a->name, b->name);
    SAME(color.kind);
    SAME(color.colors[0]);
    SAME(color.object_space);
    if (a->color.kind != LR_PATTERN_NONE && a->color.kind != LR_PATTERN_IMAGE) {
        SAME(color.colors[1]);
        SAME(color.size);
        SAME(color.origin);
        near_vec3("direction", a->color.direction, b->color.direction);
    }
    SAME(ambient);
    SAME(diffuse);
    SAME(specular);
    SAME(reflect);
    SAME(transmit);
    SAME(emission);
    SAME(shininess);
    SAME(highlight);
    SAME(ior);
    SAME(fresnel);
    SAME(absorption);
    SAME(priority);
    SAME(alpha_cutoff);
    SAME(one_sided);
    SAME(color.texture);
    SAME(model);
    SAME(roughness);
    SAME(metal);
    SAME(eta);
    SAME(k);
    SAME(metallic);
    SAME(transmission);
    SAME(clearcoat);
    SAME(clearcoat_roughness);
    SAME(sheen);
    SAME(sheen_roughness);
    for (int i = 0; i < LR_MAP_COUNT; i++) {
        SAME(maps[i].given);
        SAME(maps[i].channel);
        SAME(maps[i].texture);
        SAME(maps[i].amount);
    }
}

static void compare_objects(const lr_object *a, const lr_object *b)
{
    SAME(kind);
    SAME(material);
    SAME(shadow);
    SAME(open);
    SAME(transformed);
    SAME(to_world);
    switch (a->kind) {
    case LR_SPHERE:
        SAME(sphere);
        break;
    case LR_PLANE:
        SAME(plane);
        break;
    case LR_BOX:
        SAME(box);
        break;
    case LR_DISK:
        SAME(disk);
        break;
    case LR_RECTANGLE:
        SAME(rectangle);
        break;
    case LR_CYLINDER:
    case LR_CONE:
        SAME(cone);
        break;
    case LR_TRIANGLE:
        SAME(triangle);
        break;
    case LR_MESH:
        SAME(mesh);
        break;
    }
}

static void compare_lights(const lr_light *a, const lr_light *b)
{
    SAME(kind);
    SAME(color);
    SAME(intensity);
    SAME(falloff);
    SAME(position);
    SAME(direction);
    SAME(angle);
    SAME(inner);
    SAME(shadows);
}

static void compare_cameras(const lr_camera *a, const lr_camera *b)
{
    assert_int_equal(a->name != NULL, b->name != NULL);
    if (a->name)
        assert_string_equal(a->name, b->name);
    SAME(from);
    SAME(to);
    SAME(up);
    SAME(fov);
    SAME(fov_to_centers);
    SAME(projection);
    SAME(height);
    SAME(aperture);
    SAME(focus);
    SAME(blades);
    SAME(blade_rotation);
    SAME(shutter);
    SAME(moves);
    assert_true(lr_camera_same(a, b));
}

static void compare_textures(const lr_texture *a, const lr_texture *b)
{
    SAME(width);
    SAME(height);
    SAME(wrap_u);
    SAME(wrap_v);
    SAME(texels);
    size_t texels = (size_t)a->width * a->height;
    if (a->bytes)
        assert_memory_equal(a->bytes, b->bytes, 4 * texels);
    else
        assert_memory_equal(a->floats, b->floats, 3 * sizeof(float) * texels);
}

static void compare(const lr_scene *a, const lr_scene *b)
{
    SAME(camera_count);
    SAME(material_count);
    SAME(object_count);
    SAME(light_count);
    SAME(texture_count);
    SAME(default_light);
    SAME(ambient);
    SAME(background.colors[0]);
    SAME(background.colors[1]);
    SAME(background.kind);
    SAME(background.intensity);
    SAME(background.rotate);
    SAME(background.turbidity);
    SAME(background.ground);
    SAME(background.sun);
    near_vec3("up", a->background_up, b->background_up);
    SAME(fog_density);
    if (a->fog_density > 0)
        SAME(fog_color);
    SAME(image.width);
    SAME(image.height);
    SAME(image.samples);
    SAME(image.depth);
    SAME(image.seed);
    SAME(image.min_weight);
    SAME(image.exposure);
    SAME(image.tone);
    SAME(image.white);
    for (uint32_t i = 0; i < a->camera_count; i++)
        compare_cameras(&a->cameras[i], &b->cameras[i]);
    for (uint32_t i = 0; i < a->material_count; i++)
        compare_materials(&a->materials[i], &b->materials[i]);
    for (uint32_t i = 0; i < a->texture_count; i++)
        compare_textures(&a->textures[i], &b->textures[i]);
    for (uint32_t i = 0; i < a->object_count; i++)
        compare_objects(&a->objects[i], &b->objects[i]);
    for (uint32_t i = 0; i < a->light_count; i++)
        compare_lights(&a->lights[i], &b->lights[i]);
}

static void round_trip(const lr_scene *scene)
{
    free(write_scene(scene, "scene.yaml", LR_SCENE_YAML));
    lr_scene *again;
    char *report;
    lr_error error = {0};
    if (lr_scene_load(path_of("scene.yaml"), NULL, &again, &report, &error) != LR_OK)
        fail_msg("%s\n%s", error.message, report);
    compare(scene, again);
    lr_scene_destroy(again);
}

static void test_all_scenes(void **state)
{
    (void)state;
    DIR *scenes = opendir(SOURCE_DIR "/scenes");
    assert_non_null(scenes);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(scenes)) != NULL;) {
        if (!strstr(entry->d_name, ".yaml"))
            continue;
        char path[1024], *report;
        lr_scene *scene;
        snprintf(path, sizeof path, SOURCE_DIR "/scenes/%s", entry->d_name);
        assert_int_equal(lr_scene_load(path, NULL, &scene, &report, NULL), LR_OK);
        round_trip(scene);
        lr_scene_destroy(scene);
        count++;
    }
    closedir(scenes);
    assert_true(count >= 20);
}

/* Names and values that YAML could take for something else, and all that the scenes leave at its
 * default. */
static void test_corners(void **state)
{
    (void)state;
    lr_scene *scene = parse_good(
        "cameras:\n  'null': {fov_to_centers: true, fov: 1e-300}\n  \"1 \\\"a\\\\\\n\\t\": {up: "
        "[1e12, "
        "0, -0.1]}\n  'a: b': {}\n  'é#': {}\n  material1: {projection: orthographic, "
        "height: 0.1}\n  lens: {aperture: 0.02, focus: 3.3, blades: 7, blade_rotation: -5.5}\n"
        "  moving: {from: {keys: {0: [0, 1, 5], 0.7: [0.1, 0.7, 1.9]}}, fov: {keys: {0: 40, 1: "
        "17}}, "
        "shutter: 0.3}\n"
        "image: {min_weight: 0.30000000000000004, exposure: -1.5, seed: 4294967295, tone: aces, "
        "white: 3200.5}\n"
        "background: {gradient: [0.1, [0, 0, 1e-30]]}\nfog: {density: 1e-9, color: 0.1}\n"
        "up: [1, 2, 3]\nlights: []\n"
        "materials: {'yes': {}, material: {priority: -7}, material_1: {highlight: phong},\n"
        "  glass: {model: dielectric, roughness: 0.1, ior: 1.3, priority: 2},\n"
        "  black glass: {model: thin_glass, transmit: 0},\n"
        "  mixed: {model: mix, first: gold, second: {model: mix, first: 'yes', second: metal},\n"
        "    weight: {rings: [0.1, 1], size: 0.3, space: object}, emission: 0.1},\n"
        "  gold: {model: conductor, metal: gold, roughness: 0.3, color: [1, 0.9, 0.8]},\n"
        "  metal: {model: conductor, eta: [1, 2, 3], k: 4},\n"
        "  cloth: {model: pbr, metallic: 0.1, transmission: 0.2, clearcoat: 0.3,\n"
        "    clearcoat_roughness: 0.4, sheen: [0.5, 0.6, 0.7], sheen_roughness: 0.8}}\n"
        "objects:\n- sphere: {material: {ior: 1.1}, shadow: false}\n"
        "- cone: {from: [0, 0, 0], to: [0, 0, 1e-19], open: true, material: 'yes'}\n"
        "- plane: {material: {color: {stripes: [red, blue], space: object, direction: [1, 2, "
        "3]}}}\n"
        "- triangle: {a: [0, 0, 0], b: [1, 0, 0], c: [0, 1e-5, 0], rotate: [10, 20, 30], "
        "scale: [-1, 2, 3], material: material_1}\n");
    round_trip(scene);
    char *text = write_scene(scene, "scene.yaml", LR_SCENE_YAML);
    assert_non_null(strstr(text, "  \"yes\": {"));
    assert_non_null(strstr(text, "  material__11: {")); /* no other's name begins so */
    free(text);
    lr_scene_destroy(scene);
}

static void test_ply(void **state)
{
    (void)state;
    const char *nff = "v\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 45\nhither 0\nresolution 32 20\n"
                      "f 1 1 1 1 0 1 0 1\npp 3 1 0 0 0 0 1 0 2 0 0 0 1 0 0 0 0 1 0\n"
                      "p 4 0 0 0 1 0 0 1 1 0 0 1 0\n";
    lr_scene *scene;
    char *report, *text, *ply, *notes;
    size_t size;
    assert_int_equal(lr_nff_read(nff, strlen(nff), "s.nff", &scene, &report, NULL), LR_OK);
    text = write_scene(scene, "a.b.yaml", LR_SCENE_YAML);
    assert_non_null(strstr(text, "# from s.nff, written by lavaray "));
    assert_non_null(strstr(text, "fov: 45, fov_to_centers: true}"));
    assert_non_null(strstr(text, "- mesh: {file: \"a.b-1.ply\", material: material1}"));
    assert_non_null(strstr(text, "- mesh: {file: \"a.b-2.ply\", material: material1}"));
    free(text);
    assert_int_equal(lr_file_read(path_of("a.b-2.ply"), 1 << 20, &ply, &size, NULL), LR_OK);
    const char *header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
                         "property float x\nproperty float y\nproperty float z\n"
                         "property float nx\nproperty float ny\nproperty float nz\n"
                         "element face 1\nproperty list uchar uint vertex_indices\nend_header\n";
    assert_memory_equal(ply, header, strlen(header));
    assert_int_equal(size, strlen(header) + 3 * 6 * 4 + 13);
    static const unsigned char one[] = {0, 0, 0x80, 0x3F}, two[] = {0, 0, 0, 0x40};
    const char *body = ply + strlen(header);
    /* Corner 1 is the first ear, so its triangle is 0, 1, 2: x of vertex 0, y of vertex 1. */
    assert_memory_equal(body, one, 4);
    assert_memory_equal(body + 24 + 4, two, 4);
    static const unsigned char face[] = {3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0};
    assert_memory_equal(body + 72, face, sizeof face);
    free(ply);

    /* Read again they are the same meshes. */
    lr_scene *again;
    assert_int_equal(lr_scene_load(path_of("a.b.yaml"), NULL, &again, &report, NULL), LR_OK);
    assert_int_equal(again->mesh_count, 2);
    for (int i = 0; i < 2; i++) {
        const lr_mesh *a = &scene->meshes[i], *b = &again->meshes[i];
        SAME(vertex_count);
        SAME(triangle_count);
        SAME(closed);
        assert_memory_equal(a->positions, b->positions, 12 * a->vertex_count);
        assert_memory_equal(a->triangles, b->triangles, 12 * a->triangle_count);
        assert_int_equal(a->normals != NULL, b->normals != NULL);
        if (a->normals)
            assert_memory_equal(a->normals, b->normals, 12 * a->vertex_count);
    }
    lr_scene_destroy(again);

    /* The same again replaces them; another scene does not. */
    free(write_scene(scene, "a.b.yaml", LR_SCENE_YAML));
    assert_int_equal(remove(path_of("a.b.yaml")), 0);
    lr_error error = {0};
    assert_int_equal(lr_scene_write(scene, path_of("a.b.yaml"), LR_SCENE_YAML, &notes, &error),
                     LR_ERROR_FILE);
    assert_null(notes);
    assert_non_null(strstr(error.message, "a.b-1.ply: exists already"));
    assert_int_equal(lr_file_read(path_of("a.b.yaml"), 100, &text, &size, NULL), LR_ERROR_FILE);
    lr_scene_destroy(scene);
}

static void test_notes(void **state)
{
    (void)state;
    lr_scene *scene = parse_good("camera: {}\nmaterials: {a: {priority: 1}, b: {priority: 2}, "
                                 "c: {specular: [1, 0, 0]}}\nobjects: [{sphere: {}}]\n");
    char *notes;
    assert_int_equal(lr_scene_write(scene, path_of("a.pov"), LR_SCENE_POVRAY, &notes, NULL), LR_OK);
    assert_string_equal(notes, "priorities of media are left out (2)\n"
                               "coloured highlights are written as white (1)\n");
    free(notes);
    assert_int_equal(lr_scene_write(scene, path_of("a.yaml"), LR_SCENE_YAML, &notes, NULL), LR_OK);
    assert_null(notes);
    lr_scene_destroy(scene);
}

static void test_formats(void **state)
{
    (void)state;
    lr_scene_format format;
    assert_true(lr_scene_format_from_path("a.YAML", &format) && format == LR_SCENE_YAML);
    assert_true(lr_scene_format_from_path("a.b.yml", &format) && format == LR_SCENE_YAML);
    assert_true(lr_scene_format_from_path("/x/a.Pov", &format) && format == LR_SCENE_POVRAY);
    assert_true(lr_scene_format_from_path("a.dat", &format) && format == LR_SCENE_TACHYON);
    assert_false(lr_scene_format_from_path("pov", &format));
    assert_false(lr_scene_format_from_path("a.pov/b", &format));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_scenes), cmocka_unit_test(test_corners),
        cmocka_unit_test(test_ply),        cmocka_unit_test(test_notes),
        cmocka_unit_test(test_formats),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
