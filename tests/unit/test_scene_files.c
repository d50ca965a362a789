/* The files that a scene consists of, as they are listed while it loads: also those of a scene that
 * is broken. */
#include "import_tests.h"

static bool lists(const lr_file_list *files, const char *name)
{
    char path[256];
    file_path(path, name);
    for (uint32_t i = 0; i < files->count; i++)
        if (strcmp(files->files[i].path, path) == 0) {
            struct stat info;
            bool there = stat(path, &info) == 0;
            return files->files[i].stamp.inode == (there ? info.st_ino : 0) &&
                   files->files[i].stamp.size == (there ? (uint64_t)info.st_size : 0);
        }
    return false;
}

/* Loads a file and compares what was listed with `names`, between spaces. */
static void expect_files(const char *name, const char *names, lr_status expected)
{
    char path[256], copy[256], *report = NULL;
    lr_file_list files = {0};
    lr_scene *scene = NULL;
    lr_error error = {0};
    file_path(path, name);
    lr_status status =
        lr_scene_load(path, &(lr_load_options){.files = &files}, &scene, &report, &error);
    if (status != expected)
        fail_msg("%s: %s\n%s", name, error.message, report ? report : "");
    uint32_t count = 0;
    snprintf(copy, sizeof copy, "%s", names);
    for (char *word = strtok(copy, " "); word; word = strtok(NULL, " "), count++)
        if (!lists(&files, word))
            fail_msg("%s: %s is not listed", name, word);
    if (files.count != count)
        for (uint32_t i = 0; i < files.count; i++)
            print_error("%s\n", files.files[i].path);
    assert_int_equal(files.count, count);
    free(report);
    lr_scene_destroy(scene);
    lr_file_list_free(&files);
    assert_null(files.files);
    assert_int_equal(files.count, 0);
}

#define OBJ "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n"
#define REST "camera: {}\nobjects: [{sphere: {}}"

static void test_files(void **state)
{
    (void)state;
    put_text("a.obj", OBJ);
    put_text("a.mtl", "newmtl m\nmap_Kd p.ppm\n");
    put_text("p.ppm", "P3 1 1 255 9 9 9\n");
    put_triangle_bin();
    put_text("t.gltf", GLTF("{\"mesh\": 0}", ", \"material\": 0",
                            "\"materials\": [{\"pbrMetallicRoughness\": {\"baseColorTexture\": "
                            "{\"index\": 0}}}], \"textures\": [{\"source\": 0}], "
                            "\"images\": [{\"uri\": \"p.ppm\"}],"));
    expect_files("a.obj", "a.obj a.mtl p.ppm", LR_OK);
    expect_files("t.gltf", "t.gltf t.bin p.ppm", LR_OK);
    put_text("s.yaml", REST ",{mesh: {file: a.obj}},{mesh: {file: t.gltf}},{mesh: {file: a.obj}}]\n"
                            "materials: {m: {color: {image: p.ppm}}}\n");
    expect_files("s.yaml", "s.yaml a.obj a.mtl p.ppm t.gltf t.bin", LR_OK);
}

static void test_broken(void **state)
{
    (void)state;
    /* What is missing now may come. */
    expect_files("none.yaml", "none.yaml", LR_ERROR_FILE);
    expect_files("none.ply", "none.ply", LR_ERROR_FILE);
    put_text("s.yaml", REST "\n");
    expect_files("s.yaml", "s.yaml", LR_ERROR_SCENE);
    put_text("s.nff", "v\n");
    expect_files("s.nff", "s.nff", LR_ERROR_SCENE);
    put_text("bad.ply", "ply\n");
    put_text("bad.png", "no");
    put_text("s.yaml", REST ", {mesh: {file: none.ply}}, {mesh: {file: bad.ply}}, "
                            "{sphere: {material: {color: {image: bad.png}}}}, "
                            "{sphere: {material: {color: {image: sub/none.png}}}}, "
                            "{mesh: {file: /etc/none.ply}}, {mesh: {file: a.xyz}}]\n");
    expect_files("s.yaml", "s.yaml none.ply bad.ply bad.png sub/none.png", LR_ERROR_SCENE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_files),
        cmocka_unit_test(test_broken),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
