#include "base/hash.h"

#include <sha2.h>

void lr_hash_bytes(const void *bytes, size_t size, char hash[65])
{
    unsigned char digest[SHA256_DIGEST_LENGTH];
    SHA2_CTX context;
    SHA256Init(&context);
    SHA256Update(&context, bytes, size);
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
