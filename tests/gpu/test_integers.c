/* The integers of the kernels: the film's fixed point, checker cells, lists of media. */
#include "gpu_tests.h"

#include "sheet.spv.h"

#define COUNT 131072u

typedef struct words {
    uint32_t x, y, z, w;
} words;

typedef struct item {
    union {
        vec4 a;
        words media;
    };
    words b, c;
} item;

enum { FILM_FIXED = 5, CELL_INDEX, MEDIA_WITH, MEDIA_WITHOUT, MEDIA_LOOK };

static item given[COUNT];
static words found[COUNT];

static void run(void **state, uint32_t which)
{
    run_kernel(*state, &(kernel){.words = sheet_spv,
                                 .word_count = sizeof sheet_spv / 4,
                                 .in = given,
                                 .in_size = sizeof given,
                                 .out = found,
                                 .out_size = sizeof found,
                                 .which = which,
                                 .groups = COUNT / LR_GROUP_SIZE});
}

/* Truncated to steps of 2^-36, and clipped from 2^28 on. */
static void test_film_fixed(void **state)
{
    uint32_t seed = 1;
    memset(given, 0, sizeof given);
    for (uint32_t i = 0; i < COUNT; i++)
        given[i].a.x = random_magnitude(&seed, i % 4 ? -40 : -126, i % 4 ? 30 : 127);
    const float edges[] = {0,
                           1e-45f,
                           1,
                           0.5f,
                           ldexpf(1, -36),
                           nextafterf(ldexpf(1, -36), 0),
                           ldexpf(1, -4),
                           nextafterf(ldexpf(1, -4), 0),
                           ldexpf(1, -5),
                           ldexpf(1, 27),
                           nextafterf(ldexpf(1, 28), 0),
                           ldexpf(1, 28),
                           3.4e38f};
    for (uint32_t i = 0; i < sizeof edges / sizeof *edges; i++)
        given[i].a.x = edges[i];
    run(state, FILM_FIXED);
    for (uint32_t i = 0; i < COUNT; i++) {
        float value = given[i].a.x;
        uint64_t expected =
            value < LR_FILM_MAX ? (uint64_t)ldexp(value, LR_FILM_STEP_BITS) : UINT64_MAX;
        uint64_t got = found[i].x | (uint64_t)found[i].y << 32;
        if (got != expected)
            fail_msg("%.9g is %llu steps, expected %llu", value, (unsigned long long)got,
                     (unsigned long long)expected);
    }
}

static void test_cell_index(void **state)
{
    uint32_t seed = 2;
    for (uint32_t i = 0; i < COUNT; i++) {
        /* Coordinates on and around boundaries, then anywhere; normals of every kind. */
        static const float normals[] = {0, 1, -1, 0.3f, -0.3f, 1e-7f, -1e-7f};
        float boundary = (float)(int)(random_bits(&seed) % 201) - 100;
        float c = boundary + random_between(&seed, -9e-5, 9e-5);
        given[i].a = (vec4){i % 2 ? c : random_between(&seed, -1000, 1000),
                            normals[random_bits(&seed) % 7], boundary, 0};
    }
    run(state, CELL_INDEX);
    for (uint32_t i = 0; i < COUNT; i++) {
        float c = given[i].a.x, n = given[i].a.y, boundary = given[i].a.z;
        int32_t cell = (int32_t)found[i].x;
        bool faces = fabsf(n) > 1e-6f;
        if (i % 2 && faces) /* behind the surface, on whichever side of the boundary c came out */
            assert_int_equal(cell, (int)boundary - (n > 0 ? 1 : 0));
        else if (!faces)
            assert_int_equal(cell, (int)floorf(c));
        else
            assert_int_equal(cell, (int)floorf(c + (n > 0 ? -1e-4f : 1e-4f)));
    }
}

