/* Sums of films, and the files of parts and checkpoints. */
#include "image_tests.h"
#include "temporary_folder.h"

#include "base/file.h"
#include "image/words.h"
#include "render/sums.h"

enum { WIDTH = 5, HEIGHT = 3, PIXELS = WIDTH * HEIGHT, WORDS = PIXELS * LR_FILM_WORDS };

static uint32_t random_bits(uint32_t *seed)
{
    *seed = *seed * 747796405u + 2891336453u;
    return (*seed >> 22 ^ *seed) * 277803737u;
}

static void set_sum(uint32_t *pixel, uint32_t channel, uint64_t sum)
{
    pixel[2 * channel] = (uint32_t)sum;
    pixel[2 * channel + 1] = (uint32_t)(sum >> 32);
}

static uint64_t sum_of(const uint32_t *pixel, uint32_t channel)
{
    return pixel[2 * channel] | (uint64_t)pixel[2 * channel + 1] << 32;
}

static void test_addition_carries(void **state)
{
    (void)state;
    uint32_t a[LR_FILM_WORDS] = {0}, b[LR_FILM_WORDS] = {0};
    set_sum(a, 0, 0xFFFFFFFFu);
    set_sum(b, 0, 1);
    set_sum(a, 1, UINT64_MAX - 1);
    set_sum(b, 1, 1);
    set_sum(a, 2, UINT64_MAX);
    set_sum(b, 2, 5);
    a[LR_FILM_SAMPLES] = 3;
    b[LR_FILM_SAMPLES] = 4;
    b[LR_FILM_FLAGS] = 1;
    lr_film_add(a, b);
    assert_true(sum_of(a, 0) == (uint64_t)1 << 32);
    assert_true(sum_of(a, 1) == UINT64_MAX);
    assert_true(sum_of(a, 2) == 4);
    assert_int_equal(a[LR_FILM_FLAGS], 1 | 1 << 2);
    assert_int_equal(a[LR_FILM_SAMPLES], 7);
}

