#include "base/hash.h"

#include <sha2.h>
#include <stdbool.h>

#ifdef __x86_64__
#include <cpuid.h>
#include <immintrin.h>
#endif

enum { BLOCK = SHA256_BLOCK_LENGTH };

#ifdef __x86_64__

/* Of FIPS 180-4: the first bits behind the point of the cube roots of the first 64 primes. */
static const uint32_t round_constants[64] __attribute__((aligned(16))) = {
    0x428A2F98, 0x71374491, 0xB5C0FBCF, 0xE9B5DBA5, 0x3956C25B, 0x59F111F1, 0x923F82A4, 0xAB1C5ED5,
    0xD807AA98, 0x12835B01, 0x243185BE, 0x550C7DC3, 0x72BE5D74, 0x80DEB1FE, 0x9BDC06A7, 0xC19BF174,
    0xE49B69C1, 0xEFBE4786, 0x0FC19DC6, 0x240CA1CC, 0x2DE92C6F, 0x4A7484AA, 0x5CB0A9DC, 0x76F988DA,
    0x983E5152, 0xA831C66D, 0xB00327C8, 0xBF597FC7, 0xC6E00BF3, 0xD5A79147, 0x06CA6351, 0x14292967,
    0x27B70A85, 0x2E1B2138, 0x4D2C6DFC, 0x53380D13, 0x650A7354, 0x766A0ABB, 0x81C2C92E, 0x92722C85,
    0xA2BFE8A1, 0xA81A664B, 0xC24B8B70, 0xC76C51A3, 0xD192E819, 0xD6990624, 0xF40E3585, 0x106AA070,
    0x19A4C116, 0x1E376C08, 0x2748774C, 0x34B0BCB5, 0x391C0CB3, 0x4ED8AA4A, 0x5B9CCA4F, 0x682E6FF3,
    0x748F82EE, 0x78A5636F, 0x84C87814, 0x8CC70208, 0x90BEFFFA, 0xA4506CEB, 0xBEF9A3F7, 0xC67178F2};

/* Whether there are the SHA extensions (and SSE4.1, which came before them). Asked once, as asking
 * is slow in virtual machines. */
static bool has_instructions(void)
{
    static _Atomic int known; /* 0: not yet; 1: no; 2: yes */
    if (known == 0) {
        unsigned a, b, c, d;
        known = __get_cpuid_count(7, 0, &a, &b, &c, &d) && (b & 1u << 29) ? 2 : 1;
    }
    return known == 2;
}

/* The instructions take the state as the words (f, e, b, a) and (h, g, d, c), lowest lane first,
 * and do two rounds each (Intel 64 manual, SHA256RNDS2). */
__attribute__((target("sha,sse4.1"))) static void
add_blocks(uint32_t state[8], const unsigned char *bytes, size_t count)
{
    const __m128i swap = _mm_set_epi8(12, 13, 14, 15, 8, 9, 10, 11, 4, 5, 6, 7, 0, 1, 2, 3);
    const uint32_t *s = state;
    __m128i feba = _mm_set_epi32((int)s[0], (int)s[1], (int)s[4], (int)s[5]);
    __m128i hgdc = _mm_set_epi32((int)s[2], (int)s[3], (int)s[6], (int)s[7]);
    for (; count > 0; count--, bytes += BLOCK) {
        const __m128i feba_before = feba, hgdc_before = hgdc;
        __m128i w[4]; /* the latest 16 words of the message schedule */
#pragma GCC unroll 16
        for (int i = 0; i < 16; i++) {
            __m128i *now = &w[i % 4];
            if (i < 4) {
                *now = _mm_loadu_si128((const __m128i *)(const void *)(bytes + 16 * i));
                *now = _mm_shuffle_epi8(*now, swap);
            } else {
                __m128i middle = _mm_alignr_epi8(w[(i + 3) % 4], w[(i + 2) % 4], 4);
                *now = _mm_add_epi32(_mm_sha256msg1_epu32(*now, w[(i + 1) % 4]), middle);
                *now = _mm_sha256msg2_epu32(*now, w[(i + 3) % 4]);
            }
            __m128i words = _mm_add_epi32(
                *now, _mm_load_si128((const __m128i *)(const void *)&round_constants[4 * i]));
            hgdc = _mm_sha256rnds2_epu32(hgdc, feba, words);
            feba = _mm_sha256rnds2_epu32(feba, hgdc, _mm_shuffle_epi32(words, 0x0E));
        }
        feba = _mm_add_epi32(feba, feba_before);
        hgdc = _mm_add_epi32(hgdc, hgdc_before);
    }
    uint32_t out[8];
    _mm_storeu_si128((__m128i *)(void *)out, feba);
    _mm_storeu_si128((__m128i *)(void *)(out + 4), hgdc);
    const int places[8] = {5, 4, 1, 0, 7, 6, 3, 2}; /* of the words in the state */
    for (int i = 0; i < 8; i++)
        state[places[i]] = out[i];
}

#else

static bool has_instructions(void)
{
    return false;
}

static void add_blocks(uint32_t state[8], const unsigned char *bytes, size_t count)
{
    for (; count > 0; count--, bytes += BLOCK)
        SHA256Transform(state, bytes);
}

#endif

void lr_hash_update(SHA2_CTX *context, const void *bytes, size_t size)
{
    const unsigned char *b = bytes;
    size_t begun = (size_t)(context->bitcount[0] / 8 % BLOCK);
    if (size >= 2 * BLOCK && has_instructions()) {
        size_t before = begun ? BLOCK - begun : 0, blocks = (size - before) / BLOCK;
        SHA256Update(context, b, before);
        add_blocks(context->state.st32, b + before, blocks);
        context->bitcount[0] += 8 * (uint64_t)BLOCK * blocks;
        b += before + BLOCK * blocks;
        size -= before + BLOCK * blocks;
    }
    SHA256Update(context, b, size);
}

void lr_hash_bytes(const void *bytes, size_t size, char hash[65])
{
    unsigned char digest[SHA256_DIGEST_LENGTH];
    SHA2_CTX context;
    SHA256Init(&context);
    lr_hash_update(&context, bytes, size);
    SHA256Final(digest, &context);
    lr_hash_text(digest, hash);
}

void lr_hash_text(const unsigned char digest[32], char hash[65])
{
    for (size_t i = 0; i < 32; i++) {
        hash[2 * i] = "0123456789abcdef"[digest[i] >> 4];
        hash[2 * i + 1] = "0123456789abcdef"[digest[i] & 15];
    }
    hash[64] = 0;
}
