/* A camera saved into a scene's text: layouts and what becomes of them, every scene of the project,
 * random layouts, and what is refused. */
#include "scene_tests.h"

#include "base/file.h"
#include "base/hash.h"
#include "scene/camera.h"
#include "scene/save_camera.h"
#include "scene/write.h"
#include "temporary_folder.h"

#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

#define OBJECTS "objects: [{sphere: {}}]"

static const lr_camera plain = {.from = {0, 1, 5}, .to = {0, 0, 0}, .up = {0, 1, 0}, .fov = 40};

static void assert_pose(const lr_camera *a, const lr_camera *b)
{
    assert_memory_equal(&a->from, &b->from, 3 * sizeof(lr_vec3));
    assert_memory_equal(&a->fov, &b->fov, sizeof a->fov);
}

static char *edited(const char *text, uint32_t index, const lr_camera *camera)
{
    char *out;
    size_t length;
    lr_error error = {0};
    if (lr_camera_edit(text, strlen(text), "s.yaml", index, camera, &out, &length, &error))
        fail_msg("%s\nfor:\n%s", error.message, text);
    assert_int_equal(strlen(out), length);
    lr_scene *scene = parse_good(out);
    assert_pose(&scene->cameras[index], camera);
    lr_scene_destroy(scene);
    return out;
}

