/* Turns a compiled shader into a C header, as the build does for each kernel:
 *
 *     embed_shader --decorate IN.spv OUT.spv   decorate, so that an optimiser keeps to the exact
 * rules embed_shader IN.spv SYMBOL OUT.h         decorate, check against the rules, write OUT.h
 *     embed_shader --check FILE.spv            check a module as it is
 *
 * A module that breaks a rule fails the build. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/spirv.h"

enum { SIZE_LIMIT = 1 << 28 };

static bool read_words(const char *path, lr_spirv *module)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        return false;
    }
    size_t size = 0, capacity = 1 << 16;
    unsigned char *bytes = malloc(capacity);
    while (bytes) {
        size += fread(bytes + size, 1, capacity - size, file);
        if (size < capacity || capacity >= SIZE_LIMIT)
            break;
        capacity *= 2;
        unsigned char *grown = realloc(bytes, capacity);
        if (!grown)
            free(bytes);
        bytes = grown;
    }
    bool complete = bytes && !ferror(file) && size < SIZE_LIMIT && size % 4 == 0;
    fclose(file);
    if (complete)
        *module = (lr_spirv){(uint32_t *)(void *)bytes, size / 4};
    else {
        fprintf(stderr, "%s: cannot be read whole, or is not made of 32-bit words\n", path);
        free(bytes);
    }
    return complete;
}

static bool close_output(FILE *file, const char *path)
{
    bool written = !ferror(file);
    written = fclose(file) == 0 && written;
    if (!written) {
        fprintf(stderr, "%s: cannot be written: %s\n", path, strerror(errno));
        remove(path); /* a half-written file would be newer than its source */
    }
    return written;
}

static FILE *open_output(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
    return file;
}

static bool write_header(const char *path, const char *symbol, const lr_spirv *module)
{
    FILE *file = open_output(path);
    if (!file)
        return false;
    fprintf(file, "#include <stdint.h>\n\nstatic const uint32_t %s[] = {", symbol);
    for (size_t i = 0; i < module->count; i++)
        fprintf(file, "%s0x%08x,", i % 8 ? " " : "\n    ", (unsigned)module->words[i]);
    fprintf(file, "\n};\n");
    return close_output(file, path);
}

static bool write_module(const char *path, const lr_spirv *module)
{
    FILE *file = open_output(path);
    if (!file)
        return false;
    fwrite(module->words, sizeof *module->words, module->count, file);
    return close_output(file, path);
}

int main(int argc, char **argv)
{
    bool check_only = argc == 3 && strcmp(argv[1], "--check") == 0;
    bool decorate_only = argc == 4 && strcmp(argv[1], "--decorate") == 0;
    if (!check_only && argc != 4) {
        fprintf(stderr,
                "usage: embed_shader --decorate IN.spv OUT.spv | embed_shader IN.spv SYMBOL "
                "OUT.h | embed_shader --check FILE.spv\n");
        return 2;
    }
    const char *path = argv[check_only || decorate_only ? 2 : 1];
    lr_spirv module = {0}, decorated = {0};
    lr_error error = {0};
    bool done = false;
    if (!read_words(path, &module))
        goto end;
    if (!check_only && !decorate_only)
        lr_spirv_define(&module);
    if (check_only) {
        if (lr_spirv_check(module.words, module.count, &error) == LR_OK)
            done = printf("%s: ok\n", path) > 0 && fflush(stdout) == 0;
    } else if (lr_spirv_decorate(module.words, module.count, &decorated, &error) == LR_OK &&
               lr_spirv_check(decorated.words, decorated.count, &error) == LR_OK) {
        done = decorate_only ? write_module(argv[3], &decorated)
                             : write_header(argv[3], argv[2], &decorated);
    }
    if (error.message[0])
        fprintf(stderr, "%s: %s\n", path, error.message);
end:
    lr_spirv_free(&module);
    lr_spirv_free(&decorated);
    return done ? 0 : 1;
}
