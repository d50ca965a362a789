#include "scene/texture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "image/read.h"
#include "scene/part.h"
#include "scene/path.h"

/* Of a name in a message, so that a long one leaves room for the reason. */
#define SHOWN "%.500s"

static uint64_t texels_of(const lr_scene *scene)
{
    uint64_t texels = 0;
    for (uint32_t i = 0; scene && i < scene->texture_count; i++)
        texels += (uint64_t)scene->textures[i].width * scene->textures[i].height;
    return texels;
}

static lr_status check_size(const lr_scene_builder *builder, uint32_t width, uint32_t height,
                            const char *name, lr_error *error)
{
    if (width > LR_TEXTURE_SIDE_MAX || height > LR_TEXTURE_SIDE_MAX)
        return lr_fail(error, LR_ERROR_FILE,
                       SHOWN ": %u x %u texels; a texture has at most %d along a side: scale it "
                             "down",
                       name, width, height, LR_TEXTURE_SIDE_MAX);
    uint64_t texels =
        (uint64_t)width * height + texels_of(builder->scene) + texels_of(builder->beside);
    if (texels > LR_TEXELS_MAX)
        return lr_fail(error, LR_ERROR_FILE,
                       SHOWN ": with it the scene has over %u texels: scale its textures down",
                       name, LR_TEXELS_MAX);
    return LR_OK;
}

/* Samples are value / maxval, rounded to float, from which the value comes back exactly. */
static void fill_bytes(const lr_image *image, uint8_t *out)
{
    size_t texels = (size_t)image->width * image->height;
    uint32_t colors = image->channels < 3 ? 1 : 3;
    bool has_alpha = image->channels == colors + 1;
    const float *in = image->samples;
    for (size_t i = 0; i < texels; i++, in += image->channels, out += 4) {
        for (uint32_t channel = 0; channel < 4; channel++) {
            uint32_t from = channel == 3 ? colors : channel % colors;
            float sample = channel == 3 && !has_alpha ? 1 : in[from];
            uint32_t value = (uint32_t)lrintf(sample * (float)image->maxval);
            out[channel] = (uint8_t)((value * 510 + image->maxval) / (2 * image->maxval));
        }
    }
}

/* Returns how many samples are no colours and were replaced. */
static size_t fill_floats(const lr_image *image, lr_texture *texture)
{
    float *out = texture->floats;
    size_t texels = (size_t)image->width * image->height, replaced = 0;
    uint32_t colors = image->channels < 3 ? 1 : 3;
    const float *in = image->samples;
    for (size_t i = 0; i < texels; i++, in += image->channels) {
        for (uint32_t channel = 0; channel < 3; channel++) {
            float sample = in[channel % colors];
            bool valid = sample >= 0 && sample <= (float)LR_COLOR_MAX;
            float nearest = sample > 0 ? (float)LR_COLOR_MAX : 0;
            *out++ = valid ? sample + 0.0f /* -0 as 0 */ : nearest;
            replaced += !valid && channel < colors;
            if (!valid && !texture->changed) {
                texture->changed = (uint32_t)i + 1;
                texture->changed_from = sample;
            }
        }
    }
    return replaced;
}

static lr_status fill(lr_scene_builder *builder, const lr_image *image, const char *name,
                      lr_texture *texture, lr_error *error)
{
    lr_status status = check_size(builder, image->width, image->height, name, error);
    if (status)
        return status;
    size_t texels = (size_t)image->width * image->height;
    texture->width = image->width;
    texture->height = image->height;
    texture->name = lr_string_copy(name, strlen(name));
    if (image->maxval)
        texture->bytes = lr_alloc_large(texels, 4);
    else
        texture->floats = lr_alloc_large(texels, 3 * sizeof(float));
    if (!texture->name || (!texture->bytes && !texture->floats))
        goto no_memory;
    if (texture->bytes) {
        fill_bytes(image, texture->bytes);
    } else {
        size_t replaced = fill_floats(image, texture);
        if (replaced && !lr_scene_add_note(builder,
                                           "%.300s: %zu of its values are negative, above %g or "
                                           "not a number, and were brought into range",
                                           name, replaced, LR_COLOR_MAX))
            goto no_memory;
        bool has_alpha = image->channels == 2 || image->channels == 4;
        if (has_alpha && !lr_scene_add_note(builder, "%.300s: its alpha is not used", name))
            goto no_memory;
    }
    return LR_OK;
no_memory:
    return lr_fail(error, LR_ERROR_MEMORY, SHOWN ": out of memory for %u x %u texels", name,
                   image->width, image->height);
}