/* Three films whose sums overflow in some orders of addition earlier than in others. */
static void test_order_does_not_matter(void **state)
{
    (void)state;
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                     {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    uint32_t seed = 7;
    for (int round = 0; round < 1000; round++) {
        uint32_t films[3][LR_FILM_WORDS];
        float first[3], other[3];
        for (int i = 0; i < 3; i++) {
            for (uint32_t word = 0; word < LR_FILM_FLAGS; word++)
                films[i][word] = random_bits(&seed) >> (word & 1 ? random_bits(&seed) % 4 : 0);
            films[i][LR_FILM_FLAGS] = 0;
            films[i][LR_FILM_SAMPLES] = 1 + random_bits(&seed) % 100;
        }
        for (int order = 0; order < 6; order++) {
            uint32_t sum[LR_FILM_WORDS] = {0};
            for (int i = 0; i < 3; i++)
                lr_film_add(sum, films[orders[order][i]]);
            lr_film_resolve(sum, 1, order ? other : first);
            if (order)
                assert_memory_equal(first, other, sizeof first);
        }
    }
}

static lr_sums make_sums(void)
{
    static uint32_t film[WORDS];
    lr_sums sums = {
        .id = {"lavaray 1.2.3", "0123456789abcdef", "5x3, 64 samples, depth 6, seed 0"},
        .scene = "fedcba9876543210",
        .exposure = -1.1f,
        .white = 5000.5f,
        .tone = LR_TONE_ACES,
        .width = WIDTH,
        .height = HEIGHT,
        .samples = 64,
        .first = 16,
        .count = 32,
        .film = film,
    };
    uint32_t seed = 3;
    for (int i = 0; i < WORDS; i++)
        film[i] = random_bits(&seed);
    for (int i = 0; i < PIXELS; i++) {
        film[i * LR_FILM_WORDS + LR_FILM_FLAGS] &= 7;
        film[i * LR_FILM_WORDS + LR_FILM_SAMPLES] %= 33;
    }
    return sums;
}

static unsigned char *written(const lr_sums *sums, size_t *size)
{
    char path[100];
    char *bytes;
    lr_error error = {0};
    snprintf(path, sizeof path, "%s/part.exr", folder);
    if (lr_sums_write(sums, path, &error) || lr_file_read(path, 1 << 20, &bytes, size, &error))
        fail_msg("%s", error.message);
    return (unsigned char *)bytes;
}

static void test_files_come_back(void **state)
{
    (void)state;
    lr_sums sums = make_sums(), back;
    lr_error error = {0};
    size_t size;
    unsigned char *bytes = written(&sums, &size);
    if (lr_sums_decode(bytes, size, "x", &back, &error))
        fail_msg("%s", error.message);
    assert_memory_equal(sums.film, back.film, WORDS * sizeof *sums.film);
    assert_string_equal(sums.id.software, back.id.software);
    assert_string_equal(sums.id.numbers, back.id.numbers);
    assert_string_equal(sums.id.settings, back.id.settings);
    assert_string_equal(sums.scene, back.scene);
    assert_true(sums.exposure == back.exposure && sums.white == back.white);
    assert_int_equal(sums.tone, back.tone);
    assert_int_equal(back.width, WIDTH);
    assert_int_equal(back.height, HEIGHT);
    assert_int_equal(back.samples, 64);
    assert_int_equal(back.first, 16);
    assert_int_equal(back.count, 32);
    /* Other programs see the picture. */
    float pixels[3 * PIXELS];
    lr_image image = decode_bytes(bytes, size);
    lr_sums_resolve(&sums, pixels);
    assert_memory_equal(image.samples, pixels, sizeof pixels);
    lr_image_free(&image);
    lr_sums_free(&back);
    free(bytes);
}

/* Every bit may be wrong and the file may end anywhere: it is refused, or the bit did not matter.
 */
static void test_damage_is_seen(void **state)
{
    (void)state;
    lr_sums sums = make_sums(), back;
    size_t size, refused = 0;
    unsigned char *bytes = written(&sums, &size);
    for (size_t bit = 0; bit < 8 * size; bit++) {
        lr_error error = {0};
        bytes[bit / 8] ^= (unsigned char)(1 << bit % 8);
        if (lr_sums_decode(bytes, size, "x", &back, &error) == LR_OK) {
            assert_memory_equal(sums.film, back.film, WORDS * sizeof *sums.film);
            assert_string_equal(sums.id.settings, back.id.settings);
            assert_int_equal(sums.first, back.first);
            lr_sums_free(&back);
        } else {
            assert_true(error.message[0] != '\0');
            refused++;
        }
        bytes[bit / 8] ^= (unsigned char)(1 << bit % 8);
    }
    assert_true(refused > 8 * WORDS);
    for (size_t length = 0; length < size; length++) {
        lr_error error = {0};
        unsigned char *cut = malloc(length + 1);
        memcpy(cut, bytes, length);
        assert_int_equal(lr_sums_decode(cut, length, "x", &back, &error), LR_ERROR_FILE);
        free(cut);
    }
    free(bytes);
}

/* A file whose checksum is right and whose contents are not. */
static void refuse(const lr_sums *sums)
{
    lr_sums back;
    lr_error error = {0};
    size_t size;
    unsigned char *bytes = written(sums, &size);
    assert_int_equal(lr_sums_decode(bytes, size, "x", &back, &error), LR_ERROR_FILE);
    assert_non_null(strstr(error.message, "x: "));
    free(bytes);
}

static void test_lies_are_refused(void **state)
{
    (void)state;
    lr_sums sums = make_sums();
    sums.film[LR_FILM_SAMPLES] = 33;
    refuse(&sums);
    sums = make_sums();
    sums.film[LR_FILM_FLAGS] = 8;
    refuse(&sums);
    sums = make_sums();
    sums.samples = 47; /* the last is number 47 */
    refuse(&sums);
    sums = make_sums();
    sums.samples = 65537;
    refuse(&sums);
    sums = make_sums();
    sums.count = 0; /* samples 16-15 */
    refuse(&sums);
    sums = make_sums();
    sums.exposure = 65;
    refuse(&sums);
    sums = make_sums();
    sums.white = 1;
    refuse(&sums);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_addition_carries), cmocka_unit_test(test_order_does_not_matter),
        cmocka_unit_test(test_files_come_back),  cmocka_unit_test(test_damage_is_seen),
        cmocka_unit_test(test_lies_are_refused),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
