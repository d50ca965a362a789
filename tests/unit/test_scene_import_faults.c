/* Files of other programs that are broken or mean harm: one clear message, or a note and the rest
 * of the file; never a crash, a hang, or bytes of files elsewhere. */
#include <time.h>

#include "import_tests.h"

#define PLY_HEAD(vertices, faces)                                                                  \
    "ply\nformat ascii 1.0\nelement vertex " vertices "\nproperty float x\nproperty float y\n"     \
    "property float z\nelement face " faces                                                        \
    "\nproperty list uchar int vertex_indices\nend_header\n"
#define PLY_TRIANGLE "0 0 0\n1 0 0\n0 1 0\n"

static void test_indices(void **state)
{
    (void)state;
    put_text("i.ply", PLY_HEAD("3", "3") PLY_TRIANGLE "3 0 1 3\n3 0 1 2\n3 -1 1 2\n");
    lr_scene *scene = import_good("i.ply");
    assert_int_equal(scene->meshes[0].triangle_count, 1);
    assert_true(has_note(scene, "i.ply: mesh 0: 2 faces left out, the first is number 0: it names "
                                "vertices that there are not"));
    lr_scene_destroy(scene);
    put_text("none.ply", PLY_HEAD("3", "1") PLY_TRIANGLE "3 7 8 9\n");
    assert_true(import_fails("none.ply", NULL, "nothing in it that can be shown"));
    put_text("empty.ply", PLY_HEAD("3", "2") PLY_TRIANGLE "0\n0\n");
    assert_true(import_fails("empty.ply", NULL, "nothing in it that can be shown"));

    unsigned char bytes[44] = {0};
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint16_t indices[3] = {0, 1, 60000};
    memcpy(bytes, positions, sizeof positions);
    memcpy(bytes + 36, indices, sizeof indices);
    put_bytes("t.bin", bytes, sizeof bytes);
    put_text("i.gltf", GLTF("{\"mesh\": 0}", "", ""));
    assert_true(import_fails("i.gltf", NULL, ""));
}

static void test_numbers(void **state)
{
    (void)state;
    put_text("n.ply", PLY_HEAD("6", "4") PLY_TRIANGLE
             "nan 0 0\n0 1e13 0\n2 0 0\n3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 1 5\n");
    lr_scene *scene = import_good("n.ply");
    assert_int_equal(scene->meshes[0].triangle_count, 1);
    assert_true(has_note(scene, "2 faces left out, the first is number 1: its coordinates"));
    assert_true(has_note(scene, "1 faces left out: they have no area"));
    lr_scene_destroy(scene);
    put_triangle_bin();
    put_text("flat.gltf", GLTF("{\"children\": [1, 2]}, {\"mesh\": 0, \"scale\": [1, 1, 0], "
                               "\"name\": \"flat\"}, {\"mesh\": 0}",
                               "", ""));
    scene = import_good("flat.gltf");
    assert_int_equal(scene->object_count, 1);
    assert_true(has_note(scene, "node \"flat\": left out"));
    lr_scene_destroy(scene);
}

/* Equal positions that are no numbers, which no comparison finds equal, take no longer than others
 * (once: the square of their number, a minute here). */
static void test_many_nans(void **state)
{
    (void)state;
    enum { COUNT = 400000 };
    const char head[] = "ply\nformat binary_big_endian 1.0\nelement face 1\n"
                        "property list uchar uchar vertex_indices\nelement vertex 400003\n"
                        "property float x\nproperty float y\nproperty float z\nend_header\n"
                        "\3\0\1\2\0\0\0\0\0\0\0\0\0\0\0\0"
                        "\x3F\x80\0\0\0\0\0\0\0\0\0\0"
                        "\0\0\0\0\x3F\x80\0\0\0\0\0";
    const size_t size = sizeof head + COUNT * 3 * sizeof(float);
    char *bytes = malloc(size);
    assert_non_null(bytes);
    memset(bytes, 0xFF, size);
    memcpy(bytes, head, sizeof head);
    put_bytes("nans.ply", bytes, size);
    free(bytes);
    clock_t start = clock();
    lr_scene *scene = import_good("nans.ply");
    assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 15);
    assert_int_equal(scene->meshes[0].vertex_count, 3);
    lr_scene_destroy(scene);
}

