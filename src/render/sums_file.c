/* Sums in EXR files. The picture that they make is there as well, for programs that show it; it is
 * not read again. */
#include "render/sums.h"

#include <sha2.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "image/words.h"

#define FILE_LIMIT ((size_t)1 << 31) /* bytes; about what the largest film fills */

#define SHOWN "%.500s"

#define KEY_NUMBERS "lavaray.numbers"
#define KEY_PART "lavaray.part"
#define KEY_LOOK "lavaray.look"
#define KEY_CHECKSUM "lavaray.checksum"

/* In the order of the film's words. */
static const char *const channels[LR_FILM_WORDS] = {
    "low.R", "high.R", "low.G", "high.G", "low.B", "high.B", "overflow", "samples",
};

typedef struct file_texts {
    char part[64], look[64], checksum[65];
} file_texts;

static void put_text(SHA2_CTX *context, const char *text)
{
    lr_hash_update(context, text, strlen(text) + 1);
}

/* SHA-256 over the texts, each with a 0 behind it, and all words, little-endian. */
static void hash_sums(const lr_sums *sums, file_texts *texts)
{
    SHA2_CTX context;
    unsigned char block[4096], digest[SHA256_DIGEST_LENGTH];
    size_t used = 0, words = (size_t)sums->width * sums->height * LR_FILM_WORDS;
    SHA256Init(&context);
    put_text(&context, sums->id.software);
    put_text(&context, sums->id.numbers);
    put_text(&context, sums->id.settings);
    put_text(&context, sums->scene);
    put_text(&context, texts->part);
    put_text(&context, texts->look);
    for (size_t i = 0; i < words; i++) {
        for (int shift = 0; shift < 32; shift += 8)
            block[used++] = (unsigned char)(sums->film[i] >> shift);
        if (used == sizeof block) {
            lr_hash_update(&context, block, used);
            used = 0;
        }
    }
    lr_hash_update(&context, block, used);
    SHA256Final(digest, &context);
    lr_hash_text(digest, texts->checksum);
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static lr_status encode(const lr_sums *sums, unsigned char **bytes, size_t *size, lr_error *error)
{
    lr_picture picture = {sums->width, sums->height, NULL};
    picture.pixels = lr_alloc((size_t)sums->width * sums->height, 3 * sizeof(float));
    if (!picture.pixels)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for a file of %ux%u pixels",
                       sums->width, sums->height);
    lr_sums_resolve(sums, picture.pixels);
    file_texts own;
    snprintf(own.part, sizeof own.part, "samples %u-%u of %u", sums->first,
             sums->first + sums->count - 1, sums->samples);
    snprintf(own.look, sizeof own.look, "%08x %08x %s", bits_of(sums->exposure),
             bits_of(sums->white), lr_tone_name(sums->tone));
    hash_sums(sums, &own);
    const lr_text texts[] = {
        {LR_STAMP_SOFTWARE, sums->id.software},
        {LR_STAMP_SCENE, sums->scene},
        {KEY_NUMBERS, sums->id.numbers},
        {LR_STAMP_SETTINGS, sums->id.settings},
        {KEY_PART, own.part},
        {KEY_LOOK, own.look},
        {KEY_CHECKSUM, own.checksum},
    };
    lr_words words = {channels, LR_FILM_WORDS, sums->film};
    lr_status status =
        lr_words_encode(&picture, &words, texts, sizeof texts / sizeof *texts, bytes, size, error);
    lr_picture_free(&picture);
    return status;
}

lr_status lr_sums_write(const lr_sums *sums, const char *path, lr_error *error)
{
    unsigned char *bytes;
    size_t size;
    lr_status status = encode(sums, &bytes, &size, error);
    if (status)
        return status;
    status = lr_file_write(path, bytes, size, error);
    free(bytes);
    return status;
}

/* ---- Reading ------------------------------------------------------------------------------ */

/* A decimal number at *text, and behind it the text `next`; moves *text behind that. */
static bool take_number(const char **text, const char *next, uint32_t *number)
{
    uint64_t value = 0;
    size_t digits = strspn(*text, "0123456789");
    if (digits < 1 || digits > 6)
        return false;
    for (size_t i = 0; i < digits; i++)
        value = 10 * value + (uint64_t)((*text)[i] - '0');
    *number = (uint32_t)value;
    *text += digits;
    bool follows = strncmp(*text, next, strlen(next)) == 0;
    *text += follows ? strlen(next) : 0;
    return follows;
}

static bool take_part(const char *text, lr_sums *sums)
{
    static const char begin[] = "samples ";
    uint32_t last;
    if (strncmp(text, begin, sizeof begin - 1) != 0)
        return false;
    text += sizeof begin - 1;
    bool good = take_number(&text, "-", &sums->first) && take_number(&text, " of ", &last) &&
                take_number(&text, "", &sums->samples) && *text == '\0' && sums->first <= last &&
                last < sums->samples && sums->samples <= 65536;
    sums->count = good ? last - sums->first + 1 : 0;
    return good;
}

