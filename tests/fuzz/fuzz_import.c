/* Any bytes as a file of another program must become a scene whose arrays keep the promises of
 * scene.h, or one message, without a crash, a leak or much time. The first byte picks the kind. */
#include "imported_scene.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
const char *__lsan_default_suppressions(void);

/* assimp forgets memory when it gives up a file; ours is all by malloc. */
const char *__lsan_default_suppressions(void)
{
    return "leak:libstdc++\nleak:libassimp\n";
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const endings[] = {"gltf", "glb", "obj", "ply", "stl"};
    static char folder[64];
    char path[128];
    if (size < 1)
        return 0;
    if (!folder[0]) {
        snprintf(folder, sizeof folder, "/tmp/lavaray-fuzz-%ld", (long)getpid());
        mkdir(folder, 0700);
    }
    snprintf(path, sizeof path, "%s/model.%s", folder, endings[data[0] % 5]);
    FILE *file = fopen(path, "wb");
    expect(file != NULL);
    fwrite(data + 1, 1, size - 1, file);
    fclose(file);
    const lr_load_options options = {.max_memory = 64 << 20, .max_triangles = 100000};
    lr_scene *scene;
    char *report;
    lr_error error = {0};
    lr_status status = lr_scene_load(path, &options, &scene, &report, &error);
    expect(!report && (status == LR_OK ? scene != NULL : !scene && error.message[0]));
    if (scene)
        check_scene(scene);
    lr_scene_destroy(scene);
    remove(path);
    return 0;
}