/* from [1, 1, 5], to [0, 0.25, 0], up [0, 1, 0], fov 50, where all was plain. */
static void test_layouts(void **state)
{
    (void)state;
    static const struct {
        const char *before, *after;
    } cases[] = {
        /* Numbers that are right stay as they are written. */
        {"camera: {from: [0, 1.00, 5], to: [0, 0, 0], fov: 4e1} # c\n" OBJECTS,
         "camera: {from: [1, 1.00, 5], to: [0, 0.25, 0], fov: 50} # c\n" OBJECTS},
        {"camera: {}\n" OBJECTS, "camera: {from: [1, 1, 5], to: [0, 0.25, 0], fov: 50}\n" OBJECTS},
        {"camera: { }\n" OBJECTS,
         "camera: {from: [1, 1, 5], to: [0, 0.25, 0], fov: 50 }\n" OBJECTS},
        {"camera: {to: [0, 0, 0]}\n" OBJECTS,
         "camera: {to: [0, 0.25, 0], from: [1, 1, 5], fov: 50}\n" OBJECTS},
        {"camera:\n  # eye\n  from: [0, 1, 5]   # a\n  to: [0,0,0] # b\n\n# lights\n" OBJECTS "\n",
         "camera:\n  # eye\n  from: [1, 1, 5]   # a\n  to: [0,0.25,0] # b\n  fov: 50\n\n# "
         "lights\n" OBJECTS "\n"},
        {OBJECTS "\ncamera:\n    from: [0, 1, 5]", OBJECTS "\ncamera:\n    from: [1, 1, 5]\n"
                                                           "    to: [0, 0.25, 0]\n    fov: 50"},
        {"camera:\r\n  from:\r\n  - 0\r\n  - 1 # high\r\n  - 5\r\n" OBJECTS "\r\n",
         "camera:\r\n  from:\r\n  - 1\r\n  - 1 # high\r\n  - 5\r\n  to: [0, 0.25, 0]\r\n"
         "  fov: 50\r\n" OBJECTS "\r\n"},
        {"\xEF\xBB\xBF"
         "camera: {fov: 40}\n" OBJECTS,
         "\xEF\xBB\xBF"
         "camera: {fov: 50, from: [1, 1, 5], to: [0, 0.25, 0]}\n" OBJECTS},
        {"{\"camera\":{\"from\":[0,1,5]},\"objects\":[{\"sphere\":{}}]}",
         "{\"camera\":{\"from\":[1,1,5],\"to\":[0, 0.25, 0],\"fov\":50},"
         "\"objects\":[{\"sphere\":{}}]}"},
        {"{\"camera\": {},\n \"objects\": [{\"sphere\": {}}]}",
         "{\"camera\": {\"from\": [1, 1, 5], \"to\": [0, 0.25, 0], \"fov\": 50},\n"
         " \"objects\": [{\"sphere\": {}}]}"},
        {"{\n  \"camera\": {\n    \"from\": [0, 1, 5],\n    \"to\": [0, 0, 0]\n  },\n"
         "  \"objects\": [{\"sphere\": {}}]\n}\n",
         "{\n  \"camera\": {\n    \"from\": [1, 1, 5],\n    \"to\": [0, 0.25, 0],\n    \"fov\": "
         "50\n"
         "  },\n  \"objects\": [{\"sphere\": {}}]\n}\n"},
        {"camera: {\n  from: [0, 1, 5], # a\n  to: [0, 0, 0], # b\n}\n" OBJECTS,
         "camera: {\n  from: [1, 1, 5], # a\n  to: [0, 0.25, 0], # b\n  fov: 50,\n}\n" OBJECTS},
        {"camera: {\n  from: [0, 1, 5], # a\n  to: [0, 0, 0] # b\n  # c\n}\n" OBJECTS,
         "camera: {\n  from: [1, 1, 5], # a\n  to: [0, 0.25, 0], # b\n  fov: 50\n  # "
         "c\n}\n" OBJECTS},
        {"camera: {from: [0, 1, 5],\n         to: [0, 0, 0]}\n" OBJECTS,
         "camera: {from: [1, 1, 5],\n         to: [0, 0.25, 0],\n         fov: 50}\n" OBJECTS},
        {"camera:\n  'from': [0,\n   1,\n   5]\n" OBJECTS,
         "camera:\n  'from': [1,\n   1,\n   5]\n  \"to\": [0, 0.25, 0]\n  \"fov\": 50\n" OBJECTS},
        /* What others repeat is written out where it is repeated. */
        {"camera: {from: &e [0, 1, 5], to: [0, 0, 0], up: [0, &one 1, 0], fov: 40}\n"
         "lights: [{point: {position: [0, *one, 3]}}]\n" OBJECTS,
         "camera: {from: &e [1, 1, 5], to: [0, 0.25, 0], up: [0, &one 1, 0], fov: 50}\n"
         "lights: [{point: {position: [0, *one, 3]}}]\n" OBJECTS},
        {"lights: [{point: {position: &p [0, 1, 5]}}]\ncamera:\n  from: *p\n  fov: 50\n" OBJECTS,
         "lights: [{point: {position: &p [0, 1, 5]}}]\ncamera:\n  from: [1, 1, 5]\n  fov: 50\n"
         "  to: [0, 0.25, 0]\n" OBJECTS},
        {"ambient: &five 5\ncamera: {from: [0, 1, *five], fov: 50}\n" OBJECTS,
         "ambient: &five 5\ncamera: {from: [1, 1, *five], fov: 50, to: [0, 0.25, 0]}\n" OBJECTS},
        {"ambient: &zero 0\ncamera: {from: [*zero , 1, 5], fov: 50}\n" OBJECTS,
         "ambient: &zero 0\ncamera: {from: [1 , 1, 5], fov: 50, to: [0, 0.25, 0]}\n" OBJECTS},
        {"? camera\n: {fov: 40}\n? objects\n: [{sphere: {}}]\n",
         "? camera\n: {fov: 50, from: [1, 1, 5], to: [0, 0.25, 0]}\n? objects\n: [{sphere: {}}]\n"},
        {"%YAML 1.2\n---\ncamera: {fov: 40}\n" OBJECTS "\n...\n",
         "%YAML 1.2\n---\ncamera: {fov: 50, from: [1, 1, 5], to: [0, 0.25, 0]}\n" OBJECTS
         "\n...\n"},
    };
    lr_camera moved = plain;
    moved.from.x = 1;
    moved.to.y = 0.25;
    moved.fov = 50;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *out = edited(cases[i].before, 0, &moved);
        assert_string_equal(out, cases[i].after);
        free(out);
        out = edited(cases[i].after, 0, &moved);
        assert_string_equal(out, cases[i].after);
        free(out);
    }
}

