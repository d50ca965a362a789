#include "image/image.h"

#include <sha2.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/hash.h"

void lr_picture_free(lr_picture *picture)
{
    if (!picture)
        return;
    free(picture->pixels);
    *picture = (lr_picture){0};
}

static void put_little_endian(unsigned char *out, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        out[i] = (unsigned char)(value >> 8 * i);
}

void lr_picture_hash(const lr_picture *picture, char hash[65])
{
    SHA2_CTX context;
    unsigned char block[4096], digest[SHA256_DIGEST_LENGTH];
    SHA256Init(&context);
    put_little_endian(block, picture->width);
    put_little_endian(block + 4, picture->height);
    size_t used = 8, count = 3 * (size_t)picture->width * picture->height;
    for (size_t i = 0; i < count; i++) {
        float value = picture->pixels[i];
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        put_little_endian(block + used, bits == 0x80000000u ? 0 : bits);
        used += 4;
        if (used == sizeof block) {
            lr_hash_update(&context, block, used);
            used = 0;
        }
    }
    lr_hash_update(&context, block, used);
    SHA256Final(digest, &context);
    lr_hash_text(digest, hash);
}

/* Plain ASCII, unlike strcasecmp, which asks the locale. */
static bool ends_with(const char *path, const char *ending)
{
    size_t length = strlen(path), ending_length = strlen(ending);
    if (length < ending_length)
        return false;
    path += length - ending_length;
    for (; *ending; path++, ending++)
        if ((*path >= 'A' && *path <= 'Z' ? *path - 'A' + 'a' : *path) != *ending)
            return false;
    return true;
}

bool lr_format_from_path(const char *path, lr_format *format)
{
    static const struct {
        const char *ending;
        lr_format format;
    } table[] = {
        {".ppm", LR_FORMAT_PPM},
        {".png", LR_FORMAT_PNG},
        {".pfm", LR_FORMAT_PFM},
        {".exr", LR_FORMAT_EXR},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (ends_with(path, table[i].ending)) {
            *format = table[i].format;
            return true;
        }
    return false;
}

lr_status lr_picture_write(const lr_picture *picture, const char *path, const lr_encoding *encoding,
                           lr_error *error)
{
    unsigned char *bytes;
    size_t size;
    lr_status status = lr_picture_encode(picture, encoding, &bytes, &size, error);
    if (status != LR_OK)
        return status;
    status = lr_file_write(path, bytes, size, error);
    free(bytes);
    return status;
}
