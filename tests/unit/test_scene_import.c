/* Files of other programs: what comes over. Known answers throughout; files that nobody here made
 * are looked at where they are. */
#include "import_tests.h"

static void test_gltf_nodes(void **state)
{
    (void)state;
    put_triangle_bin();
    put_text("nodes.gltf",
             GLTF("{\"children\": [1, 2], \"translation\": [10, 0, 0]},"
                  "{\"mesh\": 0, \"scale\": [2, 3, 4], \"rotation\": [0, 0, 0.70710678, "
                  "0.70710678]},"
                  "{\"mesh\": 0, \"matrix\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]}",
                  "", ""));
    lr_scene *scene = import_good("nodes.gltf");
    /* Instances share the mesh. */
    assert_int_equal(scene->mesh_count, 1);
    assert_int_equal(scene->object_count, 2);
    assert_int_equal(scene->objects[0].mesh, scene->objects[1].mesh);
    assert_int_equal(scene->meshes[0].triangle_count, 1);
    assert_int_equal(scene->meshes[0].vertex_count, 3);
    assert_false(scene->meshes[0].closed);
    /* Scaled by 2 along x, turned by 90 degrees about z, moved by 10 along x. */
    lr_vec3 p = lr_transform_point(&scene->objects[0].to_world, (lr_vec3){1, 0, 0});
    assert_near(p.x, 10, 1e-6);
    assert_near(p.y, 2, 1e-6);
    p = lr_transform_point(&scene->objects[1].to_world, (lr_vec3){0, 0, 0});
    assert_near(p.x, 15, 1e-6);
    assert_near(p.z, 7, 1e-6);
    /* Defaults around it. */
    assert_true(scene->default_light);
    assert_int_equal(scene->camera_count, 1);
    assert_int_equal(scene->image.samples, 4);
    assert_int_equal(scene->image.width, 640);
    lr_scene_destroy(scene);
}

static void test_gltf_material(void **state)
{
    (void)state;
    put_triangle_bin();
    put_text("material.gltf",
             GLTF("{\"mesh\": 0}", ", \"material\": 0",
                  "\"materials\": [{\"name\": \"m\", \"pbrMetallicRoughness\": {"
                  "\"baseColorFactor\": [0.5, 0.25, 1, 1], \"metallicFactor\": 1, "
                  "\"roughnessFactor\": 0.25}, \"emissiveFactor\": [1, 0.5, 0], "
                  "\"alphaMode\": \"MASK\", \"alphaCutoff\": 0.3, \"extensions\": "
                  "{\"KHR_materials_emissive_strength\": {\"emissiveStrength\": 3}}}],"));
    lr_scene *scene = import_good("material.gltf");
    const lr_material *m = &scene->materials[scene->objects[0].material];
    assert_string_equal(m->name, "m");
    assert_near(m->color.colors[0].y, 0.25, 1e-12);
    assert_int_equal(m->model, LR_MODEL_PBR);
    assert_near(m->metallic, 1, 0);
    assert_near(m->roughness, 0.25, 0);
    /* w = 1 - 2 * 0.25; F0 of a metal is its colour. */
    assert_near(m->reflect.x, 0.25, 1e-12);
    assert_near(m->diffuse.x, 0.5, 1e-12);
    /* 2 / 0.25^4 - 2 */
    assert_near(m->shininess, 510, 1e-9);
    assert_near(m->specular.z, 0.75, 1e-12);
    assert_near(m->specular.x, 0.375, 1e-12);
    assert_near(m->emission.x, 3, 1e-12);
    assert_near(m->emission.y, 1.5, 1e-12);
    assert_near(m->alpha_cutoff, 0.3, 1e-12);
    assert_true(m->one_sided);
    lr_scene_destroy(scene);

    put_text("glass.gltf", GLTF("{\"mesh\": 0}", ", \"material\": 0",
                                "\"materials\": [{\"doubleSided\": true, \"pbrMetallicRoughness\": "
                                "{\"metallicFactor\": 0, \"roughnessFactor\": 0}, \"extensions\": "
                                "{\"KHR_materials_transmission\": {\"transmissionFactor\": 1}, "
                                "\"KHR_materials_ior\": {\"ior\": 2}, \"KHR_materials_volume\": "
                                "{\"thicknessFactor\": 1, \"attenuationDistance\": 2, "
                                "\"attenuationColor\": [0.5, 1, 0.25]}}}],"));
    scene = import_good("glass.gltf");
    m = &scene->materials[scene->objects[0].material];
    assert_near(m->ior, 2, 0);
    assert_true(m->fresnel);
    assert_near(m->transmit.x, 1, 1e-12);
    assert_near(m->diffuse.x, 0, 1e-12);
    assert_near(m->reflect.x, 1.0 / 9, 1e-12);
    /* Half is left after 2 metres. */
    assert_near(m->absorption.x, 0.5 * 0.69314718055994531, 1e-12);
    assert_near(m->absorption.y, 0, 1e-12);
    assert_near(m->absorption.z, 0.69314718055994531, 1e-12);
    assert_false(m->one_sided);
    lr_scene_destroy(scene);
}

