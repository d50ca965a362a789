/* Any bytes must parse to a scene or to a report, without a crash, a leak or much time. */
#include "lavaray.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    lr_scene *scene;
    char *report;
    lr_error error = {0};
    lr_status status =
        lr_scene_parse((const char *)data, size, "fuzz.yaml", &scene, &report, &error);
    bool consistent = status == LR_OK            ? scene && !report
                      : status == LR_ERROR_SCENE ? !scene && report && report[0]
                                                 : !scene && !report;
    if (!consistent)
        abort();
    lr_scene_destroy(scene);
    free(report);
    return 0;
}
