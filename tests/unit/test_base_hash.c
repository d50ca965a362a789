/* SHA-256 in pieces and by the processor's instructions, judged by libmd's own code. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>
#include <sha2.h>

#include "base/hash.h"

enum { SIZE = 5000 };

static void fill(unsigned char bytes[SIZE])
{
    uint32_t state = 1;
    for (int i = 0; i < SIZE; i++)
        bytes[i] = (unsigned char)((state = state * 1664525u + 1013904223u) >> 24);
}

static void test_sizes(void **state)
{
    (void)state;
    unsigned char bytes[SIZE];
    char ours[65], theirs[SHA256_DIGEST_STRING_LENGTH];
    fill(bytes);
    for (size_t size = 0; size < 400; size++) {
        lr_hash_bytes(bytes + size % 5, size, ours);
        assert_string_equal(ours, SHA256Data(bytes + size % 5, size, theirs));
    }
}

static void test_pieces(void **state)
{
    (void)state;
    unsigned char bytes[SIZE], digest[SHA256_DIGEST_LENGTH];
    char ours[65], theirs[SHA256_DIGEST_STRING_LENGTH];
    fill(bytes);
    SHA256Data(bytes, SIZE, theirs);
    for (size_t piece = 1; piece < 700; piece++) {
        SHA2_CTX context;
        SHA256Init(&context);
        for (size_t at = 0, size; at < SIZE; at += size) {
            /* Also alternating with small ones. */
            size = piece % 2 ? piece : at % 3 ? piece : 17;
            size = size < SIZE - at ? size : SIZE - at;
            lr_hash_update(&context, bytes + at, size);
        }
        SHA256Final(digest, &context);
        lr_hash_text(digest, ours);
        assert_string_equal(ours, theirs);
    }
}

/* The example of FIPS 180-2, B.3. */
static void test_million(void **state)
{
    (void)state;
    const size_t size = 1000000;
    char hash[65], *bytes = malloc(size);
    assert_non_null(bytes);
    for (size_t i = 0; i < size; i++)
        bytes[i] = 'a';
    lr_hash_bytes(bytes, size, hash);
    free(bytes);
    assert_string_equal(hash, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_pieces),
        cmocka_unit_test(test_million),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