static void test_gltf_view(void **state)
{
    (void)state;
    put_triangle_bin();
    put_text(
        "view.gltf",
        GLTF("{\"children\": [1, 2, 3, 4], \"mesh\": 0},"
             "{\"camera\": 0, \"translation\": [0, 0, 5]},"
             "{\"name\": \"lamp\", \"translation\": [0, 2, 0], \"rotation\": [-0.70710678, 0, 0, "
             "0.70710678], \"extensions\": {\"KHR_lights_punctual\": {\"light\": 0}}},"
             "{\"extensions\": {\"KHR_lights_punctual\": {\"light\": 1}}},"
             "{\"camera\": 1}",
             "",
             "\"cameras\": [{\"name\": \"front\", \"type\": \"perspective\", \"perspective\": "
             "{\"yfov\": 1.5707963267948966, \"znear\": 1}}, {\"type\": \"orthographic\"}],"
             "\"extensionsUsed\": [\"KHR_lights_punctual\"], \"extensions\": "
             "{\"KHR_lights_punctual\": {\"lights\": [{\"type\": \"spot\", \"intensity\": "
             "314.15926535897932, \"color\": [1, 0.5, 0], \"spot\": {\"outerConeAngle\": "
             "0.78539816339744831, \"innerConeAngle\": 0.39269908169872415}}, {\"type\": "
             "\"directional\", \"intensity\": 3.1415926535897932}]}},"));
    lr_scene *scene = import_good("view.gltf");
    assert_int_equal(scene->camera_count, 1);
    assert_string_equal(scene->cameras[0].name, "front");
    assert_near(scene->cameras[0].fov, 90, 1e-9);
    assert_near(scene->cameras[0].from.z, 5, 1e-12);
    assert_true(scene->cameras[0].to.z < 5);
    assert_int_equal(scene->light_count, 2);
    const lr_light *spot = &scene->lights[0];
    assert_int_equal(spot->kind, LR_LIGHT_SPOT);
    assert_near(spot->intensity, 100, 1e-9);
    assert_near(spot->angle, 45, 1e-9);
    assert_near(spot->inner, 22.5, 1e-9);
    assert_near(spot->direction.y, -1, 1e-6); /* its -z, turned by -90 degrees about x */
    assert_near(spot->color.y, 0.5, 0);
    assert_int_equal(scene->lights[1].kind, LR_LIGHT_DIRECTIONAL);
    assert_near(scene->lights[1].intensity, 1, 1e-12);
    /* The sum at the middle, (0.5, 0.5, 0): 100 / 2.5 + 1 = 41, in half stops below. */
    assert_near(scene->image.exposure, -5.5, 0);
    assert_near(scene->ambient.x, 0.1 * 45.254833995939, 1e-9);
    assert_true(has_note(scene, "only perspective ones are read"));
    lr_scene_destroy(scene);
}