/* A float as the 8 digits of its bits, which no locale changes, and a space. */
static bool take_float(const char **text, float min, float max, float *value)
{
    if (strspn(*text, "0123456789abcdef") != 8 || (*text)[8] != ' ')
        return false;
    uint32_t bits = (uint32_t)strtoul(*text, NULL, 16);
    memcpy(value, &bits, sizeof bits);
    *text += 9;
    return *value >= min && *value <= max;
}

static bool take_look(const char *text, lr_sums *sums)
{
    if (!take_float(&text, -64, 64, &sums->exposure) ||
        !take_float(&text, 0, LR_WHITE_MAX, &sums->white) ||
        (sums->white > 0 && sums->white < LR_WHITE_MIN))
        return false;
    int tone = 0;
    while (lr_tone_name((lr_tone)tone) && strcmp(lr_tone_name((lr_tone)tone), text) != 0)
        tone++;
    sums->tone = (lr_tone)tone;
    return lr_tone_name(sums->tone) != NULL;
}

/* Copies a text of the file; false when there is none or no room for it. */
static bool take_text(const lr_image *image, const char *key, char *out, size_t size)
{
    const char *text = lr_image_find_text(image, key);
    if (!text || strlen(text) >= size)
        return false;
    memcpy(out, text, strlen(text) + 1);
    return true;
}

static lr_status take_texts(const lr_image *image, const char *name, lr_sums *sums,
                            file_texts *texts, lr_error *error)
{
    bool good = take_text(image, LR_STAMP_SOFTWARE, sums->id.software, sizeof sums->id.software) &&
                take_text(image, KEY_NUMBERS, sums->id.numbers, sizeof sums->id.numbers) &&
                take_text(image, LR_STAMP_SETTINGS, sums->id.settings, sizeof sums->id.settings) &&
                take_text(image, LR_STAMP_SCENE, sums->scene, sizeof sums->scene) &&
                take_text(image, KEY_PART, texts->part, sizeof texts->part) &&
                take_part(texts->part, sums) &&
                take_text(image, KEY_LOOK, texts->look, sizeof texts->look) &&
                take_look(texts->look, sums);
    return good ? LR_OK
                : lr_fail(error, LR_ERROR_FILE,
                          SHOWN ": holds no sums of a render: it does not say of which one", name);
}

/* No pixel has samples or flags that it cannot have. */
static bool counts_fit(const lr_sums *sums)
{
    size_t pixels = (size_t)sums->width * sums->height;
    const uint32_t *pixel = sums->film;
    for (size_t i = 0; i < pixels; i++, pixel += LR_FILM_WORDS)
        if (pixel[LR_FILM_SAMPLES] > sums->count || pixel[LR_FILM_FLAGS] > 7)
            return false;
    return true;
}

lr_status lr_sums_decode(const unsigned char *bytes, size_t size, const char *name, lr_sums *sums,
                         lr_error *error)
{
    lr_image image = {0};
    file_texts texts;
    *sums = (lr_sums){0};
    lr_status status = lr_words_decode(bytes, size, name, channels, LR_FILM_WORDS, &image, error);
    if (!status)
        status = take_texts(&image, name, sums, &texts, error);
    size_t words = (size_t)image.width * image.height * LR_FILM_WORDS;
    if (!status) {
        sums->width = image.width;
        sums->height = image.height;
        sums->film = lr_alloc_large(words, sizeof *sums->film);
        if (!sums->film)
            status = lr_fail(error, LR_ERROR_MEMORY, SHOWN ": out of memory for its sums", name);
    }
    if (!status) {
        memcpy(sums->film, image.samples, words * sizeof *sums->film);
        hash_sums(sums, &texts);
        const char *checksum = lr_image_find_text(&image, KEY_CHECKSUM);
        if (!checksum || strcmp(checksum, texts.checksum) != 0 || !counts_fit(sums))
            status =
                lr_fail(error, LR_ERROR_FILE,
                        SHOWN ": is damaged: its checksum is wrong; render this part again", name);
    }
    if (status)
        lr_sums_free(sums);
    lr_image_free(&image);
    return status;
}

lr_status lr_sums_read(const char *path, lr_sums *sums, lr_error *error)
{
    char *bytes;
    size_t size;
    *sums = (lr_sums){0};
    lr_status status = lr_file_read(path, FILE_LIMIT, &bytes, &size, error);
    if (status)
        return status;
    const char *name = strcmp(path, "-") == 0 ? "standard input" : path;
    status = lr_sums_decode((unsigned char *)bytes, size, name, sums, error);
    free(bytes);
    return status;
}