/* Makes the image the scene's next texture. */
static lr_status add(lr_scene_builder *builder, const lr_image *image, const char *name,
                     lr_wrap wrap_u, lr_wrap wrap_v, lr_texels texels, uint32_t *index,
                     lr_error *error)
{
    lr_texture texture = {.wrap_u = wrap_u, .wrap_v = wrap_v, .texels = texels};
    lr_texture *added = NULL;
    lr_status status = fill(builder, image, name, &texture, error);
    if (!status) {
        *index = builder->scene->texture_count;
        added = lr_scene_add_texture(builder);
        if (!added)
            status = lr_fail(error, LR_ERROR_MEMORY, SHOWN ": out of memory", name);
    }
    if (added) {
        *added = texture;
    } else {
        free(texture.name);
        free(texture.bytes);
        free(texture.floats);
    }
    return status;
}

lr_status lr_texture_borrow(lr_scene_builder *builder, const lr_texture *from, uint32_t *texture,
                            lr_error *error)
{
    lr_status status = check_size(builder, from->width, from->height, from->name, error);
    if (status)
        return status;
    char *name = lr_string_copy(from->name, strlen(from->name));
    lr_texture *added = name ? lr_scene_add_texture(builder) : NULL;
    if (!added) {
        free(name);
        return lr_fail(error, LR_ERROR_MEMORY, SHOWN ": out of memory", from->name);
    }
    *added = *from;
    added->name = name;
    added->borrowed = true;
    *texture = builder->scene->texture_count - 1;
    return LR_OK;
}

lr_texels lr_map_texels(lr_map_kind kind)
{
    return kind == LR_MAP_NORMAL     ? LR_TEXELS_NORMALS
           : kind == LR_MAP_EMISSION ? LR_TEXELS_COLORS
                                     : LR_TEXELS_NUMBERS;
}

/* Reads the picture into a part with one user. */
static lr_status read_part(const lr_scene_builder *builder, const char *path, lr_part **part,
                           lr_error *error)
{
    lr_scene_builder own = {.scene = lr_alloc(1, sizeof(lr_scene)), .beside = builder->scene};
    lr_file_list files = {0};
    lr_file_stamp stamp = lr_file_stamp_of(path);
    lr_image image;
    uint32_t index;
    *part = NULL;
    if (!own.scene || !lr_file_list_put(&files, path, &stamp)) {
        lr_scene_destroy(own.scene);
        return lr_fail(error, LR_ERROR_MEMORY, SHOWN ": out of memory", path);
    }
    lr_status status = lr_image_read(path, &image, error);
    if (!status)
        status = add(&own, &image, path, LR_WRAP_REPEAT, LR_WRAP_REPEAT, LR_TEXELS_COLORS, &index,
                     error);
    lr_image_free(&image);
    if (!status) {
        *part = lr_part_create(own.scene, &files, false);
        return *part ? LR_OK : lr_fail(error, LR_ERROR_MEMORY, SHOWN ": out of memory", path);
    }
    lr_file_list_free(&files);
    lr_scene_destroy(own.scene);
    return status;
}

lr_status lr_texture_load(lr_scene_builder *builder, const char *path, lr_wrap wrap_u,
                          lr_wrap wrap_v, lr_texels texels, uint32_t *texture, lr_error *error)
{
    const lr_scene *scene = builder->scene;
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        const lr_texture *known = &scene->textures[i];
        if (known->wrap_u == wrap_u && known->wrap_v == wrap_v && known->texels == texels &&
            !strcmp(known->name, path)) {
            *texture = i;
            return LR_OK;
        }
    }
    lr_status status = LR_OK;
    lr_part *part = lr_part_find(builder, path, false);
    if (!part)
        status = read_part(builder, path, &part, error);
    if (status)
        return status;
    bool good = lr_scene_add_part(builder, part);
    const lr_scene *content = good ? part->content : NULL;
    if (good)
        status = lr_texture_borrow(builder, &content->textures[0], texture, error);
    if (good && !status) {
        lr_texture *added = &builder->scene->textures[*texture];
        added->wrap_u = wrap_u;
        added->wrap_v = wrap_v;
        added->texels = texels;
        for (uint32_t i = 0; i < content->note_count && good; i++)
            good = lr_scene_add_note(builder, "%s", content->notes[i]);
    }
    return good ? status : lr_fail(error, LR_ERROR_MEMORY, SHOWN ": out of memory", path);
}

lr_status lr_texture_decode(lr_scene_builder *builder, const void *bytes, size_t length,
                            const char *name, lr_wrap wrap_u, lr_wrap wrap_v, lr_texels texels,
                            uint32_t *texture, lr_error *error)
{
    lr_image image;
    lr_status status = lr_image_decode(bytes, length, name, &image, error);
    if (!status)
        status = add(builder, &image, name, wrap_u, wrap_v, texels, texture, error);
    lr_image_free(&image);
    return status;
}