static void test_obj(void **state)
{
    (void)state;
    put_text("a.mtl", "newmtl glass\nKd 0.1 0.2 0.3\nKs 0.5 0.5 0.5\nNs 64\nd 0.25\nNi 1.5\n"
                      "illum 7\nKe 0.5 0 0\n");

    put_text("a.obj", "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nusemtl glass\n"
                      "f 1 2 3 4\n");
    lr_scene *scene = import_good("a.obj");
    const lr_mesh *mesh = &scene->meshes[0];
    assert_int_equal(mesh->triangle_count, 2);
    assert_int_equal(mesh->vertex_count, 4);
    assert_null(mesh->normals);
    double area = 0;
    for (uint32_t i = 0; i < 2; i++) {
        const float *a = &mesh->positions[3 * (size_t)mesh->triangles[3 * i]];
        const float *b = &mesh->positions[3 * (size_t)mesh->triangles[3 * i + 1]];
        const float *c = &mesh->positions[3 * (size_t)mesh->triangles[3 * i + 2]];
        double twice = (double)((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
        assert_true(twice > 0);
        area += twice / 2;
    }
    assert_near(area, 1, 1e-9); /* two triangles of base 2 and height 0.5 */
    const lr_material *m = &scene->materials[scene->objects[0].material];
    assert_near(m->color.colors[0].z, (double)0.3f, 1e-7);
    assert_near(m->transmit.x, 0.75, 1e-7);
    assert_near(m->diffuse.x, 0.25, 1e-7);
    assert_near(m->ior, 1.5, 1e-7);
    assert_near(m->shininess, 64, 1e-4);
    assert_near(m->emission.x, 0.5, 0);
    assert_true(m->fresnel);
    assert_false(m->one_sided);
    lr_scene_destroy(scene);
}

/* A tetrahedron whose faces have vertices of their own is closed; without one face it is not. */
static void test_closed(void **state)
{
    (void)state;
    char text[600] = "";
    const char *const faces[] = {"0 0 0\n0 1 0\n1 0 0\n", "0 0 0\n1 0 0\n0 0 1\n",
                                 "0 0 0\n0 0 1\n0 1 0\n", "1 0 0\n0 1 0\n0 0 1\n"};
    for (int count = 3; count <= 4; count++) {
        snprintf(text, sizeof text,
                 "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                 "property float z\nelement face %d\nproperty list uchar int vertex_indices\n"
                 "end_header\n%s%s%s%s3 0 1 2\n3 3 4 5\n3 6 7 8\n%s",
                 3 * count, count, faces[0], faces[1], faces[2], count == 4 ? faces[3] : "",
                 count == 4 ? "3 9 10 11\n" : "");
        put_text("tetra.ply", text);
        lr_scene *scene = import_good("tetra.ply");
        assert_int_equal(scene->meshes[0].closed, count == 4);
        assert_int_equal(scene->meshes[0].vertex_count, 4);
        lr_scene_destroy(scene);
    }
}

/* Corners are joined where all that they have is equal, also with 0 and -0, and stand in the order
 * of the triangles; vertices without a usable normal have one corner for each normal that stands
 * in. */
static void test_joined(void **state)
{
    (void)state;
    put_text("j.ply",
             "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
             "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
             "property float s\nproperty float t\nelement face 5\n"
             "property list uchar int vertex_indices\nend_header\n"
             "9 9 9 0 0 1 0 0\n"  /* of no triangle */
             "1 0 0 0 0 1 0 0\n"  /* 1 */
             "0 1 0 0 0 1 0 0\n"  /* 2, alone */
             "0 0 0 0 0 1 0 0\n"  /* 3 */
             "1 0 -0 0 0 1 0 0\n" /* 4, as 1 */
             "1 0 0 0 0 1 0 1\n"  /* 5, as 1 but for t */
             "-0 0 0 0 0 1 0 0\n" /* 6, as 3 */
             "0 0 1 0 0 0 0 0\n"  /* 7, alone, without a normal */
             "3 3 1 2\n3 6 5 2\n3 6 7 4\n3 4 7 3\n3 2 7 3\n");
    lr_scene *scene = import_good("j.ply");
    const lr_mesh *mesh = &scene->meshes[0];
    const uint32_t corners[] = {0, 1, 2, 0, 3, 2, 0, 4, 1, 1, 5, 0, 2, 6, 0};
    const float positions[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0},
                                  {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    assert_int_equal(mesh->triangle_count, 5);
    assert_int_equal(mesh->vertex_count, 7);
    assert_memory_equal(mesh->triangles, corners, sizeof corners);
    assert_memory_equal(mesh->positions, positions, sizeof positions);
    assert_near((double)mesh->normals[3 * 4 + 1], 1, 0);
    assert_near((double)mesh->normals[3 * 5 + 1], -1, 0);
    assert_near((double)mesh->normals[3 * 6], 1, 0);
    assert_true(has_note(scene, "mesh 0: 3 corners have no usable normal"));
    lr_scene_destroy(scene);
}

static void test_ply(void **state)
{
    (void)state;
    put_text("c.ply",
             "ply\r\nformat ascii 1.0\r\ncomment x\r\nelement vertex 4\r\nproperty double x\r\n"
             "property float y\r\nproperty float z\r\nproperty float nx\r\nproperty float ny\r\n"
             "property float nz\r\nproperty uchar red\r\nproperty uchar green\r\n"
             "property uchar blue\r\nproperty float s\r\nproperty float t\r\n"
             "element face 1\r\nproperty list uchar int vertex_index\r\nend_header\r\n"
             "0 0 0 0 0 5 255 0 188 0 0.25\r\n1 0 0 0 0 5 0 0 0 0 0\r\n"
             "1 1 0 nan 0 0 0 0 0 0 0\r\n0 1 0 0 0 0 0 0 0 nan 0\r\n4 0 1 2 3\r\n");
    lr_scene *scene = import_good("c.ply");
    const lr_mesh *mesh = &scene->meshes[0];
    assert_int_equal(mesh->triangle_count, 2);
    assert_int_equal(mesh->vertex_count, 4);
    for (size_t i = 0; i < mesh->vertex_count; i++) { /* also where the file's are no use */
        assert_near((double)mesh->normals[3 * i], 0, 0);
        assert_near((double)mesh->normals[3 * i + 2], 1, 0);
    }
    assert_near((double)mesh->colors[0], 1, 0);
    assert_near((double)mesh->colors[2], 0.50288646, 1e-6); /* 188 of sRGB */
    assert_near((double)mesh->uvs[1], 0.75, 0);             /* downwards */
    assert_true(has_note(scene, "no usable normal"));
    assert_true(has_note(scene, "no usable texture coordinates"));
    lr_scene_destroy(scene);

    const char header[] = "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty short x\n"
                          "property short y\nproperty short z\nelement face 1\n"
                          "property list uchar ushort vertex_indices\nend_header\n";
    const unsigned char rows[] = {0, 0,   0,   0, 0, 0, 1, 2, 0, 0, 0, 0, 0,
                                  0, 255, 255, 0, 0, 3, 0, 0, 0, 1, 0, 2};
    char bytes[sizeof header + sizeof rows];
    memcpy(bytes, header, sizeof header - 1);
    memcpy(bytes + sizeof header - 1, rows, sizeof rows);
    put_bytes("b.ply", bytes, sizeof header - 1 + sizeof rows);
    scene = import_good("b.ply");
    assert_near((double)scene->meshes[0].positions[3], 258, 0);
    assert_near((double)scene->meshes[0].positions[7], -1, 0);
    lr_scene_destroy(scene);
}

static void test_texture(void **state)
{
    (void)state;
    put_text("red.ppm", "P3 1 1 255 255 0 0\n");
    put_text("t.mtl", "newmtl a\nKd 1 1 1\nmap_Kd red.ppm\nnewmtl b\nmap_Kd none.ppm\n");
    put_text("t.obj", "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0.25\nvt 1 0\nvt 0 1\n"
                      "usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 2/2 3/3\n");
    lr_scene *scene = import_good("t.obj");
    assert_int_equal(scene->texture_count, 1);
    const lr_material *m = &scene->materials[scene->objects[0].material];
    assert_int_equal(m->color.kind, LR_PATTERN_IMAGE);
    assert_int_equal(scene->textures[m->color.texture].bytes[0], 255);
    assert_near((double)scene->meshes[0].uvs[1], 0.75, 0);
    assert_int_equal(scene->materials[scene->objects[1].material].color.kind, LR_PATTERN_NONE);
    assert_true(has_note(scene, "without its texture"));
    assert_true(has_note(scene, "none.ppm"));
    lr_scene_destroy(scene);
}

static void test_mesh_key(void **state)
{
    (void)state;
    put_text("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    put_text("s.yaml", "camera: {}\nmaterials: {red: {color: red}}\nobjects:\n"
                       "- mesh: {file: m.obj}\n"
                       "- mesh: {file: m.obj, material: red, translate: [0, 0, 2], scale: 3, "
                       "shadow: false}\n");
    lr_scene *scene = import_good("s.yaml");
    assert_int_equal(scene->mesh_count, 1);
    assert_int_equal(scene->object_count, 2);
    assert_true(scene->objects[0].shadow);
    assert_false(scene->objects[1].shadow);
    assert_int_equal(scene->objects[1].material, 0);
    assert_int_not_equal(scene->objects[0].material, 0);
    lr_vec3 p = lr_transform_point(&scene->objects[1].to_world, (lr_vec3){1, 0, 0});
    assert_near(p.x, 3, 0);
    assert_near(p.z, 2, 0);
    lr_scene_destroy(scene);

    put_text("bad.yaml", "camera: {}\nobjects:\n- mesh: {file: none.obj}\n- mesh: {file: m.txt}\n");
    assert_true(import_fails("bad.yaml", NULL, "bad.yaml:3:16: "));
    assert_true(import_fails("bad.yaml", NULL, "bad.yaml:4:16: "));
}

/* Counts, bounds and materials of files that others made. */
static void test_shared(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t objects, meshes, triangles, vertices;
        bool closed;
        double low[3], high[3];
    } files[] = {
        {"gltf/Box.glb", 1, 1, 12, 24, true, {-.5, -.5, -.5}, {.5, .5, .5}},
        {"gltf/BoxVertexColors.glb", 1, 1, 12, 24, true, {-.5, -.5, -.5}, {.5, .5, .5}},
        {"gltf/boombox.glb", 1, 1, 6036, 0, false, {0}, {0}},
        {"obj/box.obj", 1, 1, 12, 8, true, {-.5, -.5, -.5}, {.5, .5, .5}},
        {"obj/concave_polygon.obj", 1, 1, 64, 64, false, {0}, {0}},
        {"obj/cube_usemtl.obj", 4, 4, 12, 0, false, {0}, {0}},
        {"obj/spot_triangulated.obj", 1, 1, 5856, 3225, true, {0}, {0}},
        {"ply/cube.ply", 1, 1, 12, 8, true, {0, 0, 0}, {1, 1, 1}},
        {"ply/cube_binary.ply", 1, 1, 12, 8, true, {0}, {0}},
        {"ply/cube_uv.ply", 1, 1, 12, 24, true, {-1, -1, -1}, {1, 1, 1}},
        {"stl/triangle.stl", 1, 1, 1, 3, false, {-1, -1, 0}, {1, 1, 0}},
    };
    if (access(SHARED, R_OK) != 0) {
        print_message("skipped: there is no folder " SHARED "\n");
        skip();
    }
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[512], *report;
        lr_scene *scene;
        lr_error error = {0};
        uint32_t triangles = 0;
        snprintf(path, sizeof path, SHARED "%s", files[i].name);
        if (lr_scene_load(path, NULL, &scene, &report, &error))
            fail_msg("%s", error.message);
        for (uint32_t k = 0; k < scene->mesh_count; k++)
            triangles += scene->meshes[k].triangle_count;
        const lr_mesh *mesh = &scene->meshes[0];
        assert_int_equal(scene->object_count, files[i].objects);
        assert_int_equal(scene->mesh_count, files[i].meshes);
        assert_int_equal(triangles, files[i].triangles);
        if (files[i].vertices)
            assert_int_equal(mesh->vertex_count, files[i].vertices);
        assert_int_equal(mesh->closed, files[i].closed);
        for (int k = 0; k < 3 && files[i].high[0] > 0; k++) {
            float low = mesh->positions[k], high = low;
            for (size_t v = 0; v < mesh->vertex_count; v++) {
                low = fminf(low, mesh->positions[3 * v + k]);
                high = fmaxf(high, mesh->positions[3 * v + k]);
            }
            assert_near((double)low, files[i].low[k], 1e-6);
            assert_near((double)high, files[i].high[k], 1e-6);
        }
        lr_scene_destroy(scene);
    }
}

/* The red of Box.glb, and colours of BoxVertexColors.glb that its name promises. */
static void test_shared_materials(void **state)
{
    (void)state;
    char *report;
    lr_scene *scene;
    if (access(SHARED, R_OK) != 0)
        skip();
    assert_int_equal(lr_scene_load(SHARED "gltf/Box.glb", NULL, &scene, &report, NULL), LR_OK);
    assert_int_equal(scene->material_count, 1);
    assert_string_equal(scene->materials[0].name, "Red");
    assert_near(scene->materials[0].color.colors[0].x, 0.8, 1e-6);
    assert_near(scene->materials[0].color.colors[0].y, 0, 0);
    assert_near(scene->materials[0].diffuse.x, 1, 0);
    assert_true(scene->objects[0].transformed); /* from z up to y up */
    lr_scene_destroy(scene);
    assert_int_equal(lr_scene_load(SHARED "gltf/BoxVertexColors.glb", NULL, &scene, &report, NULL),
                     LR_OK);
    const lr_mesh *mesh = &scene->meshes[0];
    assert_non_null(mesh->colors);
    bool pure = false; /* a corner of the colour cube */
    for (size_t i = 0; i < mesh->vertex_count; i++)
        pure = pure || (mesh->colors[3 * i] > 0.99f && mesh->colors[3 * i + 1] < 0.01f);
    assert_true(pure);
    lr_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gltf_nodes),
        cmocka_unit_test(test_gltf_material),
        cmocka_unit_test(test_gltf_view),
        cmocka_unit_test(test_obj),
        cmocka_unit_test(test_closed),
        cmocka_unit_test(test_joined),
        cmocka_unit_test(test_ply),
        cmocka_unit_test(test_texture),
        cmocka_unit_test(test_mesh_key),
        cmocka_unit_test(test_shared),
        cmocka_unit_test(test_shared_materials),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
