/* Files for assimp: all that it opens goes through here, is read whole, and lies where the scene's
 * files may lie. */
#include "scene/import_internal.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "scene/path.h"

/* The text with what glTF writes as %20 replaced; NULL when memory is out. */
static char *decode_percent(const char *text)
{
    char *decoded = lr_string_copy(text, strlen(text)), *out = decoded;
    for (const char *in = text; decoded && *in;) {
        unsigned value;
        char digits[3] = {0};
        if (in[0] == '%' && in[1] && in[2]) {
            memcpy(digits, in + 1, 2);
            if (strspn(digits, "0123456789abcdefABCDEF") == 2 &&
                sscanf(digits, "%x", &value) == 1 && value != 0) {
                *out++ = (char)value;
                in += 3;
                continue;
            }
        }
        *out++ = *in++;
    }
    if (decoded)
        *out = 0;
    return decoded;
}

/* `relative`, which is seen from the imported file, as seen from base_file. */
static char *from_base(const lr_import *import, const char *relative)
{
    const char *slash = relative[0] == '/' ? NULL : strrchr(import->name, '/');
    size_t folder = slash ? (size_t)(slash + 1 - import->name) : 0;
    char *path = lr_alloc(folder + strlen(relative) + 1, 1);
    if (path) {
        memcpy(path, import->name, folder);
        memcpy(path + folder, relative, strlen(relative));
    }
    return path;
}

lr_status lr_import_resolve(lr_import *import, const char *relative, char **path, lr_error *error)
{
    *path = NULL;
    char *own = from_base(import, relative);
    if (!own)
        return lr_fail(error, LR_ERROR_MEMORY, "%s: out of memory", import->shown);
    const lr_load_options *options = &import->options;
    lr_status status = lr_path_resolve(import->base_file, own, options, path, error);
    /* As a URI, or with the backslashes of other systems. */
    if (status == LR_ERROR_FILE && (strchr(own, '%') || strchr(own, '\\'))) {
        char *other = decode_percent(own);
        for (char *c = other; c && *c; c++)
            if (*c == '\\')
                *c = '/';
        lr_error ignored;
        if (other && lr_path_resolve(import->base_file, other, options, path, &ignored) == LR_OK)
            status = LR_OK;
        free(other);
    }
    free(own);
    return status;
}

lr_status lr_import_read(lr_import *import, const char *relative, char **bytes, size_t *size,
                         lr_error *error)
{
    char *path;
    *bytes = NULL;
    lr_status status = lr_import_resolve(import, relative, &path, error);
    if (status)
        return status;
    uint64_t left = import->options.max_memory - import->memory;
    status = lr_file_read(path, left < SIZE_MAX ? (size_t)left : SIZE_MAX, bytes, size, error);
    free(path);
    if (!status)
        import->memory += *size;
    return status;
}

/* ---- assimp's interface -------------------------------------------------------------------- */

typedef struct open_file {
    const char *bytes;
    char *owned; /* NULL for the imported file itself */
    size_t size, position;
} open_file;

static size_t file_read(struct aiFile *file, char *out, size_t size, size_t count)
{
    open_file *f = (open_file *)(void *)file->UserData;
    size_t left = f->size - f->position;
    if (size == 0 || count == 0)
        return 0;
    if (count > left / size)
        count = left / size;
    memcpy(out, f->bytes + f->position, count * size);
    f->position += count * size;
    return count;
}

static size_t file_write(struct aiFile *file, const char *in, size_t size, size_t count)
{
    (void)file, (void)in, (void)size, (void)count;
    return 0;
}

static size_t file_tell(struct aiFile *file)
{
    return ((open_file *)(void *)file->UserData)->position;
}

static size_t file_size(struct aiFile *file)
{
    return ((open_file *)(void *)file->UserData)->size;
}

static aiReturn file_seek(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    open_file *f = (open_file *)(void *)file->UserData;
    size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? f->position : f->size;
    /* Backwards is a huge offset that wraps around. */
    size_t position = base + offset;
    if (position > f->size)
        return aiReturn_FAILURE;
    f->position = position;
    return aiReturn_SUCCESS;
}

static void file_flush(struct aiFile *file)
{
    (void)file;
}

static struct aiFile *open_for_assimp(struct aiFileIO *io, const char *name, const char *mode)
{
    lr_import *import = (lr_import *)(void *)io->UserData;
    if (strchr(mode, 'w') || strchr(mode, 'a') || strchr(mode, '+'))
        return NULL;
    struct aiFile *file = lr_alloc(1, sizeof *file);
    open_file *f = lr_alloc(1, sizeof *f);
    if (!file || !f)
        goto fail;
    /* assimp is given a bare name for the file, so that the names that it asks for are as seen from
     * the file's folder. */
    if (strcmp(name, lr_import_bare_name(import->name)) == 0) {
        f->bytes = import->bytes;
        f->size = import->size;
    } else {
        lr_error error = {0};
        if (lr_import_read(import, name, &f->owned, &f->size, &error)) {
            /* The first: assimp then tries other names. */
            if (!import->refused[0])
                lr_import_shown(import->refused, sizeof import->refused, error.message);
            goto fail;
        }
        f->bytes = f->owned;
    }
    *file = (struct aiFile){.ReadProc = file_read,
                            .WriteProc = file_write,
                            .TellProc = file_tell,
                            .FileSizeProc = file_size,
                            .SeekProc = file_seek,
                            .FlushProc = file_flush,
                            .UserData = (aiUserData)(void *)f};
    return file;
fail:
    free(file);
    free(f);
    return NULL;
}

static void close_for_assimp(struct aiFileIO *io, struct aiFile *file)
{
    lr_import *import = (lr_import *)(void *)io->UserData;
    open_file *f = (open_file *)(void *)file->UserData;
    if (f->owned)
        import->memory -= f->size;
    free(f->owned);
    free(f);
    free(file);
}

lr_status lr_import_parse(lr_import *import)
{
    struct aiFileIO io = {.OpenProc = open_for_assimp,
                          .CloseProc = close_for_assimp,
                          .UserData = (aiUserData)(void *)import};
    /* No steps of assimp's own: they trust the file's indices, and what they join and cut would
     * change with assimp's version. */
    import->scene = aiImportFileEx(lr_import_bare_name(import->name), 0, &io);
    if (import->scene && import->scene->mRootNode)
        return import->refused[0] ? lr_import_note(import, "shown without a file that it names: %s",
                                                   import->refused)
                                  : LR_OK;
    char reason[400];
    lr_import_shown(reason, sizeof reason, import->scene ? "no nodes" : aiGetErrorString());
    bool opened = import->refused[0] == 0;
    return lr_fail(import->error, LR_ERROR_FILE, "%s: %s%s%s", import->shown,
                   opened ? reason : import->refused, opened ? "" : ": ", opened ? "" : reason);
}