static void test_cell_index_far_away(void **state)
{
    memset(given, 0, sizeof given);
    given[0].a.x = 1e30f;
    given[1].a.x = -1e30f;
    given[2].a.x = 3.4e38f;
    run(state, CELL_INDEX);
    assert_int_equal((int32_t)found[0].x, 1000000000);
    assert_int_equal((int32_t)found[1].x, -1000000000);
    assert_int_equal((int32_t)found[2].x, 1000000000);
}

/* ---- Lists of media ------------------------------------------------------------------------ */

static void unpack(words media, uint32_t ranks[LR_MEDIA_MAX])
{
    const uint32_t all[] = {media.x, media.y, media.z, media.w};
    for (uint32_t i = 0; i < LR_MEDIA_MAX; i++)
        ranks[i] = i % 2 ? all[i / 2] >> 16 : all[i / 2] & 0xFFFF;
}

static uint32_t count_rank(words media, uint32_t rank)
{
    uint32_t ranks[LR_MEDIA_MAX], count = 0;
    unpack(media, ranks);
    for (uint32_t i = 0; i < LR_MEDIA_MAX; i++)
        count += ranks[i] == rank;
    return count;
}

/* Lists of 0 to 8 different ranks at random places, and a rank to add or to take. */
static void fill_media(uint32_t seed)
{
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t ranks[LR_MEDIA_MAX] = {0}, base = 1 + random_bits(&seed) % 60000;
        uint32_t many = random_bits(&seed) % 4 ? 256 : 1; /* often full */
        for (uint32_t k = 0; k < LR_MEDIA_MAX; k++)
            if (many == 1 || random_bits(&seed) % 2)
                ranks[k] = base + (k * 617 + i) % 5000 + 1;
        given[i].media = (words){ranks[0] | ranks[1] << 16, ranks[2] | ranks[3] << 16,
                                 ranks[4] | ranks[5] << 16, ranks[6] | ranks[7] << 16};
        uint32_t present = ranks[random_bits(&seed) % LR_MEDIA_MAX];
        given[i].b.x = i % 2 && present ? present : 65535;
    }
}

static void test_media_add(void **state)
{
    fill_media(3);
    for (uint32_t i = 0; i < COUNT; i++)
        given[i].b.x = 65535; /* the caller adds only what is not there */
    run(state, MEDIA_WITH);
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t before[LR_MEDIA_MAX], room = count_rank(given[i].media, 0);
        unpack(given[i].media, before);
        assert_int_equal(count_rank(found[i], 65535), room > 0);
        assert_int_equal(count_rank(found[i], 0), room > 0 ? room - 1 : 0);
        for (uint32_t k = 0; k < LR_MEDIA_MAX; k++)
            assert_true(!before[k] || count_rank(found[i], before[k]) == 1);
    }
    run(state, MEDIA_LOOK);
    for (uint32_t i = 0; i < COUNT; i++)
        assert_int_equal(found[i].z, count_rank(given[i].media, 0) > 0);
}

static void test_media_take(void **state)
{
    fill_media(4);
    run(state, MEDIA_WITHOUT);
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t rank = given[i].b.x, before[LR_MEDIA_MAX], after[LR_MEDIA_MAX];
        unpack(given[i].media, before);
        unpack(found[i], after);
        for (uint32_t k = 0; k < LR_MEDIA_MAX; k++)
            assert_int_equal(after[k], before[k] == rank ? 0 : before[k]);
    }
}

static void test_media_look(void **state)
{
    fill_media(5);
    run(state, MEDIA_LOOK);
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t ranks[LR_MEDIA_MAX], top = 0;
        unpack(given[i].media, ranks);
        for (uint32_t k = 0; k < LR_MEDIA_MAX; k++)
            top = ranks[k] > top ? ranks[k] : top;
        assert_int_equal(found[i].x, top);
        assert_int_equal(found[i].y, count_rank(given[i].media, given[i].b.x) > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_film_fixed),           cmocka_unit_test(test_cell_index),
        cmocka_unit_test(test_cell_index_far_away),  cmocka_unit_test(test_media_add),
        cmocka_unit_test(test_media_take),           cmocka_unit_test(test_media_look),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
