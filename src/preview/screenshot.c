#include "preview/screenshot.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "image/image.h"

#define SCREENSHOTS_MAX 100000

/* Creates an empty file of a name that is free. */
static bool reserve_name(const char *stem, const char *ending, char *name, size_t size)
{
    for (int i = 0; i < SCREENSHOTS_MAX; i++) {
        int length = i == 0 ? snprintf(name, size, "%s%s", stem, ending)
                            : snprintf(name, size, "%s-%d%s", stem, i, ending);
        if (length < 0 || (size_t)length >= size)
            return false;
        int file = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0) {
            close(file);
            return true;
        }
        if (errno != EEXIST)
            return false;
    }
    return false;
}

lr_status lr_screenshot_write(const lr_screenshot *shot, const lr_picture *picture,
                              char name[LR_SCREENSHOT_NAME], lr_error *error)
{
    char stem[LR_SCREENSHOT_NAME - 64], hash[65];
    const char *path = shot->name ? shot->name : shot->scene_path, *slash = strrchr(path, '/');
    const char *base = shot->name || !slash ? path : slash + 1;
    const char *dot = strrchr(base, '.');
    bool has_dot = dot && dot > base && !strchr(dot, '/');
    lr_encoding encoding = {.format = LR_FORMAT_PNG, .exposure = (float)shot->exposure};
    const char *ending = ".png";
    if (shot->name && has_dot && lr_format_from_path(path, &encoding.format))
        ending = dot;
    snprintf(stem, sizeof stem, "%.*s", (int)(has_dot ? (size_t)(dot - base) : strlen(base)), base);
    if (!reserve_name(stem, ending, name, LR_SCREENSHOT_NAME))
        return lr_fail(error, LR_ERROR_FILE, "%s%s: %s", stem, ending, strerror(errno));
    lr_picture_hash(picture, hash);
    const lr_text texts[] = {
        {LR_STAMP_SOFTWARE, "lavaray " LR_VERSION},
        {LR_STAMP_SCENE, shot->scene_sha256},
        {LR_STAMP_PIXELS, hash},
    };
    encoding.texts = texts;
    encoding.text_count = sizeof texts / sizeof *texts;
    lr_status status = lr_picture_write(picture, name, &encoding, error);
    if (status)
        unlink(name);
    return status;
}
