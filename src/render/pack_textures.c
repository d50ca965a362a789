/* Textures: their records are the first rows, so that materials can name them, their texels the
 * last. */
#include <math.h>
#include <string.h>

#include "render/pack.h"
#include "scene/color.h"

static lr_status no_memory(lr_error *error)
{
    return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's textures");
}

static uint32_t count_textures(const lr_scene *scene)
{
    return scene->texture_count + (scene->background.kind == LR_BACKGROUND_SKY);
}

lr_status lr_pack_texture_records(const lr_scene *scene, lr_packed_scene *packed, lr_error *error)
{
    static const struct gpu_texture empty;
    for (uint32_t i = 0; i < count_textures(scene); i++)
        if (lr_pack_rows(packed, &empty, 1) == UINT32_MAX)
            return no_memory(error);
    return LR_OK;
}

/* The value of each byte; of colours the same as in a scene. */
static double value_of(lr_texels texels, unsigned byte)
{
    switch (texels) {
    case LR_TEXELS_COLORS:
        return lr_srgb_to_linear(byte);
    case LR_TEXELS_NUMBERS:
        return byte / 255.0;
    case LR_TEXELS_NORMALS:
        return fmax((byte - 128.0) / 127, -1);
    }
    return 0;
}

static bool pack_curve(lr_texels texels, lr_packed_scene *packed)
{
    for (unsigned i = 0; i < 256; i++) {
        vec4 row = {.x = (float)value_of(texels, i)};
        if (lr_pack_rows(packed, &row, 1) == UINT32_MAX)
            return false;
    }
    return true;
}

/* A curve for each kind of texels that there is; curves[] are their rows. */
static bool pack_curves(const lr_scene *scene, lr_packed_scene *packed,
                        uint32_t curves[LR_TEXELS_NORMALS + 1])
{
    for (lr_texels texels = LR_TEXELS_COLORS; texels <= LR_TEXELS_NORMALS; texels++) {
        bool used = texels == LR_TEXELS_COLORS;
        for (uint32_t i = 0; i < scene->texture_count; i++)
            used = used || scene->textures[i].texels == texels;
        curves[texels] = packed->row_count;
        if (used && !pack_curve(texels, packed))
            return false;
    }
    return true;
}

static bool pack_bytes(const lr_texture *texture, lr_packed_scene *packed)
{
    size_t count = (size_t)texture->width * texture->height;
    for (size_t i = 0; i < count; i += 4) {
        uint32_t row[4] = {0};
        for (size_t k = 0; k < 4 && i + k < count; k++) {
            const uint8_t *texel = &texture->bytes[4 * (i + k)];
            row[k] = texel[0] | (uint32_t)texel[1] << 8 | (uint32_t)texel[2] << 16 |
                     (uint32_t)texel[3] << 24;
        }
        if (lr_pack_rows(packed, row, 1) == UINT32_MAX)
            return false;
    }
    return true;
}

static bool pack_floats(const lr_texture *texture, lr_packed_scene *packed)
{
    size_t count = (size_t)texture->width * texture->height;
    /* Normals from 0..1 to -1..1. */
    float scale = texture->texels == LR_TEXELS_NORMALS ? 2 : 1, shift = scale - 1;
    for (size_t i = 0; i < count; i++) {
        const float *texel = &texture->floats[3 * i];
        vec4 row = {texel[0] * scale - shift, texel[1] * scale - shift, texel[2] * scale - shift,
                    1};
        if (lr_pack_rows(packed, &row, 1) == UINT32_MAX)
            return false;
    }
    return true;
}

lr_status lr_pack_textures(const lr_scene *scene, lr_packed_scene *packed, lr_error *error)
{
    static const uint32_t wraps[] = {
        [LR_WRAP_REPEAT] = LR_GPU_WRAP_REPEAT,
        [LR_WRAP_CLAMP] = LR_GPU_WRAP_CLAMP,
        [LR_WRAP_MIRROR] = LR_GPU_WRAP_MIRROR,
    };
    if (count_textures(scene) == 0)
        return LR_OK;
    uint32_t curves[LR_TEXELS_NORMALS + 1];
    if (!pack_curves(scene, packed, curves))
        return no_memory(error);
    for (uint32_t i = 0; i < count_textures(scene); i++) {
        bool own = i < scene->texture_count;
        const lr_texture *texture = own ? &scene->textures[i] : &packed->sky;
        struct gpu_texture record = {
            .texels = packed->row_count,
            .size = texture->width | texture->height << 16,
            .curve = curves[texture->texels],
            .flags = wraps[texture->wrap_u] | wraps[texture->wrap_v] << 2 |
                     (texture->floats ? LR_GPU_TEXTURE_FLOATS : 0),
        };
        bool fits = texture->floats ? pack_floats(texture, packed) : pack_bytes(texture, packed);
        if (!fits)
            return no_memory(error);
        memcpy(&packed->rows[i], &record, sizeof record);
    }
    return LR_OK;
}