static void test_up_is_the_scenes(void **state)
{
    (void)state;
    lr_camera camera = {.from = {1, 2, 3}, .to = {0, 0, 0}, .up = {0, 0, 1}, .fov = 40};
    char *out = edited("up: [0, 0, 1]\ncamera: {from: [0, 1, 5]}\n" OBJECTS, 0, &camera);
    assert_string_equal(out, "up: [0, 0, 1]\ncamera: {from: [1, 2, 3]}\n" OBJECTS);
    free(out);
    camera.up = (lr_vec3){0, 1, 0.5};
    out = edited("up: [0, 0, 1]\ncamera: {from: [0, 1, 5]}\n" OBJECTS, 0, &camera);
    assert_string_equal(out, "up: [0, 0, 1]\ncamera: {from: [1, 2, 3], up: [0, 1, 0.5]}\n" OBJECTS);
    free(out);
}

static void test_several(void **state)
{
    (void)state;
    static const char text[] =
        "cameras:\n  a: &a {from: [0, 1, 5], fov_to_centers: true}\n  \"b b\":\n    fov: 40\n"
        "\n  # the third\n  c: *a\n" OBJECTS;
    lr_camera camera = plain;
    camera.from.x = -7;
    char *out = edited(text, 1, &camera);
    assert_non_null(strstr(out, "  \"b b\":\n    fov: 40\n    from: [-7, 1, 5]\n\n  # the third"));
    free(out);
    camera.fov_to_centers = true;
    out = edited(text, 2, &camera);
    assert_non_null(strstr(out, "  c: {from: [-7, 1, 5], up: [0, 1, 0], fov_to_centers: true}\n"));
    free(out);
    /* The first is repeated by the third. */
    lr_error error = {0};
    size_t length;
    assert_int_equal(
        lr_camera_edit(text, strlen(text), "s.yaml", 0, &camera, &out, &length, &error),
        LR_ERROR_SCENE);
    assert_null(out);
    assert_non_null(strstr(error.message, "s.yaml:2: the camera cannot be changed"));
    assert_int_equal(
        lr_camera_edit(text, strlen(text), "s.yaml", 3, &camera, &out, &length, &error),
        LR_ERROR_ARGUMENT);
    assert_int_equal(lr_camera_edit("a", 1, "s.yaml", 0, &camera, &out, &length, &error),
                     LR_ERROR_SCENE);
}

static void test_anchors_of_others(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "camera: {from: &e [0, 1, 5]}\nlights: [{point: {position: *e}}]\n" OBJECTS,
        "camera: {from: [0, 1, &five 5]}\nambient: *five\n" OBJECTS,
        "camera: {fov: &f 40}\nambient: *f\n" OBJECTS,
    };
    lr_camera camera = {.from = {1, 2, 3}, .to = {0, 0, 0}, .up = {0, 1, 0}, .fov = 41};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char *out;
        size_t length;
        lr_error error = {0};
        assert_int_equal(
            lr_camera_edit(texts[i], strlen(texts[i]), "s.yaml", 0, &camera, &out, &length, &error),
            LR_ERROR_SCENE);
        assert_non_null(strstr(error.message, "write its values "));
    }
}

/* ---- Random layouts ------------------------------------------------------------------------ */

static uint32_t random_bits = 1;

static uint32_t pick(uint32_t count)
{
    random_bits = random_bits * 1664525 + 1013904223;
    return (random_bits >> 8) % count;
}

static double random_number(void)
{
    static const double some[] = {0, 1, -1, 0.1, 1e-7, 1e12, -2.5e11, 40, 5, 1.0 / 3};
    return pick(2) ? some[pick(10)] : ldexp((int)pick(1 << 24) - (1 << 23), (int)pick(40) - 36);
}

static lr_camera random_camera(void)
{
    lr_camera camera = {.fov = 1 + pick(178) + pick(1000) / 1000.0};
    lr_vec3 *vectors[] = {&camera.from, &camera.to, &camera.up};
    for (int i = 0; i < 3; i++)
        *vectors[i] = (lr_vec3){random_number(), random_number(), random_number()};
    return camera;
}

typedef struct layout {
    char text[8192];
    size_t used;
    const char *line_end;
} layout;