static void test_counts(void **state)
{
    (void)state;
    put_text("v.ply", PLY_HEAD("4000000000", "1") PLY_TRIANGLE "3 0 1 2\n");
    assert_true(import_fails("v.ply", NULL, "4000000000 of vertex, the file is too short"));
    put_text("f.ply", PLY_HEAD("3", "99999999999999") PLY_TRIANGLE "3 0 1 2\n");
    assert_true(import_fails("f.ply", NULL, "too short"));
    put_text("l.ply", PLY_HEAD("3", "1") PLY_TRIANGLE "4000000000 0 1 2\n");
    assert_true(import_fails("l.ply", NULL, "a list that is longer than the file"));
    put_text("neg.ply", PLY_HEAD("-3", "1") PLY_TRIANGLE "3 0 1 2\n");
    assert_true(import_fails("neg.ply", NULL, "not understood"));
    char stl[134] = "binary";
    memset(stl + 80, 0xFF, 4);
    put_bytes("s.stl", stl, sizeof stl);
    assert_true(import_fails("s.stl", NULL, "4294967295 triangles, the file is too short"));
    put_triangle_bin();
    put_text(
        "b.gltf", GLTF_HEAD
        "\"nodes\": [{\"mesh\": 0}], \"buffers\": [{\"byteLength\": "
        "900000000000000, \"uri\": \"t.bin\"}], \"bufferViews\": "
        "[{\"buffer\": 0, \"byteLength\": 900000000000000}]," GLTF_ACCESSORS GLTF_MESH("") "}");
    assert_true(import_fails("b.gltf", NULL, "--max-memory"));
    const lr_load_options few = {.max_triangles = 1}, small = {.max_memory = 1000};
    put_text("two.ply", PLY_HEAD("4", "1") "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
    assert_true(import_fails("two.ply", &few,
                             "more than 1 triangles; allow more with "
                             "--max-triangles"));
    assert_true(import_fails("two.ply", &small, "--max-memory"));
}

/* Of the GLB file: header, JSON, BIN. */
static size_t make_glb(char *out, const char *json, size_t bin_size)
{
    uint32_t length = (uint32_t)(strlen(json) + 3) / 4 * 4;
    uint32_t total = 12 + 8 + length + 8 + (uint32_t)bin_size;
    const uint32_t words[] = {0x46546C67, 2, total, length, 0x4E4F534A};
    const uint32_t chunk[] = {(uint32_t)bin_size, 0x004E4942};
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint16_t indices[3] = {0, 1, 2};
    memcpy(out, words, 20);
    memset(out + 20, ' ', length);
    memcpy(out + 20, json, strlen(json));
    memcpy(out + 20 + length, chunk, 8);
    memset(out + 28 + length, 0, bin_size);
    memcpy(out + 28 + length, positions, 36);
    memcpy(out + 28 + length + 36, indices, 6);
    return total;
}

/* Every beginning of a file is refused, or is a scene where only spaces are missing. */
static void check_beginnings(const char *name, const char *bytes, size_t size, size_t whole)
{
    for (size_t length = 0; length < size; length++) {
        char path[256], *report;
        lr_scene *scene;
        lr_error error = {0};
        put_bytes(name, bytes, length);
        file_path(path, name);
        lr_status status = lr_scene_load(path, NULL, &scene, &report, &error);
        if (length < whole && status == LR_OK)
            fail_msg("%s: %zu of %zu bytes are a scene", name, length, size);
        assert_true(status == LR_OK || (error.message[0] && strstr(error.message, name)));
        lr_scene_destroy(scene);
    }
}

static void test_cut_short(void **state)
{
    (void)state;
    static const char json[] = GLTF_HEAD
        "\"nodes\": [{\"mesh\": 0}], \"buffers\": [{\"byteLength\": 44}],"
        "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36},"
        "{\"buffer\": 0, \"byteOffset\": 36, \"byteLength\": 6}]," GLTF_ACCESSORS GLTF_MESH("") "}";
    char glb[2000];
    size_t size = make_glb(glb, json, 44);
    put_bytes("whole.glb", glb, size);
    lr_scene_destroy(import_good("whole.glb"));
    check_beginnings("cut.glb", glb, size, size);
    put_triangle_bin();
    static const char gltf[] = GLTF("{\"mesh\": 0}", "", "");
    check_beginnings("cut.gltf", gltf, strlen(gltf), strlen(gltf));
    static const char ply[] = PLY_HEAD("3", "1") PLY_TRIANGLE "3 0 1 2\n";
    check_beginnings("cut.ply", ply, strlen(ply), strlen(ply) - 2);
    char stl[134] = "binary";
    const float facet[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    stl[80] = 1;
    memcpy(stl + 84, facet, sizeof facet);
    put_bytes("whole.stl", stl, sizeof stl);
    lr_scene_destroy(import_good("whole.stl"));
    check_beginnings("cut.stl", stl, sizeof stl, sizeof stl);
}

static void test_gltf(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", "JSON"},
        {"{]", "JSON"},
        {"{}", "glTF version"},
        {"{\"asset\": {\"version\": \"1.0\"}}", "glTF version \"1.0\""},
        {"{\"asset\": {\"version\": \"2.0\"}}", "has no scene to show"},
        {GLTF("{\"children\": [1]}, {\"children\": [2]}, {\"children\": [1]}", "", ""),
         "is the child of two nodes"},
        {GLTF("{\"children\": [1]}, {\"children\": [0]}", "", ""), "is below itself"},
        {GLTF("{\"children\": [0]}", "", ""), "is below itself"},
        {GLTF("{\"children\": [9]}", "", ""), "node 0: names a child that there is not"},
        {GLTF("{\"mesh\": 9}", "", ""), "node 0: names a mesh that there is not"},
        {GLTF("{\"mesh\": 0}", ", \"material\": 0", ""), "names a material that there is not"},
        {GLTF("{\"mesh\": 0}", "", "\"extensionsRequired\": [\"KHR_draco_mesh_compression\"],"),
         "needs the extension KHR_draco_mesh_compression"},
        {GLTF_HEAD "\"nodes\": [{\"mesh\": 0}]," GLTF_BUFFERS
                   "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 4, "
                   "\"type\": \"VEC3\"}, {\"bufferView\": 1, \"componentType\": 5123, \"count\": "
                   "3, \"type\": \"SCALAR\"}]," GLTF_MESH("") "}",
         "accessor 0: reaches beyond its bufferView"},
        {GLTF_HEAD
         "\"nodes\": [{\"mesh\": 0}], \"buffers\": [{\"byteLength\": 40, \"uri\": "
         "\"t.bin\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36},"
         "{\"buffer\": 0, \"byteOffset\": 36, \"byteLength\": 6}]," GLTF_ACCESSORS GLTF_MESH(
             "") "}",
         "bufferView 1: reaches beyond its buffer"},
        {GLTF_HEAD
         "\"nodes\": [{\"mesh\": 0}], \"buffers\": [{\"byteLength\": 44, \"uri\": "
         "\"missing.bin\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36},"
         "{\"buffer\": 0, \"byteOffset\": 36, \"byteLength\": 6}]," GLTF_ACCESSORS GLTF_MESH(
             "") "}",
         "missing.bin: No such file"},
        {GLTF_HEAD
         "\"nodes\": [{\"mesh\": 0}], \"buffers\": [{\"byteLength\": 44, \"uri\": "
         "\"../../etc/passwd\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36},"
         "{\"buffer\": 0, \"byteOffset\": 36, \"byteLength\": 6}]," GLTF_ACCESSORS GLTF_MESH(
             "") "}",
         "--allow-path"},
    };
    put_triangle_bin();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        put_text("bad.gltf", cases[i].text);
        assert_true(import_fails("bad.gltf", NULL, cases[i].message));
    }
    /* A tree as deep as allowed, and one deeper. */
    for (int depth = 256; depth <= 257; depth++) {
        char nodes[20000] = "";
        size_t used = 0;
        for (int i = 0; i < depth; i++)
            used +=
                (size_t)snprintf(nodes + used, sizeof nodes - used, "{\"children\": [%d]},", i + 1);
        snprintf(nodes + used, sizeof nodes - used, "{\"mesh\": 0}");
        char text[24000];
        snprintf(text, sizeof text, "%s\"nodes\": [%s],%s", GLTF_HEAD, nodes,
                 GLTF_BUFFERS GLTF_ACCESSORS GLTF_MESH("") "}");
        put_text("deep.gltf", text);
        if (depth == 256)
            lr_scene_destroy(import_good("deep.gltf"));
        else
            assert_true(import_fails("deep.gltf", NULL, "nest more than 256 deep"));
    }
}

