/* SHA-256 as text. */
#ifndef LR_BASE_HASH_H
#define LR_BASE_HASH_H

#include <stddef.h>

/* SHA2_CTX of <sha2.h>. */
struct _SHA2_CTX;

/* SHA256Update, with the processor's instructions for it where it has them. */
void lr_hash_update(struct _SHA2_CTX *context, const void *bytes, size_t size);

/* The hash of size bytes as 64 lower-case hexadecimal digits. */
void lr_hash_bytes(const void *bytes, size_t size, char hash[65]);

/* A digest of 32 bytes as text. */
void lr_hash_text(const unsigned char digest[32], char hash[65]);

#endif