static void put(layout *l, const char *text)
{
    for (; *text; text++)
        l->used += (size_t)snprintf(l->text + l->used, sizeof l->text - l->used, "%s",
                                    *text == '\n' ? l->line_end : (char[]){*text, 0});
}

static void put_value(layout *l, const double *values, uint32_t count, bool block, int indent)
{
    char number[64];
    bool many = pick(3) == 0;
    if (count == 3 && !block)
        put(l, many ? "[ " : "[");
    for (uint32_t i = 0; i < count; i++) {
        if (count == 3 && block) {
            snprintf(number, sizeof number, "\n%*s- ", indent, "");
            put(l, number);
        }
        snprintf(number, sizeof number, pick(2) ? "%.17g" : "%+.17e", values[i]);
        put(l, number);
        if (block && count == 3 && pick(4) == 0)
            put(l, " # of three");
        if (count == 3 && !block && i < 2)
            put(l, many ? " ,\n            " : ",");
    }
    if (count == 3 && !block)
        put(l, "]");
}

static void put_random_camera(layout *l, const lr_camera *camera, bool given[4], int indent)
{
    static const char *const keys[] = {"from", "to", "up", "fov"};
    uint32_t order[4] = {0, 1, 2, 3}, kind = pick(4), count = 0; /* block, two flows, JSON */
    bool begun = false, lines = kind == 2 || pick(3) == 0;
    char head[64];
    for (int i = 0; i < 4; i++) {
        uint32_t other = pick(4), kept = order[i];
        order[i] = order[other];
        order[other] = kept;
        count += given[i];
    }
    if (count == 0) {
        put(l, "{}");
        return;
    }
    put(l, kind ? "{" : pick(2) ? " # the camera" : "");
    for (uint32_t i = 0, left = count; i < 4; i++) {
        uint32_t key = order[i];
        if (!given[key])
            continue;
        if (begun && kind)
            put(l, pick(2) ? ", " : ",");
        if (begun && kind && lines && pick(3) == 0)
            put(l, " # so");
        if (kind == 0 || lines) {
            snprintf(head, sizeof head, "\n%*s", indent, "");
            put(l, head);
        }
        snprintf(head, sizeof head, kind == 3 ? "\"%s\": " : "%s: ", keys[key]);
        put(l, head);
        put_value(l, key == 3 ? &camera->fov : &(&camera->from)[key].x, key == 3 ? 1 : 3,
                  kind == 0 && pick(3) == 0, indent + (int)pick(3));
        if (kind == 0 && pick(3) == 0)
            put(l, " # why");
        begun = true;
        left--;
        if (left == 0 && kind && lines)
            put(l, pick(2) ? (pick(2) ? ", # last\n  " : " # last\n  ") : "\n  ");
    }
    put(l, kind ? "}" : "");
}

static uint32_t count_of(const char *text, const char *what)
{
    uint32_t count = 0;
    for (; (text = strstr(text, what)); text++)
        count++;
    return count;
}

/* False when the random camera was none. */
static bool try_layout(void)
{
    static layout l;
    l = (layout){.line_end = pick(3) ? "\n" : "\r\n"};
    lr_camera first = random_camera(), second = random_camera();
    bool given[4];
    for (int i = 0; i < 4; i++)
        given[i] = pick(3) > 0;
    bool named = pick(2);
    put(&l, pick(4) ? "" : "\xEF\xBB\xBF");
    put(&l, pick(2) ? "# a scene: of {things}\n" : "");
    put(&l, pick(2) ? "ambient: 0.5\n" : "");
    put(&l, named ? "cameras:\n   a: {from: [0, 0, -4]}\n   b: " : "camera: ");
    size_t prefix = l.used;
    put_random_camera(&l, &first, given, named ? 5 : 2);
    size_t suffix = l.used;
    put(&l, named && pick(2) ? "\n   c: {fov: 7}" : "");
    put(&l, pick(2) ? "\n\n# lights\n" OBJECTS : "\n" OBJECTS "\n");

    lr_scene *scene = NULL;
    char *report = NULL;
    lr_status status = lr_scene_parse(l.text, l.used, "s.yaml", &scene, &report, NULL);
    bool good = status == LR_OK;
    if (!good && !strstr(report, "camera's") && !strstr(report, "up is [0, 0, 0]"))
        fail_msg("%s\n%s", report, l.text);
    free(report);
    lr_scene_destroy(scene);
    if (!good)
        return false;
    for (int i = 0; i < 3; i++)
        if (!given[i] && pick(2)) /* the default is right */
            (&second.from)[i] = (&plain.from)[i];
    char *text;
    size_t length;
    lr_error error = {0};
    status = lr_camera_edit(l.text, l.used, "s.yaml", named, &second, &text, &length, &error);
    if (status != LR_OK) {
        if (lr_camera_usable(&second))
            fail_msg("%s\n%s", error.message, l.text);
        return false;
    }
    scene = parse_good(text);
    assert_pose(&scene->cameras[named], &second);
    lr_scene_destroy(scene);
    assert_memory_equal(text, l.text, prefix);
    assert_memory_equal(text + length - (l.used - suffix), l.text + suffix, l.used - suffix);
    assert_int_equal(count_of(text, "#"), count_of(l.text, "#"));
    assert_int_equal(count_of(text, "\n") == count_of(text, "\r\n"),
                     count_of(l.text, "\n") == count_of(l.text, "\r\n"));
    free(text);
    return true;
}

