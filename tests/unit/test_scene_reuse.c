/* Scenes that are loaded again after an edit: what is taken from the one before, what is not, and
 * that it is the scene that a first load would bring. */
#include "import_tests.h"

#include "base/file.h"
#include "scene/part.h"

#include <pthread.h>

#define OBJ "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n"
#define MTL "newmtl m\nmap_Kd p.ppm\n"
#define SCENE                                                                                      \
    "camera: {}\nobjects:\n- sphere: {material: {color: {image: q.ppm}}}\n- mesh: {file: a.obj}\n" \
    "- mesh: {file: t.ply, material: {color: [%s, 0, 0]}}\n"

static const char ply[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                          "property float y\nproperty float z\nelement face 1\n"
                          "property list uchar int vertex_indices\nend_header\n"
                          "0 0 0\n2 0 0\n0 2 %d\n3 0 1 2\n";

static void put_scene(const char *red)
{
    char text[500];
    snprintf(text, sizeof text, SCENE, red);
    put_text("s.yaml", text);
}

static void put_ply(int z)
{
    char text[500];
    snprintf(text, sizeof text, ply, z);
    put_text("t.ply", text);
}

/* Until what was written just now is no longer young. */
static void rest(void)
{
    usleep(30000);
}

static lr_scene *load_after(const lr_scene *previous, lr_file_list *files)
{
    char path[256], *report = NULL;
    lr_scene *scene = NULL;
    lr_error error = {0};
    lr_load_options options = {.previous = previous, .files = files};
    file_path(path, "s.yaml");
    if (lr_scene_load(path, &options, &scene, &report, &error))
        fail_msg("%s\n%s", error.message, report ? report : "");
    return scene;
}

/* Also what is noted, and the files as they are on the disk. */
static void assert_as_new(const lr_scene *scene, const lr_file_list *files)
{
    lr_scene_facts a, b;
    lr_file_list new_files = {0};
    lr_scene *new_scene = load_after(NULL, &new_files);
    lr_scene_get_facts(scene, &a);
    lr_scene_get_facts(new_scene, &b);
    assert_string_equal(a.sha256, b.sha256);
    assert_int_equal(a.bytes, b.bytes);
    assert_int_equal(scene->note_count, new_scene->note_count);
    for (uint32_t i = 0; i < scene->note_count; i++)
        assert_string_equal(scene->notes[i], new_scene->notes[i]);
    assert_int_equal(files->count, new_files.count);
    for (uint32_t i = 0; i < files->count; i++) {
        const lr_file_stamp *stamp = &files->files[i].stamp, *other = NULL;
        for (uint32_t k = 0; k < files->count; k++)
            if (!strcmp(files->files[i].path, new_files.files[k].path))
                other = &new_files.files[k].stamp;
        assert_non_null(other);
        assert_true(stamp->inode == other->inode && stamp->modified == other->modified);
    }
    lr_file_list_free(&new_files);
    lr_scene_destroy(new_scene);
}

/* Loads the scene again: which of q.ppm, p.ppm, a.obj, t.ply are read again, as a word such as
 * "-p-t". The scene before is gone afterwards. */
static lr_scene *edit(lr_scene *before, const char *expected)
{
    lr_file_list files = {0};
    lr_scene *after = load_after(before, &files);
    char read[5] = "qpat";
    assert_int_equal(after->texture_count, 2);
    assert_int_equal(after->mesh_count, 2);
    for (int i = 0; i < 2; i++) {
        if (after->textures[i].bytes == before->textures[i].bytes)
            read[i] = '-';
        if (after->meshes[i].positions == before->meshes[i].positions)
            read[2 + i] = '-';
    }
    assert_string_equal(read, expected);
    lr_scene_destroy(before);
    assert_as_new(after, &files);
    lr_file_list_free(&files);
    return after;
}

static lr_scene *first(void)
{
    put_text("a.obj", OBJ);
    put_text("a.mtl", MTL);
    put_text("p.ppm", "P3 1 1 255 9 9 9\n");
    put_text("q.ppm", "P3 1 1 255 7 7 7\n");
    put_ply(0);
    put_scene("1");
    rest();
    return load_after(NULL, NULL);
}

static void test_edits(void **state)
{
    (void)state;
    lr_scene *scene = first();
    scene = edit(scene, "----");
    put_scene("0.5");
    rest();
    scene = edit(scene, "----");
    put_ply(1);
    rest();
    scene = edit(scene, "---t");
    put_text("q.ppm", "P3 1 1 255 1 2 3\n");
    rest();
    scene = edit(scene, "q---");
    /* The picture of a mesh's material does not touch the mesh. */
    put_text("p.ppm", "P3 1 1 255 4 5 6\n");
    rest();
    scene = edit(scene, "-p--");
    scene = edit(scene, "----");
    put_text("a.mtl", "newmtl m\nmap_Kd p.ppm\nKa 1 1 1\n");
    rest();
    scene = edit(scene, "--a-");
    put_text("a.obj", OBJ "v 0 0 9\n");
    rest();
    scene = edit(scene, "--a-");
    /* Written a moment ago, it might change once more without a trace. */
    put_ply(2);
    lr_scene *young = load_after(scene, NULL);
    put_ply(3);
    lr_scene_destroy(scene);
    scene = edit(young, "---t");
    lr_scene_destroy(scene);
}

/* What was missing and noted comes, and what was there goes. */
static void test_missing(void **state)
{
    (void)state;
    lr_scene *before = first(), *after;
    char path[256];
    lr_file_list files = {0};
    file_path(path, "p.ppm");
    assert_int_equal(unlink(path), 0);
    after = load_after(before, &files);
    assert_int_equal(after->texture_count, 1);
    assert_true(has_note(after, "without its texture"));
    assert_as_new(after, &files);
    lr_scene_destroy(before);
    before = after;
    lr_file_list_free(&files);
    /* Still missing: the part of the mesh is as good as it was. */
    after = load_after(before, &files);
    assert_true(after->meshes[0].positions == before->meshes[0].positions);
    assert_true(has_note(after, "without its texture"));
    assert_as_new(after, &files);
    lr_scene_destroy(before);
    before = after;
    lr_file_list_free(&files);
    put_text("p.ppm", "P3 1 1 255 4 5 6\n");
    after = load_after(before, &files);
    assert_int_equal(after->texture_count, 2);
    assert_as_new(after, &files);
    lr_file_list_free(&files);
    lr_scene_destroy(after);
    lr_scene_destroy(before);
}

/* A picture inside of a model goes with the model. */
static void test_embedded(void **state)
{
    (void)state;
    put_triangle_bin();
    put_text("t.gltf",
             GLTF("{\"mesh\": 0}", ", \"material\": 0",
                  "\"materials\": [{\"pbrMetallicRoughness\": {\"baseColorTexture\": "
                  "{\"index\": 0}}}], \"textures\": [{\"source\": 0}], \"images\": [{\"uri\": "
                  "\"data:image/png;base64,UDMgMSAxIDI1NSA0IDUgNgo=\"}],"));
    put_text("s.yaml", "camera: {}\nobjects: [{mesh: {file: t.gltf}}]\n");
    rest();
    lr_scene *before = load_after(NULL, NULL);
    lr_file_list files = {0};
    lr_scene *after = load_after(before, &files);
    assert_int_equal(before->texture_count, 1);
    assert_int_equal(after->texture_count, 1);
    assert_true(after->textures[0].bytes == before->textures[0].bytes);
    lr_scene_destroy(before);
    assert_as_new(after, &files);
    lr_file_list_free(&files);
    lr_scene_destroy(after);
}

/* Limits and permissions are those of the load, not of the one before. */
static void test_limits(void **state)
{
    (void)state;
    char path[256], *report = NULL;
    lr_scene *scene = first(), *after = NULL;
    file_path(path, "s.yaml");
    lr_load_options options = {.previous = scene, .max_triangles = 1};
    assert_int_equal(lr_scene_load(path, &options, &after, &report, NULL), LR_ERROR_SCENE);
    assert_non_null(strstr(report, "--max-triangles"));
    free(report);
    options.max_triangles = 2;
    assert_int_equal(lr_scene_load(path, &options, &after, &report, NULL), LR_OK);
    lr_scene_destroy(after);
    options.allow_path = true;
    assert_int_equal(lr_scene_load(path, &options, &after, &report, NULL), LR_OK);
    assert_true(after->meshes[0].positions != scene->meshes[0].positions);
    lr_scene_destroy(after);
    lr_scene_destroy(scene);
}

static void *destroy(void *scene)
{
    lr_scene_destroy(scene);
    return NULL;
}

/* Many scenes with the same parts go in any order on several threads. */
static void test_threads(void **state)
{
    (void)state;
    lr_scene *scenes[8] = {first()};
    pthread_t threads[8];
    for (int i = 1; i < 8; i++)
        scenes[i] = load_after(scenes[i / 2], NULL);
    assert_int_equal(atomic_load(&scenes[0]->parts[0]->users), 8);
    for (int i = 0; i < 8; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, destroy, scenes[(i * 3 + 1) % 8]), 0);
    for (int i = 0; i < 8; i++)
        assert_int_equal(pthread_join(threads[i], NULL), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edits),    cmocka_unit_test(test_missing),
        cmocka_unit_test(test_embedded), cmocka_unit_test(test_limits),
        cmocka_unit_test(test_threads),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
