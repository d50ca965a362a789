/* Any bytes must read as a picture or be refused with a message, without a crash, a leak or much
 * time. Built once for each reader, named by READER. */
#include "image/read_internal.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static uint32_t big_endian(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* Makes the checksums of PNG chunks right, which mutations cannot. */
static void mend_checksums(unsigned char *bytes, size_t size)
{
    if (size < 8 || memcmp(bytes, "\x89PNG", 4) != 0)
        return;
    for (size_t at = 8; size - at >= 12;) {
        uint32_t length = big_endian(bytes + at);
        if (length > size - at - 12)
            return;
        uint32_t sum = (uint32_t)crc32(0, bytes + at + 4, length + 4);
        for (int i = 0; i < 4; i++)
            bytes[at + 8 + length + (size_t)i] = (unsigned char)(sum >> 8 * (3 - i));
        at += length + 12;
    }
}

/* Every sample is looked at, so that a sanitizer sees those that were never set. */
static void check(const lr_image *image)
{
    size_t count = (size_t)image->channels * image->width * image->height;
    if (count == 0 || count > LR_IMAGE_MAX_SAMPLES || image->maxval > 65535)
        abort();
    for (size_t i = 0; i < count; i++)
        if (image->maxval && !(image->samples[i] >= 0 && image->samples[i] <= 1))
            abort();
    for (uint32_t i = 0; i < image->text_count; i++)
        if (!lr_image_find_text(image, image->texts[i].key))
            abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    lr_image image = {0};
    lr_error error = {0};
    unsigned char *bytes = malloc(size);
    if (size < 8 || !bytes) { /* PNG is known by as many */
        free(bytes);
        return 0;
    }
    memcpy(bytes, data, size);
    mend_checksums(bytes, size);
    image_file file = {bytes, size, "file"};
    lr_status status = READER(&file, &image, &error);
    if (status == LR_OK)
        check(&image);
    else if (!error.message[0])
        abort();
    lr_image_free(&image);
    free(bytes);
    return 0;
}