static void test_random_layouts(void **state)
{
    (void)state;
    uint32_t good = 0;
    for (int i = 0; i < 6000; i++)
        good += try_layout();
    assert_true(good > 3000);
}

/* ---- Files --------------------------------------------------------------------------------- */

static char *path_of(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static char *read_text(const char *path, size_t *length)
{
    char *text;
    assert_int_equal(lr_file_read(path, 1 << 20, &text, length, NULL), LR_OK);
    return text;
}

static void write_text(const char *path, const char *text)
{
    assert_int_equal(lr_file_write(path, text, strlen(text), NULL), LR_OK);
}

/* Each camera of a scene moves, comes back by the lines that are pasted, and the rest stays. */
static void save_in(const char *path)
{
    size_t length;
    char *text = read_text(path, &length), hash[65], *report = NULL;
    lr_scene *scene = NULL, *saved = NULL;
    lr_error error = {0};
    if (lr_scene_load(path, &(lr_load_options){.allow_path = true}, &scene, &report, &error))
        fail_msg("%s", error.message);
    lr_hash_bytes(text, length, hash);
    assert_string_equal(hash, scene->sha256);
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        if (scene->cameras[i].moves) /* its keys stay as they are: test_scene_keys.c */
            continue;
        lr_camera camera = scene->cameras[i];
        camera.from = (lr_vec3){1.0 / 3 + i, -2e-9, 1e4 / 7};
        camera.to.z += 0.1;
        camera.fov = 12.125;
        write_text(path_of("saved.yaml"), text);
        strcpy(hash, scene->sha256);
        if (lr_scene_save_camera(path_of("saved.yaml"), i, &camera, hash, &error))
            fail_msg("%s: %s", path, error.message);
        size_t saved_length;
        char *after = read_text(path_of("saved.yaml"), &saved_length), again[65];
        lr_hash_bytes(after, saved_length, again);
        assert_string_equal(again, hash);
        /* By its own name, so that its files are found. */
        if (lr_scene_parse(after, saved_length, path, &saved, &report, &error))
            fail_msg("%s: %s\n%s", path, report, after);
        for (uint32_t k = 0; k < scene->camera_count; k++)
            assert_pose(&saved->cameras[k], k == i ? &camera : &scene->cameras[k]);
        lr_scene_facts a, b;
        saved->cameras[i].from = scene->cameras[i].from;
        saved->cameras[i].to = scene->cameras[i].to;
        saved->cameras[i].fov = scene->cameras[i].fov;
        lr_scene_get_facts(scene, &a);
        lr_scene_get_facts(saved, &b);
        assert_string_equal(a.sha256, b.sha256);
        lr_scene_destroy(saved);
        free(after);
    }
    lr_scene_destroy(scene);
    free(text);
}

