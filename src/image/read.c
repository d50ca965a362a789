#include "image/read_internal.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"

#define FILE_LIMIT ((size_t)1 << 31) /* bytes; as many samples as there may be fit as text */

/* Of a name in a message, so that a long one leaves room for the reason. */
#define SHOWN "%.500s"

enum { MAX_TEXTS = 4096 };

/* ---- What the readers share --------------------------------------------------------------- */

static void fail(const image_file *file, lr_error *error, const char *what, const char *format,
                 va_list arguments)
{
    char reason[400];
    vsnprintf(reason, sizeof reason, format, arguments);
    lr_fail(error, LR_ERROR_FILE, SHOWN ": %s%s", file->name, what, reason);
}

lr_status image_corrupt(const image_file *file, lr_error *error, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fail(file, error, "corrupt: ", format, arguments);
    va_end(arguments);
    return LR_ERROR_FILE;
}

lr_status image_truncated(const image_file *file, lr_error *error, const char *format, ...)
{
    char what[80];
    va_list arguments;
    va_start(arguments, format);
    snprintf(what, sizeof what, "truncated: the file ends after %zu bytes, ", file->size);
    fail(file, error, what, format, arguments);
    va_end(arguments);
    return LR_ERROR_FILE;
}

lr_status image_set_size(const image_file *file, lr_image *image, uint32_t width, uint32_t height,
                         uint32_t channels, lr_error *error)
{
    if (width == 0 || height == 0)
        return lr_fail(error, LR_ERROR_FILE, SHOWN ": has no pixels: its size is %u x %u",
                       file->name, width, height);
    if (width > (uint64_t)LR_IMAGE_MAX_SAMPLES / channels / height)
        return lr_fail(error, LR_ERROR_FILE,
                       SHOWN ": too large: %u x %u pixels of %u samples; the limit is %d samples",
                       file->name, width, height, channels, LR_IMAGE_MAX_SAMPLES);
    image->width = width;
    image->height = height;
    image->channels = channels;
    return LR_OK;
}

lr_status image_allocate(const image_file *file, lr_image *image, lr_error *error)
{
    size_t count = (size_t)image->channels * image->width * image->height;
    image->samples = lr_alloc(count, sizeof *image->samples);
    if (!image->samples)
        return lr_fail(error, LR_ERROR_MEMORY, SHOWN ": out of memory for %u x %u pixels",
                       file->name, image->width, image->height);
    return LR_OK;
}

lr_status image_add_text(const image_file *file, lr_image *image, const char *key,
                         size_t key_length, const char *value, size_t value_length, lr_error *error)
{
    if (image->text_count == MAX_TEXTS)
        return lr_fail(error, LR_ERROR_FILE, SHOWN ": too large: it carries over %d texts",
                       file->name, MAX_TEXTS);
    lr_image_text *grown = realloc(image->texts, (image->text_count + 1) * sizeof *grown);
    if (!grown)
        goto out_of_memory;
    image->texts = grown;
    lr_image_text *text = &grown[image->text_count++];
    text->key = lr_string_copy(key, key_length);
    text->value = lr_string_copy(value, value_length);
    if (text->key && text->value)
        return LR_OK;
out_of_memory:
    return lr_fail(error, LR_ERROR_MEMORY, SHOWN ": out of memory for its texts", file->name);
}

/* ---- Text headers ------------------------------------------------------------------------- */

bool image_is_space(int character)
{
    return character == ' ' || (character >= '\t' && character <= '\r');
}

int image_header_character(image_header *header)
{
    const image_file *file = header->file;
    if (header->at == file->size)
        return -1;
    int character = file->bytes[header->at++];
    if (character != '#')
        return character;
    do {
        if (header->at == file->size)
            return -1;
        character = file->bytes[header->at++];
    } while (character != '\n' && character != '\r');
    return character;
}

lr_status image_header_number(image_header *header, const char *what, uint32_t limit,
                              uint32_t *value, lr_error *error)
{
    int character;
    do
        character = image_header_character(header);
    while (image_is_space(character));
    if (character < 0)
        return image_truncated(header->file, error, "before %s", what);
    uint64_t number = 0;
    size_t digits = 0;
    for (; character >= '0' && character <= '9'; character = image_header_character(header)) {
        number = number * 10 + (uint64_t)(character - '0');
        digits++;
        if (number > limit)
            return image_corrupt(header->file, error, "%s is above %u", what, limit);
    }
    if (digits == 0 || (character >= 0 && !image_is_space(character)))
        return image_corrupt(header->file, error, "byte 0x%02x at %zu in place of %s",
                             (unsigned)character, header->at - 1, digits ? "white space" : what);
    *value = (uint32_t)number;
    return LR_OK;
}

/* ---- The format --------------------------------------------------------------------------- */

typedef lr_status (*read_function)(const image_file *, lr_image *, lr_error *);

static bool begins(const image_file *file, const char *magic, size_t length)
{
    return file->size >= length && memcmp(file->bytes, magic, length) == 0;
}

static read_function find_reader(const image_file *file)
{
    const unsigned char *bytes = file->bytes;
    if (begins(file, "\x89PNG\r\n\x1a\n", 8))
        return image_read_png;
    if (begins(file, "\x76\x2f\x31\x01", 4))
        return image_read_exr;
    if (begins(file, "#?", 2))
        return image_read_hdr;
    if (begins(file, "\xff\xd8\xff", 3))
        return image_read_jpeg;
    /* A comment may follow the magic at once. */
    if (file->size < 3 || bytes[0] != 'P' || (!image_is_space(bytes[2]) && bytes[2] != '#'))
        return NULL;
    if (bytes[1] >= '1' && bytes[1] <= '6')
        return image_read_pnm;
    return bytes[1] == 'F' || bytes[1] == 'f' ? image_read_pfm : NULL;
}

lr_status lr_image_decode(const unsigned char *bytes, size_t size, const char *name,
                          lr_image *image, lr_error *error)
{
    image_file file = {bytes, size, name};
    *image = (lr_image){0};
    if (size == 0)
        return lr_fail(error, LR_ERROR_FILE, SHOWN ": the file is empty", name);
    read_function reader = find_reader(&file);
    if (!reader)
        return lr_fail(error, LR_ERROR_FILE,
                       SHOWN ": not a picture in a known format; PPM, PGM, PBM, PNG, PFM, EXR, "
                             "HDR and JPEG are known",
                       name);
    lr_status status = reader(&file, image, error);
    if (status != LR_OK)
        lr_image_free(image);
    return status;
}

lr_status lr_image_read(const char *path, lr_image *image, lr_error *error)
{
    char *bytes;
    size_t size;
    *image = (lr_image){0};
    lr_status status = lr_file_read(path, FILE_LIMIT, &bytes, &size, error);
    if (status != LR_OK)
        return status;
    const char *name = strcmp(path, "-") == 0 ? "standard input" : path;
    status = lr_image_decode((const unsigned char *)bytes, size, name, image, error);
    free(bytes);
    return status;
}

const char *lr_image_find_text(const lr_image *image, const char *key)
{
    for (uint32_t i = 0; i < image->text_count; i++)
        if (strcmp(image->texts[i].key, key) == 0)
            return image->texts[i].value;
    return NULL;
}

void lr_image_free(lr_image *image)
{
    if (!image)
        return;
    for (uint32_t i = 0; i < image->text_count; i++) {
        free(image->texts[i].key);
        free(image->texts[i].value);
    }
    free(image->texts);
    free(image->samples);
    *image = (lr_image){0};
}