/* Nothing outside of the folder is read, by dots, by links or by absolute paths, unless allowed. */
static void test_paths(void **state)
{
    (void)state;
    char path[256], link[300], outside[300], *report;
    const lr_load_options allow = {.allow_path = true};
    lr_error error = {0};
    lr_scene *scene;
    file_path(path, "inner");
    mkdir(path, 0700);
    put_triangle_bin();
    put_text("up.mtl", "newmtl m\nKd 1 0 0\n");
    put_text("inner/up.obj", "mtllib ../up.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    scene = import_good("inner/up.obj");
    assert_true(has_note(scene, "--allow-path"));
    assert_true(scene->materials[scene->objects[0].material].color.colors[0].x < 0.9);
    lr_scene_destroy(scene);
    file_path(path, "inner/up.obj");
    assert_int_equal(lr_scene_load(path, &allow, &scene, &report, &error), LR_OK);
    assert_near(scene->materials[scene->objects[0].material].color.colors[0].x, 1, 0);
    assert_int_equal(scene->note_count, 0);
    lr_scene_destroy(scene);

    file_path(outside, "t.bin");
    file_path(link, "inner/t.bin");
    assert_int_equal(symlink(outside, link), 0);
    put_text("inner/link.gltf", GLTF("{\"mesh\": 0}", "", ""));
    assert_true(import_fails("inner/link.gltf", NULL, "--allow-path"));
    assert_int_equal(unlink(link), 0);
    /* A pipe would keep the reader waiting. */
    assert_int_equal(mkfifo(link, 0600), 0);
    assert_true(import_fails("inner/link.gltf", NULL, "not a regular file"));
    assert_int_equal(unlink(link), 0);

    put_text("inner/s.yaml", "camera: {}\nobjects:\n- mesh: {file: ../cut.ply}\n");
    put_text("cut.ply", PLY_HEAD("3", "1") PLY_TRIANGLE "3 0 1 2\n");
    assert_true(import_fails("inner/s.yaml", NULL, "--allow-path"));
    file_path(path, "inner/s.yaml");
    assert_int_equal(lr_scene_load(path, &allow, &scene, &report, &error), LR_OK);
    lr_scene_destroy(scene);
}

static bool stop(void *user, const char *what, double fraction)
{
    (void)what;
    return fraction < *(double *)user;
}

static void test_interrupted(void **state)
{
    (void)state;
    double at = 0.5;
    const lr_load_options options = {.progress = stop, .user = &at};
    put_text("stop.ply", PLY_HEAD("3", "1") PLY_TRIANGLE "3 0 1 2\n");
    put_text("stop.yaml", "camera: {}\nobjects:\n- mesh: {file: stop.ply}\n");
    static const char *const names[] = {"stop.ply", "stop.yaml"};
    for (int i = 0; i < 2; i++) {
        char path[256], *report;
        lr_scene *scene;
        lr_error error = {0};
        file_path(path, names[i]);
        assert_int_equal(lr_scene_load(path, &options, &scene, &report, &error),
                         LR_ERROR_INTERRUPTED);
        assert_null(scene);
        assert_null(report);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_indices),   cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_many_nans), cmocka_unit_test(test_counts),
        cmocka_unit_test(test_cut_short), cmocka_unit_test(test_gltf),
        cmocka_unit_test(test_paths),     cmocka_unit_test(test_interrupted),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
