#include "image/words.h"

#include "image/image_internal.h"

enum { ZIP_LEVEL = 1 }; /* the low words are noise, at which any level fails; the rest is easy */

lr_status lr_words_encode(const lr_picture *picture, const lr_words *words, const lr_text *texts,
                          uint32_t text_count, unsigned char **bytes, size_t *size, lr_error *error)
{
    image_exr_source sources[LR_WORDS_MAX + 1] = {{
        .name = "",
        .letters = "RGB",
        .type = IMAGE_EXR_FLOAT,
        .samples = picture->pixels,
        .stride = 3 * sizeof(float),
        .light = true,
    }};
    for (uint32_t i = 0; i < words->count; i++)
        sources[i + 1] = (image_exr_source){
            .name = words->names[i],
            .letters = "",
            .type = IMAGE_EXR_UINT,
            .samples = &words->words[i],
            .stride = words->count * sizeof(uint32_t),
        };
    image_exr exr = {
        .width = picture->width,
        .height = picture->height,
        .sources = sources,
        .source_count = words->count + 1,
        .texts = texts,
        .text_count = text_count,
        .zip_level = ZIP_LEVEL,
        .what = "the sums of ",
    };
    return image_exr_write(&exr, bytes, size, error);
}