static void test_scenes(void **state)
{
    (void)state;
    uint32_t count = 0;
    DIR *scenes = opendir("scenes");
    assert_non_null(scenes);
    for (struct dirent *entry; (entry = readdir(scenes));) {
        char path[300];
        if (!strstr(entry->d_name, ".yaml"))
            continue;
        snprintf(path, sizeof path, "scenes/%s", entry->d_name);
        save_in(path);
        count++;
    }
    closedir(scenes);
    assert_true(count > 15);
}

static void test_files(void **state)
{
    (void)state;
    static const char text[] = "camera: {from: [0, 1, 5]}\n" OBJECTS "\n";
    char link[256], hash[65], kept[65];
    lr_error error = {0};
    lr_camera camera = plain;
    camera.from.x = 3;
    strcpy(link, path_of("link.yaml"));
    write_text(path_of("real.yaml"), text);
    assert_int_equal(chmod(path_of("real.yaml"), 0640), 0);
    assert_int_equal(symlink("real.yaml", link), 0);
    lr_hash_bytes(text, strlen(text), hash);
    strcpy(kept, hash);
    assert_int_equal(lr_scene_save_camera(link, 0, &camera, hash, &error), LR_OK);
    struct stat info;
    assert_int_equal(lstat(link, &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(stat(link, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    /* Saved once more by what is known now, and not by what was. */
    camera.from.x = 4;
    assert_int_equal(lr_scene_save_camera(link, 0, &camera, hash, &error), LR_OK);
    camera.from.x = 5;
    assert_int_equal(lr_scene_save_camera(link, 0, &camera, kept, &error), LR_ERROR_FILE);
    assert_non_null(strstr(error.message, "has changed since it was read"));
    size_t length;
    char *after = read_text(link, &length);
    assert_string_equal(after, "camera: {from: [4, 1, 5]}\n" OBJECTS "\n");
    free(after);
    /* Nothing to do, nothing done. */
    ino_t inode = info.st_ino;
    assert_int_equal(stat(link, &info), 0);
    inode = info.st_ino;
    camera.from.x = 4;
    assert_int_equal(lr_scene_save_camera(link, 0, &camera, hash, &error), LR_OK);
    assert_int_equal(stat(link, &info), 0);
    assert_true(info.st_ino == inode);
}

static void test_refused(void **state)
{
    (void)state;
    char hash[65] = "";
    lr_error error = {0};
    static const char *const kinds[][2] = {
        {"-", "standard input"},          {"a.gltf", "lavaray convert"},
        {"a.nff", "lavaray convert"},     {"a.obj", "lavaray convert"},
        {"missing.yaml", "No such file"}, {"/dev/null", "regular"},
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        assert_int_equal(lr_scene_save_camera(kinds[i][0], 0, &plain, hash, &error), LR_ERROR_FILE);
        assert_non_null(strstr(error.message, kinds[i][1]));
    }
    lr_camera bad = plain;
    bad.to = bad.from;
    assert_int_equal(lr_scene_save_camera("s.yaml", 0, &bad, hash, &error), LR_ERROR_ARGUMENT);
}

static void test_text(void **state)
{
    (void)state;
    lr_camera camera = plain;
    camera.from = (lr_vec3){0.1, -1.0 / 3, 1e12};
    char *text = lr_camera_text(&camera);
    assert_string_equal(
        text, "camera: {from: [0.1, -0.3333333333333333, 1000000000000], up: [0, 1, 0]}\n");
    free(text);
    char name[] = "to the left";
    camera.name = name;
    text = lr_camera_text(&camera);
    char scene_text[300];
    snprintf(scene_text, sizeof scene_text, "cameras:\n%s" OBJECTS, text);
    lr_scene *scene = parse_good(scene_text);
    assert_string_equal(scene->cameras[0].name, name);
    assert_pose(&scene->cameras[0], &camera);
    lr_scene_destroy(scene);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_layouts),        cmocka_unit_test(test_up_is_the_scenes),
        cmocka_unit_test(test_several),        cmocka_unit_test(test_anchors_of_others),
        cmocka_unit_test(test_random_layouts), cmocka_unit_test(test_scenes),
        cmocka_unit_test(test_files),          cmocka_unit_test(test_refused),
        cmocka_unit_test(test_text),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
